"""One motion through the plain, the published and the trusted filter, over the process noise S.

S is the variance of the jerk of one sample at 100 Hz, (rad/s^3)^2. The tuning decides what a rhythm can add, so it is
defined by the plain filter alone: S* is the smallest S of half-decades from 1e2 whose position error is within 1 % of
the best; S*/10 is the lag-limited filter of the published figures.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.motions import SENSOR, JointMotion
from services.bench.rhythm.motions import INTERVAL_S
from services.biomech.rhythm.parameters import JoukovParameters, TrustedParameters
from services.biomech.single_joint.adaptive_noise import AdaptiveNoise
from services.biomech.single_joint.innovation_gate import InnovationGate
from services.biomech.single_joint.rhythmic import NO_GATE, Track, track_plain, track_published, track_trusted

FloatArray = NDArray[np.float64]
Filter = Callable[[JointMotion, float], Track]
"""Motion and S in, estimates out."""

GRID = 10.0 ** np.arange(1.0, 6.01, 0.5)
"""(rad/s^3)^2. The first two are only for S*/10."""
FIRST = 2
DECADE = 2
SETTLED_S = 1.0
"""s of every run that are not scored: the filters find the angle."""
QUANTITIES = ("position", "velocity", "acceleration")
UNITS = ("deg", "deg/s", "deg/s2")

PUBLISHED_COEFFICIENT_RATE = 0.2  # 1/s, the published simulation's
SEVEN, TEN = TrustedParameters(), TrustedParameters(harmonics=10)
UNGATED = TrustedParameters(harmonics=10, quality_for_jerk=-1.0)
"""Believes the jerk whenever there is a lock, whatever its quality."""
SWEEPING = TrustedParameters(
    lowest_frequency_hz=0.12, lowest_bandwidth=3.0, memory_lags=1.0, quality_periods=1.0, slip_tolerance=0.12
)
"""For the published sweep only: it starts below any stride and at first changes its frequency by 63 % per cycle."""


def plain(motion: JointMotion, S: float) -> Track:
    """The EKF without rhythm."""
    return track_plain(motion.samples, INTERVAL_S, S * INTERVAL_S, SENSOR)


def published(motion: JointMotion, S: float) -> Track:
    """The Rhythmic EKF literally, told the frequency 15 % off."""
    rates = JoukovParameters(initial_frequency=motion.guess, coefficient_rate=PUBLISHED_COEFFICIENT_RATE)
    return track_published(motion.samples, INTERVAL_S, S * INTERVAL_S, rates, SENSOR)


def _trusted(
    motion: JointMotion, S: float, parameters: TrustedParameters, **options: AdaptiveNoise | InnovationGate
) -> Track:
    return track_trusted(motion.samples, INTERVAL_S, S * INTERVAL_S, parameters, sensor=SENSOR, **options)  # type: ignore[arg-type]


CURVES: dict[str, Filter] = {
    "plain": plain,
    "published": published,
    "trusted": partial(_trusted, parameters=TEN),
    "7 harmonics": partial(_trusted, parameters=SEVEN),
}
"""Filters that are run at every S. "trusted" has 10 harmonics and both gates: lock quality and innovations."""
OPTIONS: dict[str, Filter] = {
    "no gate at all": partial(_trusted, parameters=UNGATED, gate=NO_GATE),
    "quality gate alone": partial(_trusted, parameters=TEN, gate=NO_GATE),
    "innovation gate alone": partial(_trusted, parameters=UNGATED),
    "adaptive noise": partial(_trusted, parameters=TEN, noise=AdaptiveNoise()),
    "adaptive noise, quality gate alone": partial(_trusted, parameters=TEN, noise=AdaptiveNoise(), gate=NO_GATE),
}
"""Filters that are run at S* and S*/10."""
SWEEP_CURVES: dict[str, Filter] = {
    "plain": plain,
    "published": published,
    "trusted": partial(_trusted, parameters=SWEEPING),
    "adaptive noise": partial(_trusted, parameters=SWEEPING, noise=AdaptiveNoise()),
    "unchanged": partial(_trusted, parameters=TEN),
}
"""For the sweep; "unchanged" is the filter for walking."""


@dataclass(frozen=True)
class Study:
    """Errors of the filters on one motion."""

    curves: dict[str, FloatArray]
    """RMSE over S: (GRID, 3) of position rad, velocity rad/s, acceleration rad/s^2."""
    options: dict[str, FloatArray]
    """RMSE at S* and S*/10: (2, 3)."""

    @property
    def best(self) -> int:
        """Index of S* in the grid."""
        return best_index(self.curves["plain"])

    def ratio(self, name: str, tenth: bool) -> FloatArray:
        """RMSE of the filter over that of the plain one, at S*/10 or at S*: (3,)."""
        index = self.best - DECADE if tenth else self.best
        error = self.options[name][int(tenth)] if name in self.options else self.curves[name][index]
        return np.asarray(error / self.curves["plain"][index])


def best_index(curve: FloatArray) -> int:
    """Index of S* for errors (GRID, 3) of the plain filter."""
    position = curve[FIRST:, 0]
    return FIRST + int(np.argmax(position <= 1.01 * np.min(position)))


def track_errors(motion: JointMotion, track: Track, from_s: float = SETTLED_S) -> FloatArray:
    """Estimate minus truth (n, 3); the angle modulo a turn, as an IMU sees it."""
    error = (track.state - motion.state)[int(from_s / INTERVAL_S) :]
    error[:, 0] = np.angle(np.exp(1j * error[:, 0]))
    return np.asarray(error)


def rmse(motion: JointMotion, track: Track, from_s: float = SETTLED_S) -> FloatArray:
    """RMSE of position, velocity and acceleration, (3,)."""
    return np.asarray(np.sqrt(np.mean(track_errors(motion, track, from_s) ** 2, axis=0)))


def trace_curve(motion: JointMotion, run: Filter, from_s: float = SETTLED_S) -> FloatArray:
    """RMSE of a filter at every S of the grid, (GRID, 3)."""
    return np.array([rmse(motion, run(motion, S), from_s) for S in GRID])


def study_motion(motion: JointMotion) -> Study:
    """All filters on one motion."""
    curves = {name: trace_curve(motion, run) for name, run in CURVES.items()}
    best = best_index(curves["plain"])
    tuned = (GRID[best], GRID[best - DECADE])
    options = {name: np.array([rmse(motion, run(motion, S)) for S in tuned]) for name, run in OPTIONS.items()}
    return Study(curves, options)


def locks_on_fundamental(motion: JointMotion, track: Track, last_s: float = 10.0) -> bool:
    """Whether the phase went the true way over the last seconds within 5 %, with the lock declared at the end."""
    if motion.phase is None:
        return False
    span = int(last_s / INTERVAL_S)
    turned = (track.rhythm[-1, 0] - track.rhythm[-span, 0]) / (motion.phase[-1] - motion.phase[-span])
    return bool(abs(abs(turned) - 1.0) < 0.05 and track.rhythm[-1, 3] > 0.5)
