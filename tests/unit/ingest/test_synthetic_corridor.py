"""The synthetic corridor walks: turns at the ends, rests, zones, and a distance that the body really walks."""

from functools import cache

import numpy as np
import pytest

from schemas.conditions import Start
from schemas.vocabulary import Task
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.corridor import SyntheticSixMinutes, SyntheticTenMetres
from services.ingest.synthetic.corridor_parameters import SixMinutesParameters, TenMetresParameters
from services.ingest.synthetic.motions import parse_motion


@cache
def six_minutes(query: str) -> SyntheticSixMinutes:
    return SyntheticSixMinutes(SixMinutesParameters.parse(query))


@cache
def ten_metres(query: str) -> SyntheticTenMetres:
    return SyntheticTenMetres(TenMetresParameters.parse(query))


def path_of(session) -> tuple[np.ndarray, np.ndarray]:
    time_s = np.arange(0.0, session.parameters.duration, 0.02)
    return time_s, session.body(time_s).pelvis.position[:, 0]


SHORT = "corridor=12&duration=90&rests=1&seed=5"


def test_every_turn_is_made_at_an_end_of_the_corridor() -> None:
    session = six_minutes(SHORT)
    time_s, along = path_of(session)
    assert len(session.turns) >= 4
    for number, (start_s, end_s) in enumerate(session.turns):
        within = (time_s > start_s) & (time_s < end_s)
        farthest = along[within].max() if number % 2 == 0 else along[within].min()
        assert farthest == pytest.approx(12.0 if number % 2 == 0 else 0.0, abs=0.3)


def test_the_distance_is_what_the_body_walks_along_the_corridor() -> None:
    session = six_minutes(SHORT)
    time_s, along = path_of(session)
    walked = np.abs(np.diff(along))[(time_s[1:] > session.start_s) & (time_s[1:] <= session.end_s)].sum()
    assert session.distance_m == pytest.approx(walked, rel=0.02)
    assert session.lengths == session.distance_m // 12


def test_a_rest_is_stood_and_the_clock_runs_on() -> None:
    session = six_minutes(SHORT)
    [(start_s, end_s)] = session.rests
    assert end_s - start_s == pytest.approx(12.0)
    resting = np.linspace(start_s + 0.1, end_s - 0.1, 50)
    assert not session.timeline.walking(resting).any()
    assert np.abs(session.body(resting).pelvis.velocity).max() < 1e-6
    assert session.end_s - session.start_s == 90.0
    assert session.description().conditions.test_duration_s == 90.0


def test_steps_get_shorter_towards_the_end() -> None:
    session = six_minutes("corridor=100&duration=80&decline=0.3&wander=0&seed=6")
    early, late = (session.walker.speeds(np.linspace(at, at + 2, 50)).mean() for at in (8.0, 78.0))
    assert late / early == pytest.approx(0.72, abs=0.04)


@pytest.mark.parametrize("start", [0, 1])
def test_a_walkway_is_walked_from_line_to_line(start: int) -> None:
    session = ten_metres(f"walkway=10&trials=2&start={start}&seed=7")
    time_s, along = path_of(session)
    for number, (start_s, end_s) in enumerate(session.walks):
        begun, over = (along[np.searchsorted(time_s, at)] for at in (start_s, end_s))
        way = 1.0 if number % 2 == 0 else -1.0
        assert way * (over - begun) == pytest.approx(10.0, abs=0.35)
    for trial in session.trials:
        assert trial.start_s < trial.enters_s < trial.leaves_s < trial.end_s
        assert 6.0 / (trial.leaves_s - trial.enters_s) == pytest.approx(1.1, rel=0.12)


def test_descriptions_say_task_walkway_and_zone() -> None:
    told = parse_motion("ten_metres", "walkway=14&zone_to=12&start=1&trials=1").description()
    assert (told.task, told.walkway_m) == (Task.TEN_METRE_WALK, 14.0)
    said = told.conditions
    assert (said.start, said.timed_from_m, said.timed_to_m) == (Start.WALKING, 2.0, 12.0)
    walk = parse_motion("six_minutes", "corridor=20&duration=30").description()
    assert (walk.task, walk.walkway_m, walk.conditions.test_duration_s) == (Task.SIX_MINUTE_WALK, 20.0, 30.0)


def test_a_zone_outside_the_walkway_is_refused() -> None:
    with pytest.raises(InvalidOption, match="zone"):
        ten_metres("walkway=6&zone_to=8")
