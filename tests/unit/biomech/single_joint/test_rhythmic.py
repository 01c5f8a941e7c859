"""Rhythmic tracking of one joint: what each filter and option does, and that doing without it changes nothing."""

import numpy as np
import pytest

from services.bench.joukov.motions import smooth, sweep
from services.bench.joukov.study import GRID, SWEEPING, TEN, rmse
from services.biomech.kernels.evidence import bold_share
from services.biomech.rhythm.parameters import JoukovParameters, TrustedParameters
from services.biomech.single_joint.adaptive_noise import AdaptiveNoise
from services.biomech.single_joint.ekf import SingleJointEkf
from services.biomech.single_joint.innovation_gate import InnovationGate
from services.biomech.single_joint.rhythmic import NO_GATE, track_plain, track_published, track_trusted

DT_S, DENSITY = 0.01, 100.0


@pytest.fixture(scope="module")
def motion():
    return sweep(150, hold_s=40.0)


def test_batch_is_the_loop_over_steps(motion):
    ekf = SingleJointEkf(DENSITY)
    state = track_plain(motion.samples, DT_S, DENSITY).state
    for i in range(200):
        ekf.step(motion.samples[i], DT_S)
        assert np.array_equal(ekf.x, state[i])


def test_without_rates_the_published_filter_is_the_plain_one(motion):
    still = JoukovParameters(coefficient_rate=0.0)
    published = track_published(motion.samples, DT_S, DENSITY, still)
    assert np.array_equal(published.state, track_plain(motion.samples, DT_S, DENSITY).state)


def test_before_a_lock_the_trusted_filter_is_the_plain_one(motion):
    track = track_trusted(motion.samples, DT_S, DENSITY, SWEEPING)
    first = int(np.argmax(track.rhythm[:, 3]))
    assert first > 250
    plain = track_plain(motion.samples, DT_S, DENSITY).state
    assert np.array_equal(track.state[: first + 1], plain[: first + 1])
    assert not np.array_equal(track.state[-100:], plain[-100:])


def test_rhythm_helps_a_late_filter(motion):
    trusted = rmse(motion, track_trusted(motion.samples, DT_S, DENSITY, SWEEPING), 60.0)
    plain = rmse(motion, track_plain(motion.samples, DT_S, DENSITY), 60.0)
    assert np.all(trusted < [0.95, 0.9, 0.5] * plain)


def test_adaptive_noise_acts_in_lock_only(motion):
    adaptive = track_trusted(motion.samples, DT_S, DENSITY, SWEEPING, noise=AdaptiveNoise())
    constant = track_trusted(motion.samples, DT_S, DENSITY, SWEEPING)
    first = int(np.argmax(constant.rhythm[:, 3]))
    assert np.array_equal(adaptive.state[:first], constant.state[:first])
    assert not np.array_equal(adaptive.state, constant.state)


def test_evidence_closes_and_opens_the_gate():
    gate, evidence = InnovationGate(), np.zeros(2)

    def shares(plain: float, rhythmic: float) -> list[float]:
        return [
            bold_share(evidence, plain - rhythmic, DT_S, gate.memory_s, gate.doubt, gate.refusal) for _ in range(300)
        ]

    assert shares(3.0, 3.0) == [0.5] * 300
    worse = shares(3.0, 3.5)
    assert worse[-1] == 0.0
    assert shares(3.5, 3.0)[-1] == 1.0


def test_innovation_gate_undoes_a_rhythm_that_is_wrong():
    motion = smooth(102)
    believing = TrustedParameters(harmonics=10, quality_for_jerk=-1.0)
    plain = rmse(motion, track_plain(motion.samples, DT_S, 10.0))
    wrong = rmse(motion, track_trusted(motion.samples, DT_S, 10.0, believing, gate=NO_GATE)) / plain
    gated = rmse(motion, track_trusted(motion.samples, DT_S, 10.0, believing)) / plain
    assert wrong.max() > 1.05
    assert gated.max() < 1.02


def test_missing_samples_stay_inside(motion):
    samples = motion.samples.copy()
    samples[1000:1050] = np.nan
    for track in (track_plain(samples, DT_S, DENSITY), track_trusted(samples, DT_S, GRID[4] * DT_S, TEN)):
        assert np.isfinite(track.state).all()
