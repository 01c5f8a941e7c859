"""The calibration of a session with a camera, and when it is sent again."""

from schemas.kinematics import Calibration
from schemas.session import SessionDescription
from schemas.vocabulary import EventSource, Side
from services.biomech.whole_body.directions import LARGEST_DEVIATION
from services.biomech.whole_body.model import DOF, LENGTH_NAMES
from services.estimation.body.coordinates import MODEL
from services.estimation.body.parameters import BodyParameters
from services.estimation.body.tracker import BodyTracker, Posture
from services.flow.node import State

STANDING = "quiet standing, taken for the rest posture of people"
UNKNOWN = "none: nobody stood still; angles are as the camera shows them, with its offsets"
HINGES = [DOF[f"{joint}_flexion_{side}"] for joint in ("hip", "knee") for side in ("right", "left")]
"""Angles whose deviation is the calibration's quality."""


class FittedBody:
    """Of one session."""

    def __init__(self, description: SessionDescription, unused: dict[str, str], parameters: BodyParameters) -> None:
        self._description, self._unused, self._parameters = description, unused, parameters
        self._said: tuple[int, bool] = (0, False)

    def news(self, tracker: BodyTracker, posture: Posture) -> Calibration | None:
        """The calibration, after a start and when its lengths have been learnt."""
        to_say = (tracker.begun, tracker.holds_lengths)
        if to_say == self._said:
            return None
        self._said = to_say
        return Calibration(
            model=MODEL,
            estimator=self._description.estimator,
            method="standing" if tracker.absolute else "posture fitted to the first frames",
            datum=STANDING if tracker.absolute else UNKNOWN,
            quality=self._quality(posture, absolute=tracker.absolute),
            sensors=[],
            events_from=dict.fromkeys(Side, EventSource.CAMERA),
            unused=self._unused,
            misplaced={},
            lengths=dict(zip(LENGTH_NAMES, posture.told.lengths.tolist(), strict=True)),
            absolute=tracker.absolute,
        )

    def _quality(self, posture: Posture, *, absolute: bool) -> float:
        """1 - (mean deviation of hips and knees) / the largest that is shown."""
        share = float(posture.told.deviations[0, HINGES].mean()) / LARGEST_DEVIATION
        return min(max(1.0 - share, 0.0), 1.0 if absolute else self._parameters.population_quality)

    def snapshot(self) -> State:
        """What was said last."""
        return {"said": list(self._said)}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        begun, holds_lengths = state["said"]
        self._said = (begun, holds_lengths)
