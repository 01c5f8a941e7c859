"""Two sources of the same angles, each with errors of its own kind."""

import numpy as np
import pytest

from services.biomech.fusion.parameters import SHARED
from services.biomech.fusion.shared_angles import SharedAngles, Told

N = len(SHARED)
DT_S = 1.0 / 30.0
KNEE = SHARED.index("knee_flexion_right")
HEADING = SHARED.index("pelvis_rotation")


class Walk:
    """Angles with a period of 1.1 s, told by inertial sensors with an offset and by a camera that is late, makes too
    little of large movements, has an offset, and errs slowly beside."""

    def __init__(self, seed: int, frames: int = 1200) -> None:
        rng = np.random.default_rng(seed)
        self.t = np.arange(frames) * DT_S
        self._amplitude = np.radians(rng.uniform(5.0, 30.0, N))
        self._phase = rng.uniform(0.0, 6.0, (2, N))
        self.truth = self._angle(self.t)
        self._inertial_offset = np.radians(rng.normal(0.0, 2.0, N))
        self._camera_offset = np.radians(rng.normal(0.0, 4.0, N))
        error = rng.normal(size=N)
        self._error = np.zeros((frames, N))
        for k in range(frames):
            error = 0.94 * error + 0.34 * rng.normal(size=N)
            self._error[k] = np.radians(2.5) * error

    def _angle(self, t):
        turn = 2.0 * np.pi * np.asarray(t)[..., None] / 1.1
        return self._amplitude * (np.sin(turn + self._phase[0]) + 0.3 * np.sin(2.0 * turn + self._phase[1]))

    def _rate(self, t):
        return (self._angle(t + 1e-5) - self._angle(t - 1e-5)) / 2e-5

    def inertial(self, k: int) -> Told:
        position = self.truth[k] + self._inertial_offset
        return Told(position, self._rate(self.t[k]), np.full(N, 0.05), np.ones(N, dtype=bool))

    def camera(self, k: int) -> Told:
        late = self.t[k] - 0.05
        position = 0.9 * self._angle(late) + self._camera_offset + self._error[k]
        return Told(position, 0.9 * self._rate(late), np.full(N, 0.1), np.ones(N, dtype=bool))


def rms_deg(errors) -> float:
    return float(np.degrees(np.sqrt(np.mean(np.square(errors)))))


@pytest.fixture(scope="module")
def learned():
    """Ten walks of 40 s, compared until 5 s before their end."""
    found = []
    for seed in range(10):
        walk, shared = Walk(seed), SharedAngles()
        for k in range(1050):
            shared.compare(DT_S, walk.inertial(k), walk.camera(k))
        found.append((walk, shared))
    return found


def test_the_camera_that_was_compared_stands_in_for_the_sensors(learned):
    alone, before, after = [], [], []
    for walk, shared in learned:
        for k in range(1050, 1200):
            alone.append(walk.camera(k).position - walk.truth[k])
            before.append(shared.from_inertial(walk.inertial(k)).position - walk.truth[k])
            after.append(shared.from_camera(walk.camera(k)).position - walk.truth[k])
    assert rms_deg(after) < 0.65 * rms_deg(alone)
    assert rms_deg(after) < rms_deg(before) + 2.0


def test_together_they_are_no_worse_than_the_better_one(learned):
    inertial, fused = [], []
    for walk, shared in learned:
        # Of the heading the camera alone knows anything.
        told, given = shared.from_inertial(walk.inertial(1100)), walk.inertial(1100)
        inertial.append(np.delete(given.position - walk.truth[1100], HEADING))
        fused.append(np.delete(told.position - walk.truth[1100], HEADING))
    assert rms_deg(fused) < rms_deg(inertial) + 0.3


def test_a_heading_that_is_whole_turns_away_is_the_same_heading():
    walk, plain, turned = Walk(3), SharedAngles(), SharedAngles()
    whole = np.zeros(N)
    whole[HEADING] = 4.0 * np.pi
    for k in range(300):
        inertial = walk.inertial(k)
        plain.compare(DT_S, inertial, walk.camera(k))
        turned.compare(DT_S, inertial._replace(position=inertial.position + whole), walk.camera(k))
    apart = turned.manner.coefficients[HEADING] - plain.manner.coefficients[HEADING]
    assert np.remainder(apart[0] + np.pi, 2 * np.pi) == pytest.approx(np.pi, abs=1e-6)
    np.testing.assert_allclose(turned.offset, plain.offset, atol=1e-9)


def test_what_one_does_not_see_teaches_nothing():
    walk, shared = Walk(4), SharedAngles()
    valid = np.ones(N, dtype=bool)
    valid[KNEE] = False
    for k in range(300):
        shared.compare(DT_S, walk.inertial(k), walk.camera(k)._replace(valid=valid))
    assert shared.offset[KNEE] == pytest.approx([0.0, 0.0])
    assert shared.manner.coefficients[KNEE] == pytest.approx([0.0, 1.0, 0.0])
    assert not shared.from_camera(walk.camera(0)._replace(valid=valid)).valid[KNEE]


def test_covariances_stay_positive_and_deviations_bounded():
    walk, shared = Walk(5), SharedAngles()
    for k in range(1200):
        shared.compare(DT_S, walk.inertial(k), walk.camera(k))
    state = shared.snapshot()
    for part in state.values():
        assert (np.linalg.eigvalsh(part["P"]) > 0.0).all()
        np.testing.assert_allclose(part["P"], np.swapaxes(part["P"], 1, 2), atol=1e-12)
    assert (shared.from_camera(walk.camera(0)).std < 0.5).all()


def test_it_goes_on_from_a_snapshot_to_the_last_bit():
    walk, whole, first = Walk(6), SharedAngles(), SharedAngles()
    for k in range(200):
        whole.compare(DT_S, walk.inertial(k), walk.camera(k))
    for k in range(100):
        first.compare(DT_S, walk.inertial(k), walk.camera(k))
    second = SharedAngles()
    second.restore({part: {n: a.copy() for n, a in arrays.items()} for part, arrays in first.snapshot().items()})
    for k in range(100, 200):
        second.compare(DT_S, walk.inertial(k), walk.camera(k))
    assert (second.from_camera(walk.camera(7)).position == whole.from_camera(walk.camera(7)).position).all()
    assert (second.from_inertial(walk.inertial(7)).std == whole.from_inertial(walk.inertial(7)).std).all()
