"""Events and strides of walks of which only the two shanks are known."""

import pytest

from schemas.vocabulary import GaitEventKind, Side
from services.bench.gait.events import SCORED, detected_share, judge
from services.bench.gait.force_plates import plate_walks
from services.bench.gait.stride_scores import together
from services.bench.gait.strides import ESTIMATOR, through_chain
from services.ingest.errors import SourceError


@pytest.fixture(scope="module")
def judged():
    try:
        walks = plate_walks(SCORED)
    except SourceError as missing:
        pytest.skip(str(missing))
    return [entry for walk in walks[::6] for entry in judge(walk)]


@pytest.mark.parametrize("kind", list(GaitEventKind))
def test_events_against_force_plates(judged, kind):
    matched = together(entry.matched for entry in judged if entry.kind is kind)
    assert len(matched.errors_s) >= 4
    assert detected_share(matched) == 1.0
    assert matched.bias_ms == pytest.approx(0.0, abs=25.0)
    assert matched.spread_ms < 30.0


def test_both_feet_of_a_stroke_survivor_take_as_many_strides():
    try:
        found = through_chain("moving_reality_pp11", ESTIMATOR).found
    except SourceError as missing:
        pytest.skip(str(missing))
    # 113 swings of the left shank and 112 of the right faster than 1.2 rad/s.
    for side, swings in ((Side.LEFT, 113), (Side.RIGHT, 112)):
        assert abs(len(found.times_s(side, GaitEventKind.INITIAL_CONTACT)) - swings) <= 1
        strides = [stride for stride in found.strides if stride.side is side]
        assert abs(len(strides) - swings) <= 1
        assert all(stride.valid for stride in strides)
