"""Devices in the database."""

from http import HTTPStatus

from sqlalchemy import select
from sqlalchemy.orm import Session

from services.gateway.access.tables import DeviceRow
from services.gateway.problems import Problem


def foreign_sources(database: Session, clinic: str) -> frozenset[str]:
    """Sources of devices in use that other clinics have registered: theirs alone."""
    theirs = select(DeviceRow.source).where(
        DeviceRow.clinic_id != clinic, DeviceRow.retired.is_(None), DeviceRow.source.is_not(None)
    )
    return frozenset(source for source in database.scalars(theirs) if source is not None)


def check_free(database: Session, source: str | None, device: str | None) -> None:
    """Raises a 409 problem when another device in use has the source."""
    if source is None:
        return
    others = select(DeviceRow.id).where(DeviceRow.source == source, DeviceRow.retired.is_(None))
    if any(other != device for other in database.scalars(others)):
        raise Problem(
            HTTPStatus.CONFLICT,
            "Another device that is in use has this source.",
            "Retire that one first; if it is not in your list, another clinic has it.",
        )
