"""The tables of clinics, accounts and what they may see."""

from datetime import datetime

from sqlalchemy import ForeignKey, Integer, String
from sqlalchemy.orm import Mapped, mapped_column

from services.gateway.tables import Base, UtcTime


class AccountRow(Base):
    """Somebody who works here. No password for those who sign in elsewhere (OIDC)."""

    __tablename__ = "account"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    login: Mapped[str] = mapped_column(String(64), unique=True)
    role: Mapped[str] = mapped_column(String(16))
    clinic_id: Mapped[str] = mapped_column(ForeignKey("clinic.id"), index=True)
    site_admin: Mapped[bool]
    password: Mapped[str | None] = mapped_column(String(200))
    issuer: Mapped[str | None] = mapped_column(String(200))
    subject: Mapped[str | None] = mapped_column(String(200))
    disabled: Mapped[bool]
    created: Mapped[datetime] = mapped_column(UtcTime)
    failures: Mapped[int] = mapped_column(Integer)
    locked_until: Mapped[datetime | None] = mapped_column(UtcTime)


class SignInRow(Base):
    """A browser that has signed in. Secrets are kept as SHA-256; the former one tells a stolen cookie."""

    __tablename__ = "sign_in"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    account_id: Mapped[str] = mapped_column(ForeignKey("account.id", ondelete="CASCADE"), index=True)
    secret: Mapped[str] = mapped_column(String(64))
    former_secret: Mapped[str | None] = mapped_column(String(64))
    renewed: Mapped[datetime] = mapped_column(UtcTime)
    created: Mapped[datetime] = mapped_column(UtcTime)
    seen: Mapped[datetime] = mapped_column(UtcTime)
    confirmed: Mapped[datetime] = mapped_column(UtcTime)


class ApiKeyRow(Base):
    """A key of a machine. The secret is kept as SHA-256, its first letters to tell keys apart."""

    __tablename__ = "api_key"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(64))
    secret: Mapped[str] = mapped_column(String(64))
    role: Mapped[str] = mapped_column(String(16))
    clinic_id: Mapped[str] = mapped_column(ForeignKey("clinic.id"), index=True)
    created_by: Mapped[str | None] = mapped_column(ForeignKey("account.id", ondelete="SET NULL"))
    created: Mapped[datetime] = mapped_column(UtcTime)
    expires: Mapped[datetime] = mapped_column(UtcTime)
    used: Mapped[datetime | None] = mapped_column(UtcTime)
    revoked: Mapped[datetime | None] = mapped_column(UtcTime)


class ShareRow(Base):
    """A patient whom a named colleague of any clinic may see."""

    __tablename__ = "patient_share"

    patient_code: Mapped[str] = mapped_column(ForeignKey("patient.code", ondelete="CASCADE"), primary_key=True)
    account_id: Mapped[str] = mapped_column(ForeignKey("account.id", ondelete="CASCADE"), primary_key=True)
    granted_by: Mapped[str | None] = mapped_column(ForeignKey("account.id", ondelete="SET NULL"))
    granted: Mapped[datetime] = mapped_column(UtcTime)


class DeviceRow(Base):
    """Sensors or a camera that a clinic has."""

    __tablename__ = "device"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    clinic_id: Mapped[str] = mapped_column(ForeignKey("clinic.id"), index=True)
    name: Mapped[str] = mapped_column(String(64))
    kind: Mapped[str] = mapped_column(String(32))
    source: Mapped[str | None] = mapped_column(String(300))
    note: Mapped[str | None] = mapped_column(String(200))
    retired: Mapped[datetime | None] = mapped_column(UtcTime)
    created: Mapped[datetime] = mapped_column(UtcTime)
