"""What the screen says of the sensors."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import CameraStatus, SensorStatus
from schemas.session import SensorDescription
from schemas.vocabulary import SensorState
from services.estimation.sensor_checks import SensorChecks

STATE_WORDS = {
    SensorState.MISSING: "sends nothing",
    SensorState.STUCK: "repeats the same values",
    SensorState.REJECTED: "sends values that cannot be used",
    SensorState.CALIBRATING: "came after the calibration: start a new session to use it",
}


def sensor_statuses(
    sensors: Sequence[SensorDescription],
    checks: SensorChecks,
    now_ns: int,
    refused: NDArray[np.bool_],
    waiting: NDArray[np.bool_],
) -> list[SensorStatus]:
    """State of each sensor; `refused` (S,) were refused in standing, `waiting` (S,) have no alignment yet."""
    statuses = []
    for s, sensor in enumerate(sensors):
        state, since_ns = checks.state_of(s, now_ns)
        if state is SensorState.OK and refused[s]:
            state = SensorState.REJECTED
        elif state is SensorState.OK and waiting[s]:
            state = SensorState.CALIBRATING
        statuses.append(SensorStatus(sensor=sensor.name, state=state, since_ns=since_ns))
    return statuses


def unused_statuses(unused: Iterable[str]) -> list[SensorStatus]:
    """Sensors, by name, that were never meant to be used with what else is worn."""
    return [SensorStatus(sensor=name, state=SensorState.UNUSED, since_ns=0) for name in unused]


def unused_cameras(names: Iterable[str]) -> list[CameraStatus]:
    """Cameras, by name, that are not used."""
    return [CameraStatus(camera=name, state=SensorState.UNUSED, people=0, since_ns=0) for name in names]


def sensor_troubles(statuses: Sequence[SensorStatus]) -> str:
    """One sentence on what is wrong with the sensors; empty when nothing is."""
    parts = [f"{status.sensor} {STATE_WORDS[status.state]}" for status in statuses if status.state in STATE_WORDS]
    return "Sensor " + ", ".join(parts) if parts else ""
