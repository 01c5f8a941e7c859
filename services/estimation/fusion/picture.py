"""The one picture of a body that two estimators follow, and the one calibration."""

from collections.abc import Mapping

import numpy as np

from schemas.kinematics import Calibration, JointCentres, JointState, LivePose, SegmentPose
from schemas.session import SessionDescription
from schemas.vocabulary import BODY_MODELS, JointCentre
from services.biomech.figure import Pace, drawn_segments, lower_body_of, segment_pictures, with_directions
from services.biomech.whole_body.kernels.tables import COORDINATES
from services.biomech.whole_body.model import CENTRE_NAMES, LENGTH_NAMES
from services.biomech.whole_body.model import MODEL as BODY
from services.biomech.whole_body.parameters import MEAN_STATURE, lengths_of
from services.estimation.body.screen import RELATIVE, STAND
from services.estimation.fusion.fuser import ABSENT_NS, MODEL
from services.estimation.parameters import EstimationParameters
from services.flow.node import State

NAMES = [dof.name for dof in BODY_MODELS[MODEL]]
ANGLES = COORDINATES - 3
STALE_NS = 300_000_000
"""Without a fused row for so long, the page is shown what the estimators say themselves."""


class FusedPicture:
    """Centres of the fused angles stand where the camera last had the body."""

    def __init__(self, description: SessionDescription) -> None:
        self._body, self._drawn = description.anthropometry, drawn_segments(description)
        stature = self._body.height_m
        lengths = lengths_of(MEAN_STATURE if stature is None else stature)
        self.lengths: dict[str, float] = dict(zip(LENGTH_NAMES, lengths.tolist(), strict=True))
        """m, by name, as the camera's estimator has them; those of people of that stature before it has."""
        self._placed: JointCentres | None = None
        self._heard: dict[str, LivePose] = {}
        self._pace = Pace(EstimationParameters().live_rate_hz)
        self._drawn_ns = -1

    def place(self, centres: JointCentres) -> None:
        """Take where the camera's estimator has the body."""
        self._placed = centres

    def hear(self, source: str, pose: LivePose) -> LivePose | None:
        """Remember what an estimator says to the page; to be shown itself when there are no fused rows."""
        self._heard[source] = pose
        if self._drawn_ns >= 0 and pose.captured_ns - self._drawn_ns < STALE_NS:
            return None
        return self._completed(pose)

    def centres(self, joints: JointState) -> JointCentres:
        """The joint centres of every row, around the origin before the camera has seen the body."""
        placed = self._placed
        lengths = np.array([self.lengths[name] for name in LENGTH_NAMES])
        base = [0.0, 0.0, 0.0] if placed is None else placed.position[-1][0]
        position = [BODY.centres(np.array([*base, *row[:ANGLES]]), lengths).tolist() for row in joints.position]
        seen = [False] * len(CENTRE_NAMES)
        if placed is not None and joints.captured_ns[-1] - placed.captured_ns[-1] <= ABSENT_NS:
            seen = placed.seen
        return JointCentres(captured_ns=joints.captured_ns, position=position, seen=seen)

    def drawn(self, joints: JointState, centres: JointCentres) -> LivePose | None:
        """The picture of the newest row, when it is due."""
        captured_ns = joints.captured_ns[-1]
        if not self._heard or not self._pace.is_due(captured_ns):
            return None
        self._drawn_ns = captured_ns
        valid = [(i, name) for i, name in enumerate(NAMES) if joints.valid[i]]
        newest = max(self._heard.values(), key=lambda pose: pose.captured_ns)
        placed = {} if self._placed is None else self._named(centres)
        told = newest.model_copy(
            update={
                "captured_ns": captured_ns,
                "phase": "estimating",
                "segments": [] if placed else self._bones(joints),
                "angles": {name: joints.position[-1][i] for i, name in valid},
                "angles_std": {name: joints.position_std[-1][i] for i, name in valid},
                "centres": placed,
            }
        )
        return self._completed(with_directions(told, joints.position[-1], joints.position_std[-1], centres.seen))

    @staticmethod
    def _named(centres: JointCentres) -> dict[JointCentre, list[float]]:
        return dict(zip(CENTRE_NAMES, centres.position[-1], strict=True))

    def _bones(self, joints: JointState) -> list[SegmentPose]:
        return segment_pictures(self._body, lower_body_of(joints.position[-1]), self._drawn, joints.observed)

    def _completed(self, pose: LivePose) -> LivePose:
        """With the sensors and cameras of both, and what either has to say."""
        both = [self._heard[source] for source in sorted(self._heard)]
        # The zero is the sensors' once they are calibrated, so nobody has to stand for the camera.
        moot = (STAND, RELATIVE) if self._are_sensors_calibrated() else ()
        said = [each.message for each in both if each.message and each.message not in moot]
        notices = [each.notice for each in both if each.notice]
        cadences = [each.cadence_per_min for each in both if each.cadence_per_min is not None]
        return pose.model_copy(
            update={
                "sensors": self._heard["inertial"].sensors if "inertial" in self._heard else [],
                "cameras": self._heard["camera"].cameras if "camera" in self._heard else [],
                "message": ". ".join(dict.fromkeys(said)),
                "notice": notices[0] if notices else "",
                "cadence_per_min": cadences[-1] if cadences else None,
            }
        )

    def _are_sensors_calibrated(self) -> bool:
        inertial = self._heard.get("inertial")
        return inertial is not None and inertial.phase == "estimating"

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "lengths": dict(self.lengths),
            "placed": None if self._placed is None else self._placed.model_dump(mode="json"),
            "heard": {source: pose.model_dump(mode="json") for source, pose in self._heard.items()},
            "times_ns": [self._pace.next_ns, self._drawn_ns],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.lengths = dict(state["lengths"])
        self._placed = None if state["placed"] is None else JointCentres.model_validate(state["placed"])
        self._heard = {source: LivePose.model_validate(pose) for source, pose in state["heard"].items()}
        self._pace.next_ns, self._drawn_ns = state["times_ns"]


def joined_calibration(known: Mapping[str, Calibration]) -> Calibration:
    """What both estimators say of how they are calibrated, as one message; at least one is known."""
    camera, inertial = known.get("camera"), known.get("inertial")
    if camera is None or inertial is None:
        only = camera or inertial
        assert only is not None
        return only.model_copy(update={"model": MODEL, "estimator": "fusion"})
    return inertial.model_copy(
        update={
            "model": MODEL,
            "estimator": "fusion",
            "method": f"sensors: {inertial.method}; camera: {camera.method}",
            "datum": f"sensors: {inertial.datum}; camera: {camera.datum}",
            "quality": max(inertial.quality, camera.quality),
            "unused": {**camera.unused, **inertial.unused},
            "lengths": camera.lengths,
            "absolute": True,
        }
    )
