"""Strides of a recorded walk, through the whole chain, against reviewed contacts and optical ankles."""

from functools import cache

import pytest

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.stride_scores import length_errors, match, together
from services.bench.gait.strides import NEURA, Run, through_chain
from services.ingest.errors import SourceError

WALK_FROM_S, TURN_FROM_S, TURN_TO_S, WALK_TO_S = 11.0, 14.54, 16.50, 21.5


@cache
def replayed(estimator: str) -> Run | str:
    try:
        return through_chain(NEURA, estimator)
    except SourceError as missing:
        return str(missing)


@pytest.fixture(params=["rhythmic_ekf", "ekf"])
def run(request) -> Run:
    result = replayed(request.param)
    if isinstance(result, str):
        pytest.skip(result)
    return result


@pytest.mark.parametrize("side", list(Side))
def test_as_many_strides_as_the_reviewed_contacts_say(run, side):
    reviewed = run.truth.contact_edges_s(side, GaitEventKind.INITIAL_CONTACT)
    found = [stride for stride in run.found.strides if stride.side is side]
    assert abs(len(found) - (len(reviewed) - 1)) <= 1
    assert all(stride.valid for stride in found)
    assert [stride.index for stride in found] == list(range(len(found)))


@pytest.mark.parametrize("kind", list(GaitEventKind))
def test_every_event_of_the_optical_ankles_is_found_in_time(run, kind):
    matched = together(match(run.truth.ankle_turns_s(side, kind), run.found.times_s(side, kind)) for side in Side)
    assert matched.missed == 0
    assert matched.extra <= 2
    assert abs(matched.bias_ms) < 20
    assert matched.spread_ms < 30


def test_a_foot_is_flat_only_between_its_contact_and_its_toe_off(run):
    contact, toe_off = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF
    for side in Side:
        for stride in (s for s in run.found.strides if s.side is side and not s.turning):
            flat = [t for t in run.truth.contact_edges_s(side, contact) if stride.start_ns < t * 1e9 < stride.end_ns]
            rise = [t for t in run.truth.contact_edges_s(side, toe_off) if stride.start_ns < t * 1e9 < stride.end_ns]
            assert len(flat) == len(rise) == 1
            assert flat[0] < rise[0] < stride.toe_off_ns * 1e-9


def test_nobody_walks_while_standing(run):
    times = [event.captured_ns * 1e-9 for event in run.found.events]
    assert min(times) > WALK_FROM_S
    assert max(times) < WALK_TO_S


def test_the_turn_is_marked(run):
    for stride in run.found.strides:
        start_s, end_s = stride.start_ns * 1e-9, stride.end_ns * 1e-9
        if start_s > TURN_FROM_S - 0.5 and end_s < TURN_TO_S + 0.5:
            assert stride.turning
        if end_s < TURN_FROM_S - 0.2 or start_s > TURN_TO_S + 0.2:
            assert not stride.turning


def test_lengths_and_speed_of_straight_strides(run):
    length, speed = length_errors(run.found, run.truth)
    assert len(length) >= 6
    assert max(abs(length)) < 0.15
    assert abs(speed).mean() < 0.07


def test_steps_are_plausible_and_symmetric(run):
    for stride in run.found.straight():
        assert 0.55 < stride.stance_fraction < 0.72
        assert stride.step_time_s == pytest.approx(stride.stride_time_s / 2, rel=0.15)
        assert 0 < stride.step_length_std_m < 0.1
        assert stride.walking_speed == pytest.approx(stride.stride_length_m / stride.stride_time_s)
        assert len(stride.curves) == 15
