"""The calibrated body as a message: what zero means, which sensors are used, what tells the events of each leg."""

from schemas.kinematics import Calibration, SensorAlignment
from schemas.session import SessionDescription
from services.biomech.event_sources import event_sources, worn_segments
from services.biomech.rotations import quaternion_from_matrix
from services.estimation.intake import Intake
from services.estimation.lower_body.lower_body_filter import Calibrated
from services.estimation.rows import MODEL

UPRIGHT = "quiet standing: pelvis level, thighs and shanks vertical, feet flat"
POPULATION = (
    "population: mean posture of healthy adults' walking; nobody stood still, so angles are right as changes, "
    "and their zero is uncertain by 5 to 10 degrees"
)


def calibration_message(description: SessionDescription, intake: Intake, calibrated: Calibrated) -> Calibration:
    """The message for one calibration. At least one sensor is aligned."""
    alignment = calibrated.alignment
    sensors = [
        SensorAlignment(
            sensor=sensor.name,
            segment=sensor.segment,
            quat_segment_from_sensor=quaternion_from_matrix(alignment.R_segment_from_sensor[s]).tolist(),
            gyro_bias=calibrated.gyro_bias[s].tolist(),
            quality=float(alignment.quality[s]),
        )
        for s, sensor in enumerate(intake.sensors)
        if alignment.aligned[s]
    ]
    return Calibration(
        model=MODEL,
        estimator=description.estimator,
        method=_method(description, calibrated),
        datum=POPULATION if calibrated.from_walking else UPRIGHT,
        quality=min(sensor.quality for sensor in sensors),
        sensors=sensors,
        events_from=event_sources(worn_segments(description.hubs)),
        unused=intake.unused,
        misplaced={},
        lengths={},
        absolute=True,
    )


def _method(description: SessionDescription, calibrated: Calibrated) -> str:
    if calibrated.from_walking:
        return "walking alone"
    is_marked = calibrated.marked or bool(description.standing)
    return "standing, marked by the operator + walking" if is_marked else "standing+walking"
