import pytest
from sqlalchemy.exc import OperationalError

from services.gateway.access.scope import EVERYTHING
from services.gateway.database import open_database
from services.gateway.live.hub import LiveHub
from services.gateway.parameters import GatewayParameters
from services.gateway.sessions import records
from services.gateway.sessions.keeper import SessionKeeper
from services.gateway.sessions.models import SessionIn


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def keeper(tmp_path, clock):
    database = open_database(f"sqlite:///{tmp_path}/keeper.sqlite")
    yield SessionKeeper(database, LiveHub(clock=clock), clock=clock)
    database.close()


def state(keeper, session):
    with keeper.database.transaction(EVERYTHING) as database:
        row = records.get_session(database, session)
        return row.state, row.reason


def test_a_session_that_starts_by_itself_is_unassigned_and_live(keeper, made):
    keeper.appeared(made.describe("a", title="Device"))
    with keeper.database.transaction(EVERYTHING) as database:
        row = records.get_session(database, "a")
        assert (row.patient_code, row.state, row.title, row.source) == (None, "live", "Device", None)
    assert keeper.live.is_live("a")


def test_final_metrics_finish_a_session(keeper, made):
    keeper.appeared(made.describe("a"))
    keeper.measured("a", made.metrics_at(10.0, final=False))
    assert state(keeper, "a") == ("live", None)
    keeper.measured("a", made.metrics_at(20.0, final=True))
    assert state(keeper, "a") == ("finished", None)
    assert not keeper.live.is_live("a")


def test_a_session_is_as_long_as_the_services_came_not_as_its_last_stride(keeper, made):
    keeper.appeared(made.describe("a"))
    keeper.progressed("a", 24.5)
    keeper.progressed("a", 20.1)
    keeper.measured("a", made.metrics_at(20.0, final=True))
    keeper.settle()
    keeper.progressed("a", 25.0)
    keeper.settle()
    with keeper.database.transaction(EVERYTHING) as database:
        row = records.get_session(database, "a")
        assert (row.state, row.duration_s) == ("finished", 25.0)
        assert (row.ended - row.started).total_seconds() == pytest.approx(25.0)


def test_later_metrics_do_not_replace_final_ones(keeper, made):
    keeper.appeared(made.describe("a"))
    keeper.measured("a", made.metrics_at(20.0, final=True))
    keeper.measured("a", made.metrics_at(10.0, final=False))
    with keeper.database.transaction(EVERYTHING) as database:
        stored = records.get_session(database, "a").metrics
        assert (stored.final, stored.body["captured_ns"]) == (True, 20_000_000_000)


def test_a_session_that_vanishes_is_interrupted_after_a_grace(keeper, clock, made):
    keeper.appeared(made.describe("a"))
    keeper.gone("a")
    keeper.settle()
    assert state(keeper, "a") == ("live", None)
    clock.now += GatewayParameters().final_metrics_grace_s
    keeper.settle()
    name, reason = state(keeper, "a")
    assert name == "interrupted"
    assert "without final metrics" in reason
    assert not keeper.live.is_live("a")


def test_late_final_metrics_finish_an_interrupted_session(keeper, clock, made):
    keeper.appeared(made.describe("a"))
    keeper.gone("a")
    clock.now += 60.0
    keeper.settle()
    keeper.measured("a", made.metrics_at(20.0, final=True))
    assert state(keeper, "a") == ("finished", None)


def test_a_session_that_comes_back_in_time_goes_on(keeper, clock, made):
    keeper.appeared(made.describe("a"))
    keeper.gone("a")
    keeper.appeared(made.describe("a"))
    clock.now += 60.0
    keeper.settle()
    assert state(keeper, "a") == ("live", None)


def test_after_a_restart_a_finished_session_stays_finished(keeper, made):
    keeper.appeared(made.describe("a"))
    keeper.measured("a", made.metrics_at(20.0, final=True))
    keeper.appeared(made.describe("a"))
    assert state(keeper, "a") == ("finished", None)


def test_after_a_restart_sessions_that_nobody_runs_are_interrupted(keeper, clock, made):
    with keeper.database.transaction(EVERYTHING) as database:
        records.add_requested(database, "lost", SessionIn(source="synthetic:walk"), "main")
    keeper.appeared(made.describe("runs"))
    again = SessionKeeper(keeper.database, keeper.live, clock=clock)
    again.adopt_open_sessions()
    again.appeared(made.describe("runs"))
    clock.now += 60.0
    again.settle()
    assert state(again, "lost")[0] == "interrupted"
    assert state(again, "runs")[0] == "live"


def test_live_goes_on_without_the_database_and_what_was_not_written_is_written_later(keeper, monkeypatch, made):
    def away(_scope):
        raise OperationalError("select 1", {}, Exception("gone"))

    with monkeypatch.context() as broken:
        broken.setattr(keeper.database, "transaction", away)
        keeper.appeared(made.describe("a"))
        for at_s in (5.0, 6.0):
            keeper.measured("a", made.metrics_at(at_s, final=False))
        keeper.settle()
        assert keeper.live.is_live("a")
    keeper.settle()
    assert state(keeper, "a") == ("live", None)
    with keeper.database.transaction(EVERYTHING) as database:
        assert records.get_session(database, "a").metrics.body["captured_ns"] == 6_000_000_000
