import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rhythm.reading import RhythmReading
from services.estimation.lower_body.coasting import Coasting
from services.estimation.parameters import CoastingParameters
from services.estimation.samples import FORCE, RATE, Tick

PERIOD_S, DT_S = 1.1, 0.01
EVERYONE = np.ones(len(SEGMENTS), dtype=np.bool_)
NOBODY: frozenset[Segment] = frozenset()
THIGH = SEGMENTS.index(Segment.THIGH_LEFT)


def tick(i: int, silent: int | None = None, scale: float = 1.0) -> Tick:
    """All sensors turn alike, twice as fast as their number; the silent one has no sample."""
    phase = 2.0 * np.pi * i * DT_S / PERIOD_S
    samples = np.zeros((len(SEGMENTS), 6))
    samples[:, RATE] = scale * np.cos(phase) * np.arange(1, 6)[:, None]
    samples[:, FORCE] = [0.0, 9.81, np.sin(phase)]
    fresh = EVERYONE.copy()
    if silent is not None:
        fresh[silent], samples[silent] = False, 0.0
    return Tick(round(i * DT_S * 1e9), samples, fresh)


def reading(i: int, locked: bool = True) -> RhythmReading:
    omega = 2.0 * np.pi / PERIOD_S
    return RhythmReading(omega * i * DT_S, omega, 1.0, locked, np.zeros(4))


def walked(ticks: int, lock_at: int = 0) -> Coasting:
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
    )
    coasting = Coasting(LowerBodyModel(body), SEGMENTS, CoastingParameters())
    for i in range(ticks):
        coasting.stand_in(tick(i), [tick(i).captured_ns] * 5, EVERYONE, DT_S)
        coasting.learn(reading(i, i >= lock_at), DT_S, tick(i), np.zeros((3, 15)), NOBODY)
    return coasting


def stood_in(coasting: Coasting, i: int, silent_s: float) -> Tick:
    heard_ns = [tick(i).captured_ns] * 5
    heard_ns[THIGH] -= round(silent_s * 1e9)
    return coasting.stand_in(tick(i, silent=THIGH), heard_ns, EVERYONE, DT_S)


def test_a_silent_sensor_says_what_it_said_at_this_phase():
    filled = stood_in(walked(330), 330, silent_s=0.3)
    assert filled.fresh.all()
    assert np.abs(filled.samples - tick(330).samples).max() < 0.1


@pytest.mark.parametrize(("ticks", "silent_s"), [(330, 0.05), (330, 6.0), (100, 0.3)])
def test_nobody_is_stood_in_for_at_once_or_for_long_or_before_strides_are_known(ticks, silent_s):
    assert not stood_in(walked(ticks), ticks, silent_s).fresh[THIGH]


def test_strides_before_the_lock_count():
    assert stood_in(walked(331, lock_at=330), 331, silent_s=0.3).fresh.all()


def test_without_a_lock_nobody_is_stood_in_for():
    assert not stood_in(walked(330, lock_at=1000), 330, silent_s=0.3).fresh[THIGH]


def test_when_the_others_stop_nobody_is_moved_on():
    coasting = walked(330)
    for i in range(330, 360):
        stood_in(coasting, i, silent_s=0.3)
        coasting.learn(reading(i), DT_S, tick(i, silent=THIGH, scale=0.0), np.zeros((3, 15)), NOBODY)
    assert not stood_in(coasting, 360, silent_s=0.5).fresh[THIGH]


@pytest.mark.parametrize(("scale", "wrong"), [(1.0, []), (-3.0, [Segment.THIGH_LEFT])])
def test_the_sensor_itself_tells_on_its_return_whether_it_was_right(scale, wrong):
    coasting = walked(330)
    stood_in(coasting, 330, silent_s=0.3)
    coasting.learn(reading(330), DT_S, tick(330, silent=THIGH), np.zeros((3, 15)), NOBODY)
    back = tick(331, scale=scale)
    coasting.stand_in(back, [back.captured_ns] * 5, EVERYONE, DT_S)
    assert coasting.learn(reading(331), DT_S, back, np.zeros((3, 15)), NOBODY) == wrong


def test_a_gap_of_everyone_is_gone_through_in_small_steps():
    coasting = walked(330)
    steps = coasting.steps(tick(329).captured_ns, tick(379))
    assert len(steps) == 49
    assert not any(step.fresh.any() for step in steps)
    times = [tick(329).captured_ns, *(step.captured_ns for step in steps), tick(379).captured_ns]
    assert set(np.diff(times)) == {10_000_000}
    assert coasting.steps(tick(329).captured_ns, tick(329 + 900)) == []
    assert walked(50).steps(tick(49).captured_ns, tick(99)) == []
