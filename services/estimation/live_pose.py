"""The picture for a screen while an estimator runs: what stands there before an estimate, and that of a row."""

from collections.abc import Sequence
from typing import NamedTuple

from schemas.kinematics import CameraStatus, LivePose, SegmentPose, SensorStatus
from schemas.vocabulary import JointCentre
from services.biomech import figure
from services.biomech.figure import Told, cadence_per_min
from services.estimation.rows import MODEL, Row


class Watched(NamedTuple):
    """What cameras add to a picture."""

    centres: dict[JointCentre, list[float]]  # m, room; empty while nobody is in view
    cameras: list[CameraStatus]


NO_CAMERA = Watched({}, [])


def waiting_pose(
    captured_ns: int, phase: str, message: str, notice: str, statuses: list[SensorStatus],
    watched: Watched = NO_CAMERA, stood: float | None = None,
) -> LivePose:  # fmt: skip
    """The picture before there is an estimate; `stood` where standing still is waited for."""
    return LivePose(
        captured_ns=captured_ns,
        phase=phase,
        message=message,
        notice=notice,
        segments=[],
        angles={},
        angles_std={},
        sensors=statuses,
        centres=watched.centres,
        cameras=watched.cameras,
        cadence_per_min=None,
        stood=stood,
    )


def estimated_pose(
    row: Row, bones: list[SegmentPose], valid: Sequence[bool], message: str, notice: str,
    statuses: list[SensorStatus], watched: Watched = NO_CAMERA, model: str = MODEL,
) -> LivePose:  # fmt: skip
    """The picture of one row of a body model."""
    cadence = cadence_per_min(row.rhythm.frequency, locked=row.rhythm.locked)
    told = Told(message, notice, statuses, watched.cameras, cadence)
    angles = figure.Angles(model, row.captured_ns, row.position, row.position_std, valid)
    return figure.estimated_pose(angles, bones, told, watched.centres)
