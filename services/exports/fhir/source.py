"""What a bundle is made from: plain values, gathered by whoever has them."""

from dataclasses import dataclass
from datetime import datetime

from schemas.metrics import SessionMetrics
from schemas.population import Sex
from schemas.session import SessionDescription


@dataclass(frozen=True, slots=True)
class Subject:
    """Who it is about: a random code. No name is known here."""

    code: str
    year_of_birth: int | None
    sex: Sex | None


@dataclass(frozen=True, slots=True)
class PrintedReport:
    """The report as it is printed."""

    pdf: bytes
    language: str


@dataclass(frozen=True, slots=True)
class Recorded:
    """Where the recording can be had, and the SHA-256 of its raw part, hexadecimal."""

    url: str
    sha256: str | None


@dataclass(frozen=True, slots=True)
class FhirSource:
    """One session. `began` has a time zone; None where something is not there."""

    description: SessionDescription
    metrics: SessionMetrics
    began: datetime
    subject: Subject | None
    report: PrintedReport | None
    recording: Recorded | None
