"""Inertial samples as they leave ingest: SI units, sensor frame, one message per hub and tick (or few ticks)."""

from typing import Any

from pydantic import Field, model_validator

from schemas.payload import Payload, SessionTime, Vector3
from schemas.standing import StandingMark


class SensorSamples(Payload):
    """Samples of one sensor, oldest first. Empty lists when the sensor delivered nothing usable."""

    captured_ns: list[SessionTime]
    angular_velocity: list[Vector3] = Field(description="rad/s, sensor frame, n x 3")
    specific_force: list[Vector3] = Field(description="m/s^2, sensor frame, gravity included (+9.81 up at rest), n x 3")

    @model_validator(mode="after")
    def _same_length(self) -> "SensorSamples":
        if not len(self.captured_ns) == len(self.angular_velocity) == len(self.specific_force):
            raise ValueError("captured_ns, angular_velocity and specific_force differ in length")
        return self


class ImuBatch(Payload):
    """Samples of all sensors of one hub, in the order of the hub's sensors in the session description."""

    sensors: list[SensorSamples]
    marks: list[StandingMark] = Field(description="given since the message before, by any hub; nearly always none")

    @model_validator(mode="before")
    @classmethod
    def _of_an_older_writer(cls, fields: Any) -> Any:
        """Before marks existed nobody gave one."""
        return {"marks": [], **fields} if isinstance(fields, dict) else fields


class ReferenceBatch(Payload):
    """Truth that came with a recording or a simulation, in the order of the session's reference channels."""

    captured_ns: list[SessionTime]
    values: list[list[float | None]] = Field(
        description="n x channels, in the SI units of the session's reference channels; null where unknown"
    )
