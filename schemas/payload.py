"""The base of every message, and the few field types that all of them share."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

SCHEMA_VERSION = "2026-11"
"""Travels in every envelope and archive. Only additions keep it; see schemas/README.md."""


class Payload(BaseModel):
    """A message body. Immutable, finite numbers only, unknown fields of a newer writer are ignored."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False, extra="ignore")


Vector3 = Annotated[list[float], Field(min_length=3, max_length=3)]
QuaternionWXYZ = Annotated[list[float], Field(min_length=4, max_length=4)]
SessionTime = Annotated[int, Field(description="ns since the session started, on the session clock")]
