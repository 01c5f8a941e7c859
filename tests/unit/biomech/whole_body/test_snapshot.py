"""Snapshots of the whole body's filters: through JSON and on, as if nothing had been between."""

import json

import numpy as np
import pytest

from services.biomech.whole_body.colombel import ColombelCekf
from services.biomech.whole_body.constrained_ekf import OURS, WholeBodyEkf
from services.biomech.whole_body.presets import FLAT_PROCESS, UNCALIBRATED
from services.biomech.whole_body.start import fitted_start


def frames_of(person) -> np.ndarray:
    """Seven seconds of squats, past the moment when lengths are held, with gaps and jumps."""
    frames, rng = person.seen(person.squats(210), 0.02), np.random.default_rng(1)
    for k in range(3, 210, 5):
        frames[k, rng.integers(15)] += rng.normal(0.0, 0.3, 3)
        frames[k, rng.integers(15)] = np.nan
    frames[90:93] = np.nan
    return frames


def advance(ekf, person, frames) -> None:
    for frame in frames:
        ekf.advance(person.dt, frame, person.tracked)


@pytest.mark.parametrize("kind", ["with biases", "without", "calm", "printed"])
@pytest.mark.parametrize("cut", [1, 92, 170])
def test_a_resumed_filter_goes_on_to_the_last_bit(person, kind: str, cut: int) -> None:
    """The other filter's scratch arrays hold what it saw since: that must not matter."""
    start = person.start(biased=kind == "with biases")
    if kind == "calm":
        start = fitted_start(start.q, start.lengths)
    settings = UNCALIBRATED if kind == "calm" else OURS
    ekf = ColombelCekf(start, FLAT_PROCESS) if kind == "printed" else WholeBodyEkf(start, settings)
    frames = frames_of(person)
    with np.errstate(all="ignore"):
        advance(ekf, person, frames[:cut])
        state = json.loads(json.dumps(ekf.snapshot()))
        advance(ekf, person, frames[cut:])
        if kind == "printed":
            resumed, used = ColombelCekf.resumed(state, FLAT_PROCESS), ColombelCekf(start, FLAT_PROCESS)
        else:
            resumed, used = WholeBodyEkf.resumed(state, settings), WholeBodyEkf(start, settings)
        advance(used, person, frames[100:130])
        used.restore(state)
        for other in (resumed, used):
            advance(other, person, frames[cut:])
            assert other.x.tobytes() == ekf.x.tobytes()
            assert other.P.tobytes() == ekf.P.tobytes()
            assert other.angles.tobytes() == ekf.angles.tobytes()
    if kind != "printed":
        assert other.in_view_s == ekf.in_view_s
        assert (other.distances() == ekf.distances()).all()
        assert other.evidence() == ekf.evidence()


def test_a_snapshot_of_another_start_is_refused(person) -> None:
    state = WholeBodyEkf(person.start()).snapshot()
    with pytest.raises(ValueError, match="132 states"):
        WholeBodyEkf(person.start(biased=False)).restore(state)
    printed = ColombelCekf(person.start(biased=False), FLAT_PROCESS)
    with pytest.raises(ValueError, match="another start"):
        printed.restore(state)
