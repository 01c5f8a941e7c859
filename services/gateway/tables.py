"""The tables of the gateway: an index over the archive, and the only place where a session meets a patient."""

from datetime import UTC, date, datetime
from typing import Any

from sqlalchemy import JSON, Date, DateTime, Dialect, Double, ForeignKey, Integer, String, TypeDecorator
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship


class UtcTime(TypeDecorator[datetime]):
    """A point in time, always UTC. SQLite forgets the zone; this puts it back."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """To the database."""
        return None if value is None else value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002
        """From the database."""
        return None if value is None else value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)


class Base(DeclarativeBase):
    """Base of the mapped classes."""


class ClinicRow(Base):
    """A clinic of the site. Patients and sessions belong to one; `keep_days` None: recordings are kept for good."""

    __tablename__ = "clinic"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(100))
    keep_days: Mapped[int | None] = mapped_column(Integer)
    created: Mapped[datetime] = mapped_column(UtcTime)


class PatientRow(Base):
    """A person under a random code. No name, no free text: nothing here identifies anybody."""

    __tablename__ = "patient"

    code: Mapped[str] = mapped_column(String(16), primary_key=True)
    clinic_id: Mapped[str] = mapped_column(ForeignKey("clinic.id"), index=True)
    deleted: Mapped[datetime | None] = mapped_column(UtcTime)
    year_of_birth: Mapped[int | None] = mapped_column(Integer)
    sex: Mapped[str | None] = mapped_column(String(16))
    population: Mapped[str | None] = mapped_column(String(32))
    paretic_side: Mapped[str | None] = mapped_column(String(8))
    created: Mapped[datetime] = mapped_column(UtcTime)


class SessionRow(Base):
    """One session, from the wish to start it to its end."""

    __tablename__ = "session"

    id: Mapped[str] = mapped_column(String(64), primary_key=True)
    clinic_id: Mapped[str] = mapped_column(ForeignKey("clinic.id"), index=True)
    deleted: Mapped[datetime | None] = mapped_column(UtcTime)
    patient_code: Mapped[str | None] = mapped_column(ForeignKey("patient.code"), index=True)
    title: Mapped[str] = mapped_column(String(200))
    protocol: Mapped[str] = mapped_column(String(100))
    state: Mapped[str] = mapped_column(String(16), index=True)
    reason: Mapped[str | None] = mapped_column(String(500))
    created: Mapped[datetime] = mapped_column(UtcTime, index=True)
    started: Mapped[datetime | None] = mapped_column(UtcTime)
    ended: Mapped[datetime | None] = mapped_column(UtcTime)
    duration_s: Mapped[float | None] = mapped_column(Double)
    estimator: Mapped[str] = mapped_column(String(64))
    origin: Mapped[str] = mapped_column(String(16))
    source: Mapped[str | None] = mapped_column(String(300))
    task: Mapped[str | None] = mapped_column(String(32))
    walkway_m: Mapped[float | None] = mapped_column(Double)
    description: Mapped[dict[str, Any] | None] = mapped_column(JSON)
    metrics: Mapped["MetricsRow | None"] = relationship(lazy="selectin")
    calibration: Mapped["CalibrationRow | None"] = relationship(lazy="selectin")
    patient: Mapped["PatientRow | None"] = relationship(lazy="selectin", viewonly=True)


class MetricsRow(Base):
    """The last metrics message of a session, as it came (schemas.metrics.SessionMetrics)."""

    __tablename__ = "session_metrics"

    session_id: Mapped[str] = mapped_column(ForeignKey("session.id", ondelete="CASCADE"), primary_key=True)
    final: Mapped[bool]
    received: Mapped[datetime] = mapped_column(UtcTime)
    software: Mapped[str] = mapped_column(String(100))
    body: Mapped[dict[str, Any]] = mapped_column(JSON)


class FormerMetricsRow(Base):
    """Final metrics of a session as another software version computed them, replaced since by `ambula reprocess`."""

    __tablename__ = "session_former_metrics"

    session_id: Mapped[str] = mapped_column(ForeignKey("session.id", ondelete="CASCADE"), primary_key=True)
    software: Mapped[str] = mapped_column(String(100), primary_key=True)
    received: Mapped[datetime] = mapped_column(UtcTime)
    replaced: Mapped[datetime] = mapped_column(UtcTime)
    body: Mapped[dict[str, Any]] = mapped_column(JSON)


class CalibrationRow(Base):
    """The last calibration of a session, as it came (schemas.kinematics.Calibration)."""

    __tablename__ = "session_calibration"

    session_id: Mapped[str] = mapped_column(ForeignKey("session.id", ondelete="CASCADE"), primary_key=True)
    received: Mapped[datetime] = mapped_column(UtcTime)
    body: Mapped[dict[str, Any]] = mapped_column(JSON)


class RhythmRow(Base):
    """The last rhythm a session learned, as it came (schemas.rhythm.LearnedRhythm)."""

    __tablename__ = "session_rhythm"

    session_id: Mapped[str] = mapped_column(ForeignKey("session.id", ondelete="CASCADE"), primary_key=True)
    received: Mapped[datetime] = mapped_column(UtcTime)
    body: Mapped[dict[str, Any]] = mapped_column(JSON)


class BaselineRow(Base):
    """The visit a patient's progress counts from, with the thresholds that were chosen then and stay."""

    __tablename__ = "patient_baseline"

    patient_code: Mapped[str] = mapped_column(ForeignKey("patient.code", ondelete="CASCADE"), primary_key=True)
    session_id: Mapped[str] = mapped_column(ForeignKey("session.id", ondelete="CASCADE"))
    frozen: Mapped[datetime] = mapped_column(UtcTime)
    body: Mapped[dict[str, Any]] = mapped_column(JSON)


class TreatmentRow(Base):
    """Something that was done for the patient, to be seen beside the progress."""

    __tablename__ = "patient_treatment"

    id: Mapped[int] = mapped_column(Integer, primary_key=True, autoincrement=True)
    patient_code: Mapped[str] = mapped_column(ForeignKey("patient.code", ondelete="CASCADE"), index=True)
    on: Mapped[date] = mapped_column("on_date", Date)
    what: Mapped[str] = mapped_column(String(32))
