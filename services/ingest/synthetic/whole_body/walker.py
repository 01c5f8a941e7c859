"""Somebody who walks on a treadmill or marches on the spot, as a depth camera sees them.

The legs are those whose motion the inertial sensors feel: hips, knees and ankles are the same points. Trunk and arms
go along with them by rules of this file.
"""

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from schemas.session import CameraDescription
from schemas.vocabulary import ANKLES, LOWER_BODY, WHOLE_BODY, JointCentre, Segment, Side
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, LENGTH_NAMES, WholeBodyModel
from services.biomech.whole_body.parameters import REST_DEG, STATURE_SHARE, lengths_of, unsided
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.block import SeenFrames
from services.ingest.synthetic.gait import WalkingBody
from services.ingest.synthetic.parameters import BeforeCameraParameters
from services.ingest.synthetic.whole_body.body import Placed, place
from services.ingest.synthetic.whole_body.people import SPREAD_DEG, person
from services.ingest.synthetic.whole_body.view import Absence, Key, camera_description, frame_times, viewed

Array = NDArray[np.float64]

BELT_FOLLOWS_S = 0.5
"""A treadmill's belt takes up what the walk is over so many s (standard deviation of a Gaussian); the rest is seen."""
ARM_SHARE = 0.35
"""Of the angle between the thighs, by which arms swing against the legs."""
ELBOW_SHARE = 0.4
"""Of the arm's swing forward, by which the elbow bends."""
UPRIGHT_SHARE = 0.5
"""Of the pelvis's tilt, by which the trunk bends against it."""
LEVEL_SHARE, COUNTER_SHARE = 0.7, 1.3
"""Of the pelvis's obliquity and rotation, by which the trunk bends aside and twists against them."""

LONGEST_S = 3600.0
"""s of a session: its frames are held in memory."""

_OWN = tuple(dof.name for dof in WHOLE_BODY if dof not in LOWER_BODY)
OWN_CHANNELS = (*_OWN, *(dof.name for dof in ANKLES))
"""Angles that the lower body does not have, rad."""


BodyAt = Callable[[Array], WalkingBody]
"""The moving body at increasing instants, s; its path begins at the first of them."""
PATH_HZ = 30.0
"""At which the path over the ground is known."""
PART = 1000
"""Instants placed at a time."""


class Whole(NamedTuple):
    """A walker at n instants."""

    angles: Array  # (n, 22) rad
    bends: Array  # (n, 2) rad, of the trunk: aside, twist
    dorsiflexion: Array  # (n, 2) rad, right and left


def standing_posture(seed: int) -> dict[str, float]:
    """rad by angle: how somebody's standing differs from the straight body. Knees do not overextend."""
    drawn = np.random.default_rng([seed, 12]).normal(size=len(WHOLE_BODY))
    found = {}
    for dof, z in zip(WHOLE_BODY, drawn, strict=True):
        name = unsided(dof.name)
        degrees = REST_DEG[name][0] + SPREAD_DEG[name] * z
        found[dof.name] = float(np.radians(abs(degrees) if name in ("knee_flexion", "elbow_flexion") else degrees))
    return found


class SeenWalker:
    """The camera's part of a session."""

    own_channels = OWN_CHANNELS

    def __init__(self, parameters: BeforeCameraParameters) -> None:
        if parameters.duration > LONGEST_S:
            raise InvalidOption(f"duration={parameters.duration:g}: before a camera at most {LONGEST_S:g} s")
        self.parameters = parameters
        self.key = Key(parameters.seed, 0)
        self._rest = standing_posture(parameters.seed)

    @property
    def posture(self) -> dict[str, float]:
        """rad by angle of the lower body that is not zero while standing."""
        share, legs = self.parameters.posture, [dof.name for dof in LOWER_BODY if dof.name != "pelvis_rotation"]
        return {name: share * self._rest[name] for name in legs if share and name in self._rest}

    def worn_at(self, captured_ns: NDArray[np.int64]) -> NDArray[np.bool_]:
        """When the inertial sensors are heard."""
        silence = Absence(self.parameters.imu_away_at, self.parameters.imu_away_for)
        return ~silence.within(np.asarray(captured_ns / 1e9, dtype=np.float64))

    def camera_description(self) -> CameraDescription:
        """As it would be served live."""
        return camera_description(self.parameters)

    @cached_property
    def stature(self) -> float:
        """m, of somebody with such legs."""
        thigh, shank = (self.parameters.thigh_length, self.parameters.shank_length)
        return (thigh / STATURE_SHARE["thigh"] + shank / STATURE_SHARE["shank"]) / 2.0

    @cached_property
    def lengths(self) -> Array:
        """(12,) m: legs and pelvis as the session says, trunk and arms as drawn by its seed."""
        someone = person(self.parameters.seed)
        lengths = lengths_of(self.stature) * someone.lengths / lengths_of(someone.stature)
        given = {"half_pelvis": self.parameters.hip_width / 2.0}
        for side in Side:
            given |= {f"thigh_{side}": self.parameters.thigh_length, f"shank_{side}": self.parameters.shank_length}
        for name, length in given.items():
            lengths[LENGTH_NAMES.index(name)] = length
        return lengths

    def whole(self, body: WalkingBody) -> Whole:
        """Angles of legs, trunk and arms, with no heading."""
        legs = {name: jet.value for name, jet in body.angles.items()}
        n = len(legs["pelvis_tilt"])
        angles = np.zeros((n, len(DOF)))
        for name, index in DOF.items():
            angles[:, index] = legs[name] if name in legs else self._rest[name]
        angles[:, DOF["trunk_flexion"]] -= UPRIGHT_SHARE * legs["pelvis_tilt"]
        for side in Side:
            swing = ARM_SHARE * (legs[f"hip_flexion_{side.other}"] - legs[f"hip_flexion_{side}"])
            angles[:, DOF[f"shoulder_flexion_{side}"]] += swing
            angles[:, DOF[f"elbow_flexion_{side}"]] += ELBOW_SHARE * np.maximum(swing, 0.0)
        bends = np.column_stack([LEVEL_SHARE * legs["pelvis_obliquity"], -COUNTER_SHARE * legs["pelvis_rotation"]])
        return Whole(angles, bends, np.column_stack([_dorsiflexion(body, side) for side in (Side.RIGHT, Side.LEFT)]))

    def truth(self, body: WalkingBody) -> Array:
        """(n, 13) the channels of OWN_CHANNELS."""
        whole = self.whole(body)
        return np.column_stack([whole.angles[:, [DOF[name] for name in _OWN]], whole.dorsiflexion])

    def placed(self, body: WalkingBody, at: Array) -> tuple[Placed, Array]:
        """In the room, with the middle of the hips (n, 3) m; and dorsiflexion (n, 2) rad.

        The walker's knees are no hinges, so its own shanks and ankles take the place of the model's.
        """
        whole = self.whole(body)
        q = np.concatenate([at, whole.angles], axis=1)
        centres, carriers = place(WholeBodyModel(), q, self.lengths, whole.bends)
        for side in Side:
            m = CENTRE_NAMES.index(JointCentre(f"ankle_{side}"))
            centres[:, m] = body.ankle(side).position - body.pelvis.position + at
            carriers[:, m] = body.segments[Segment(f"shank_{side}")].R_world_from_body
        return Placed(centres, carriers), whole.dorsiflexion

    def track(self, body_at: BodyAt, duration_s: float) -> SeenFrames:
        """What the camera delivers of a session."""
        grid_s = np.arange(0.0, duration_s + 1.0 / PATH_HZ, 1.0 / PATH_HZ)
        time_s = frame_times(self.parameters, self.key, duration_s)
        seen_at = CubicSpline(grid_s, self._on_treadmill(_path(body_at, grid_s)))(time_s)
        placed: list[tuple[Placed, Array]] = []
        for part in _parts(len(time_s)):
            body = body_at(time_s[part])
            height = body.pelvis.position[:, 1] - self.parameters.camera_height
            at = np.column_stack([seen_at[part, 0] - self.parameters.distance, height, seen_at[part, 1]])
            placed.append(self.placed(body, at))
        centres, carriers = (np.concatenate([each[i] for each, _ in placed]) for i in (0, 1))
        dorsiflexion = np.concatenate([each for _, each in placed])
        absence = Absence(self.parameters.camera_away_at, self.parameters.camera_away_for)
        return viewed(Placed(centres, carriers), dorsiflexion, time_s, self.parameters, self.key, absence)

    @staticmethod
    def _on_treadmill(path: Array) -> Array:
        """(n, 2) m, what is left of the way forward and sideways when the belt has taken its slow part."""
        return np.asarray(path - gaussian_filter1d(path, BELT_FOLLOWS_S * PATH_HZ, axis=0, mode="nearest"))


def _parts(count: int) -> Iterator[slice]:
    return (slice(first, first + PART) for first in range(0, count, PART))


def _path(body_at: BodyAt, grid_s: Array) -> Array:
    """(n, 2) m, forward and sideways: where the middle of the hips goes over the ground."""
    path = np.zeros((len(grid_s), 2))
    for part in _parts(len(grid_s)):
        # One instant more than is kept: the next part goes on from there.
        position = body_at(grid_s[part.start : part.stop + 1]).pelvis.position[:, [0, 2]]
        path[part.start : part.stop + 1] = path[part.start] + position
    return path


def _dorsiflexion(body: WalkingBody, side: Side) -> Array:
    """rad, of the foot against the shank in the shank's sagittal plane: R_shank' R_foot turns x to (cos, sin, .)."""
    R_world_from_shank = body.segments[Segment(f"shank_{side}")].R_world_from_body
    forward = np.einsum(
        "nji,nj->ni", R_world_from_shank, body.segments[Segment(f"foot_{side}")].R_world_from_body[:, :, 0]
    )
    return np.asarray(np.arctan2(forward[:, 1], forward[:, 0]))
