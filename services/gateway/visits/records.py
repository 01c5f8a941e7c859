"""A patient's sessions in the database, as progress takes them."""

from typing import Any

from sqlalchemy import select
from sqlalchemy.orm import Session

from schemas.conditions import UNSAID, Conditions
from schemas.kinematics import Calibration
from schemas.vocabulary import Task
from services.gateway.sessions.shapes import stored_metrics
from services.gateway.tables import SessionRow
from services.progress.visits import Trial, Visit, in_visits


def sessions_of(database: Session, patient: str) -> list[SessionRow]:
    """All sessions of a patient that had begun or were asked for."""
    return list(database.scalars(select(SessionRow).where(SessionRow.patient_code == patient)))


def visits_of(rows: list[SessionRow]) -> list[Visit]:
    """The sessions as visits in order; interrupted ones count, for the person was there."""
    return in_visits(trial_of(row) for row in rows)


def trial_of(row: SessionRow) -> Trial:
    """One session as progress takes it. One that never started is a walk of which nothing is known."""
    description = row.description or {}
    metrics, body = stored_metrics(row), description.get("anthropometry")
    calibration = None if row.calibration is None else Calibration.model_validate(row.calibration.body)
    return Trial(
        session=row.id,
        began=row.started or row.created,
        task=Task(row.task or Task.WALK),
        conditions=Conditions.model_validate(description["conditions"]) if "conditions" in description else UNSAID,
        walkway_m=row.walkway_m,
        walk_path=description.get("walk_path"),
        estimator=row.estimator,
        sensors=_sensors(description),
        leg_length_m=None if body is None else body["thigh_length_m"] + body["shank_length_m"],
        lengths_from=None if body is None else body["source"],
        datum=None if calibration is None else calibration.datum,
        metrics=metrics if metrics is not None and metrics.final else None,
    )


def _sensors(description: dict[str, Any]) -> tuple[str, ...]:
    worn = [
        f"{sensor['segment']}:{sensor['placement']}" for hub in description.get("hubs", ()) for sensor in hub["sensors"]
    ]
    seen = [f"camera:{camera['kind']}" for camera in description.get("cameras", ())]
    return (*sorted(worn), *sorted(seen))
