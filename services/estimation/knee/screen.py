"""What the page shows of a knee session, 25 times a second of data time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import LivePose, SensorStatus
from schemas.session import SessionDescription
from schemas.vocabulary import Segment, SensorState
from services.biomech.figure import Pace, drawn_segments, segment_pictures
from services.estimation.intake import Intake
from services.estimation.knee.leg import Leg
from services.estimation.knee.wording import WRONG_UNITS, misplacement_words, wishes
from services.estimation.live_pose import estimated_pose, waiting_pose
from services.estimation.rows import Row
from services.estimation.sensor_status import sensor_statuses, sensor_troubles, unused_statuses
from services.estimation.standing import StandingReference

Array = NDArray[np.float64]


class Screen:
    """Of one session; draws when a picture is due."""

    def __init__(self, description: SessionDescription, intake: Intake, legs: Sequence[Leg], rate_hz: float) -> None:
        self._intake = intake
        self._legs = legs
        self._body = description.anthropometry
        self._segments = drawn_segments(description)
        self.pace = Pace(rate_hz)

    def waiting(self, captured_ns: int, notice: str, reference: StandingReference | None) -> LivePose:
        """Before there is an angle."""
        phase = "calibrating" if any(leg.estimator.is_fitted for leg in self._legs) else "waiting"
        statuses, message = self._said(captured_ns, reference)
        return waiting_pose(captured_ns, phase, message, notice, statuses)

    def drawn(
        self, row: Row, valid: Sequence[bool], observed: Sequence[Segment], notice: str,
        reference: StandingReference | None,
    ) -> LivePose:  # fmt: skip
        """Of the newest row."""
        statuses, message = self._said(row.captured_ns, reference)
        bones = segment_pictures(self._body, row.position, self._segments, observed)
        return estimated_pose(row, bones, valid, message, notice, statuses)

    def _said(self, captured_ns: int, reference: StandingReference | None) -> tuple[list[SensorStatus], str]:
        """The sensors' states, and the one thing that matters most."""
        sensors, checks = self._intake.sensors, self._intake.checks
        wrong = np.zeros(len(sensors), dtype=np.bool_) if reference is None else reference.wrong_units
        settled = np.repeat([leg.is_settled for leg in self._legs], 2)
        statuses = sensor_statuses(sensors, checks, captured_ns, wrong, ~settled)
        troubled = [status for status in statuses if status.state is not SensorState.CALIBRATING]
        message = _unit_words(self._intake, reference) or sensor_troubles(troubled)
        sentences = [message] if message else misplacement_words(self._legs) or [wishes(self._legs)]
        return statuses + unused_statuses(self._intake.unused), ". ".join(sentences)


def _unit_words(intake: Intake, reference: StandingReference | None) -> str:
    if reference is None or not reference.wrong_units.any():
        return ""
    forces = np.linalg.norm(reference.mean_force, axis=1)
    wrong = np.flatnonzero(reference.wrong_units)
    return WRONG_UNITS.format(values=", ".join(f"{intake.sensors[s].name} {forces[s]:.2f}" for s in wrong))
