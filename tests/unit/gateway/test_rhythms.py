"""A patient's learned rhythms are kept and handed to the next session: the nearest trial and the nearest visit."""

from datetime import UTC, datetime, timedelta

import pytest

from schemas.rhythm import LearnedJoint, LearnedRhythm
from schemas.signals import LEARNED_RHYTHM
from services.flow.message import Envelope, Message, Stream
from services.gateway.access.scope import EVERYTHING
from services.gateway.bus_feed import BusFeed, BusLink
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.sessions.rhythms import known_rhythms, record_rhythm
from services.gateway.tables import RhythmRow, SessionRow

SOURCE = "synthetic:walk?speed=1.1&seed=3&duration=60"
NOW = datetime(2026, 11, 22, 12, 0, tzinfo=UTC)


def learned(strides: int = 8) -> LearnedRhythm:
    joint = LearnedJoint(degree_of_freedom="knee_flexion_left", cosine=[0.3], sine=[0.1], spread=[0.01])
    return LearnedRhythm(
        captured_ns=9, frequency=6.0, frequency_spread=0.1, strides=strides, quality=0.9, joints=[joint]
    )


def walked(gateway, code: str | None, hours_ago: float, strides: int, name: str) -> None:
    """A session of the patient that began so long ago and learned this many strides."""
    with gateway.database.transaction(EVERYTHING) as database:
        database.add(
            SessionRow(
                clinic_id="main",
                id=name, patient_code=code, title="", protocol="", state="finished",
                created=NOW - timedelta(hours=hours_ago), estimator="ekf", origin="synthetic",
            )
        )  # fmt: skip
        database.flush()
        assert record_rhythm(database, name, learned(strides))


@pytest.fixture
def code(client):
    return client.post("/v1/patients", json={}).json()["code"]


def known(gateway, code):
    with gateway.database.transaction(EVERYTHING) as database:
        return [(each.kind, each.name, each.rhythm.strides) for each in known_rhythms(database, code, NOW)]


def test_the_nearest_trial_of_today_and_the_nearest_earlier_visit(gateway, code):
    assert known(gateway, code) == []
    walked(gateway, code, 100.0, 5, "old")
    walked(gateway, code, 30.0, 6, "visit")
    assert known(gateway, code) == [("previous visit", "visit", 6)]
    walked(gateway, code, 2.0, 7, "first")
    walked(gateway, code, 1.0, 8, "second")
    assert known(gateway, code) == [("previous trial", "second", 8), ("previous visit", "visit", 6)]


def test_other_people_and_unassigned_sessions_are_not_theirs(client, gateway, code):
    other = client.post("/v1/patients", json={}).json()["code"]
    walked(gateway, other, 1.0, 8, "theirs")
    walked(gateway, None, 1.0, 8, "nobodys")
    assert known(gateway, code) == []


def test_a_session_of_a_patient_starts_with_what_is_known(client, gateway, control, code):
    client.post("/v1/sessions", json={"source": SOURCE, "patient": code})
    with gateway.database.transaction(EVERYTHING) as database:
        record_rhythm(database, control.started[0].session, learned())
    client.post("/v1/sessions", json={"source": SOURCE, "patient": code})
    client.post("/v1/sessions", json={"source": SOURCE})
    assert [None if each.known_rhythms is None else len(each.known_rhythms) for each in control.started] == [0, 1, None]
    assert control.started[1].known_rhythms[0].name == control.started[0].session


def test_the_newest_rhythm_of_a_session_is_kept_as_it_comes(gateway, settings, made):
    keeper = SessionKeeper(gateway.database, gateway.live)
    keeper.appeared(made.describe("a"))
    feed = BusFeed(settings, BusLink(), gateway.live, keeper)
    for sequence, strides in enumerate((4, 9)):
        feed.take("a", Message(Stream(LEARNED_RHYTHM, "estimation"), Envelope(0, sequence, 9), learned(strides)))
    with gateway.database.transaction(EVERYTHING) as database:
        assert database.get(RhythmRow, "a").body["strides"] == 9


def test_a_rhythm_of_an_unknown_session_is_left(gateway):
    with gateway.database.transaction(EVERYTHING) as database:
        assert not record_rhythm(database, "nobody", learned())
