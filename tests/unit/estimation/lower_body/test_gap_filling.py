import json

import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf
from services.estimation.lower_body.gap_filling import GapFilling, Step

BODY = Anthropometry(
    height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
)
MODEL = LowerBodyModel(BODY, False, True)
EVERYONE = tuple(range(5))
FACTOR = 4.0 * np.pi  # rad/s of the swinging shank


class Body:
    """Five sensors at 100 Hz; the left shank swings by half a radian, twice a second."""

    def __init__(self, longest_s: float = 0.25) -> None:
        mounts = [SensorMount(segment, np.eye(3), None) for segment in SEGMENTS]
        self.ekf = LowerBodyEkf(MODEL, mounts, np.zeros((5, 3)))
        self.swinging = next(s for s, mount in enumerate(mounts) if mount.segment is Segment.SHANK_LEFT)
        self.gaps = GapFilling(self.ekf, [100.0] * 5, longest_s)
        self.before_ns = 0

    def hear(self, tick: int, sensors=EVERYONE) -> None:
        now_s, n = 0.01 * tick, len(MODEL.dofs)
        samples = np.tile([0.0, 0.0, 0.0, 0.0, 9.81, 0.0], (5, 1))
        angle = 0.5 * np.sin(FACTOR * now_s)
        samples[self.swinging] = [
            0, 0, 0.5 * FACTOR * np.cos(FACTOR * now_s), 9.81 * np.sin(angle), 9.81 * np.cos(angle), 0,
        ]  # fmt: skip
        fresh = np.isin(np.arange(5), sensors)
        samples[~fresh] = 0.0
        now_ns = tick * 10_000_000
        dt_s, self.before_ns = (now_ns - self.before_ns) * 1e-9, now_ns
        step = Step(now_ns, dt_s, samples, fresh, np.zeros(n), self.ekf.companions.jerk, np.zeros(n))
        self.gaps.advance(step, fresh, np.zeros((3, n)))

    @property
    def knee(self) -> float:
        return float(self.ekf.x[0, MODEL.names.index("knee_flexion_left")])


def others(body: Body) -> list[int]:
    return [s for s in EVERYONE if s != body.swinging]


def walk_with(body: Body, ticks, silent=()) -> Body:
    for tick in ticks:
        if tick not in silent:
            body.hear(tick)
        elif silent[tick]:
            body.hear(tick, others(body))
    return body


@pytest.mark.parametrize("others_speak", [True, False])
def test_a_gap_leaves_nothing_behind(others_speak):
    silent = dict.fromkeys(range(60, 70), others_speak)
    clean, closed, left = Body(), Body(), Body(longest_s=0.0)
    knees = [walk_with(clean, range(72)).knee] + [walk_with(body, range(72), silent).knee for body in (closed, left)]
    assert abs(knees[1] - knees[0]) < 0.002
    assert abs(knees[1] - knees[0]) < 0.5 * abs(knees[2] - knees[0])


def test_it_is_closed_with_the_second_sample_after_it():
    silent = dict.fromkeys(range(60, 70), True)
    closed, left = Body(), Body(longest_s=0.0)
    assert walk_with(closed, range(71), silent).knee == walk_with(left, range(71), silent).knee
    closed.hear(71)
    left.hear(71)
    assert closed.knee != left.knee


@pytest.mark.parametrize("silent", [{}, dict.fromkeys(range(60, 90), True)])
def test_no_gap_or_too_long_a_one_changes_nothing(silent):
    closing, plain = (walk_with(Body(longest_s), range(100), silent) for longest_s in (0.25, 0.0))
    assert np.array_equal(closing.ekf.x, plain.ekf.x)
    assert np.array_equal(closing.ekf.P, plain.ekf.P)


@pytest.mark.parametrize("resume", [61, 65, 68, 70, 72])
def test_overlapping_gaps_survive_a_pause(resume):
    def tick(body: Body, number: int) -> None:
        silent = {body.swinging} if 60 <= number < 69 else set()
        silent |= {0} if 64 <= number < 71 else set()
        body.hear(number, [s for s in EVERYONE if s not in silent])

    whole, first, second = Body(), Body(), Body()
    for number in range(80):
        tick(whole, number)
        if number < resume:
            tick(first, number)
    second.gaps.restore(json.loads(json.dumps(first.gaps.snapshot())))
    second.ekf.x[:], second.ekf.P[:], second.before_ns = first.ekf.x, first.ekf.P, first.before_ns
    second.ekf.unpack_companions(first.ekf.pack_companions())
    for number in range(resume, 80):
        tick(second, number)
    assert np.array_equal(second.ekf.x, whole.ekf.x)
    assert np.array_equal(second.ekf.P, whole.ekf.P)


def test_a_change_from_outside_ends_the_way():
    body = walk_with(Body(), range(65), dict.fromkeys(range(60, 70), True))
    body.gaps.clear()
    plain = walk_with(Body(longest_s=0.0), range(65), dict.fromkeys(range(60, 70), True))
    walk_with(body, range(65, 75), dict.fromkeys(range(65, 70), True))
    walk_with(plain, range(65, 75), dict.fromkeys(range(65, 70), True))
    assert np.array_equal(body.ekf.x, plain.ekf.x)
