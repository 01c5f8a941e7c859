"""A patient who came several times, written into the database as the keeper would."""

from datetime import UTC, datetime, timedelta

from schemas.conditions import Conditions
from services.gateway.access.scope import EVERYTHING
from services.gateway.sessions import records
from tests.unit.gateway.walk import describe
from tests.unit.progress.patient import SAID, comparison, metric, results

FIRST_DAY = datetime(2026, 9, 1, 9, tzinfo=UTC)


def new_patient(client, **facts):
    return client.post("/v1/patients", json={"population": "stroke_chronic", "paretic_side": "left"} | facts).json()[
        "code"
    ]


def come(gateway, code, session, day, speed, *, distance=0.2, said=SAID, hours=0.0, grade="good"):
    """One walk of the patient, finished."""
    began = FIRST_DAY + timedelta(days=day, hours=hours)
    description = describe(
        session, started_unix_ns=round(began.timestamp() * 1e9), conditions=Conditions.model_validate(said)
    )
    told = results(metric(speed, grade=grade), metric(12, name="strides_counted", side="left", unit="1"),
                   sides=[comparison(distance)])  # fmt: skip
    with gateway.database.transaction(EVERYTHING) as database:
        row = records.record_start(database, description, "main")
        row.patient_code, row.created = code, began
        database.flush()
        records.record_metrics(database, session, told)


def come_often(gateway, code, *speeds):
    """One walk every second week: s0, s1, ..."""
    for number, speed in enumerate(speeds):
        come(gateway, code, f"s{number}", 14 * number, speed, distance=0.2 - 0.02 * number)
