"""One frame of a capture PC as one UDP datagram of JSON; the README of ingest defines it. Pure."""

from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from schemas.health import Reason
from schemas.vocabulary import CameraKind
from services.ingest.skeleton.vendors import VENDORS

Array = NDArray[np.float64]

MOST_BYTES = 60_000
"""Longest datagram; UDP itself carries 65 507. Six bodies of an Azure Kinect at full precision are 15 000."""
MOST_BODIES = 10
LARGEST_COUNT = 2**63 - 1
FARTHEST = {CameraKind.KINECT_V2: 100.0, CameraKind.AZURE_KINECT: 100_000.0}
"""Largest coordinate in the camera's unit; ten times further than it sees, beyond it is another unit."""

_Number = Annotated[float, Field(allow_inf_nan=False)]
_Count = Annotated[int, Field(ge=0, le=LARGEST_COUNT)]
_Vector = tuple[_Number, _Number, _Number]


class BadDatagram(ValueError):
    """A datagram that is no frame; counted under `reason`."""

    def __init__(self, reason: Reason, says: str) -> None:
        super().__init__(says)
        self.reason = reason


class _Part(BaseModel):
    """Strict, but for fields of a newer sender, which are ignored."""

    model_config = ConfigDict(frozen=True, strict=True, extra="ignore")


class Body(_Part):
    """One body as the camera sees it: its own axes, unit and state numbers."""

    id: Annotated[int, Field(ge=0, le=2**64 - 1)]
    joints: Annotated[list[tuple[_Number, _Number, _Number, Annotated[int, Field(ge=0, le=9)]]], Field(max_length=64)]

    @property
    def positions(self) -> Array:
        """(joints, 3), the camera's axes and unit."""
        return np.array([joint[:3] for joint in self.joints])

    @property
    def codes(self) -> NDArray[np.int64]:
        """(joints,) the camera's own numbers of tracking."""
        return np.array([joint[3] for joint in self.joints], dtype=np.int64)


class CameraFrame(_Part):
    """One frame of one camera with everybody in it."""

    camera: CameraKind
    t_us: _Count | None = None
    t_ns: _Count | None = None
    seq: _Count
    floor: tuple[_Number, _Number, _Number, _Number] | None = None
    up: _Vector | None = None
    bodies: Annotated[list[Body], Field(max_length=MOST_BODIES)]

    @field_validator("camera", mode="before")
    @classmethod
    def _known_camera(cls, said: Any) -> Any:
        if said not in [kind.value for kind in FARTHEST]:
            raise ValueError(f"camera is one of {', '.join(FARTHEST)}")
        return CameraKind(said)

    @model_validator(mode="after")
    def _fits_its_camera(self) -> Self:
        if (self.t_us is None) == (self.t_ns is None):
            raise ValueError("give the device time as t_us or as t_ns, one of them")
        joints = len(VENDORS[self.camera].joints)
        for k, body in enumerate(self.bodies):
            if len(body.joints) != joints:
                raise ValueError(f"bodies.{k} has {len(body.joints)} joints; a {self.camera} has {joints}")
        if len({body.id for body in self.bodies}) < len(self.bodies):
            raise ValueError("two bodies have the same id")
        return self

    @property
    def device_ns(self) -> int:
        """ns on the device's clock, any zero."""
        return self.t_ns if self.t_ns is not None else 1000 * (self.t_us or 0)


_REASONS: dict[str, Reason] = {"finite_number": Reason.NOT_FINITE, "json_invalid": Reason.UNDECODABLE}


def decode_frame(datagram: bytes) -> CameraFrame:
    """Raises BadDatagram, which says what is wrong where."""
    if len(datagram) > MOST_BYTES:
        raise BadDatagram(Reason.OUT_OF_RANGE, f"{len(datagram)} bytes; a datagram has at most {MOST_BYTES}")
    try:
        frame = CameraFrame.model_validate_json(datagram)
    except ValidationError as error:
        fault = error.errors(include_url=False, include_context=False, include_input=False)[0]
        place = ".".join(str(part) for part in fault["loc"])
        says = fault["msg"].removeprefix("Value error, ")
        reason = _REASONS.get(fault["type"], Reason.WRONG_SHAPE)
        raise BadDatagram(reason, f"{place}: {says}"[:200] if place else says[:200]) from None
    _check_unit(frame)
    return frame


def _check_unit(frame: CameraFrame) -> None:
    unit, farthest = VENDORS[frame.camera].unit, FARTHEST[frame.camera]
    for k, body in enumerate(frame.bodies):
        largest = float(np.abs(body.positions).max())
        if largest > farthest:
            raise BadDatagram(
                Reason.OUT_OF_RANGE, f"bodies.{k} reaches {largest:g}; positions of a {frame.camera} are in {unit}"
            )
