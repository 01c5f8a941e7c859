"""Time of one filter step: compiled against textbook numpy with Pinocchio, in the same run on the same machine.

Processor time is measured, so that a busy machine disturbs it little. Three configurations go through the same code:
the 14-dof dynamic model of the paper (36 estimated states, 33 measurements), ours (45 states, 30 samples, 2 yaw
and 4 soft-knee measurements), and ours with all that the rhythm needs beside it: the state that expects the learned
jerk, the one with less process noise, and the evidence that decides. The rhythm itself is `ambula bench rhythm`.
"""

import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np
from numpy.typing import NDArray

from schemas.session import Anthropometry
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.biomech.bones import SEGMENTS
from services.biomech.companions import CompanionModel
from services.biomech.kernels.step import step
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf, MeasurementModel, NoiseModel
from services.biomech.pinocchio_model import PinocchioBody
from services.biomech.textbook_ekf import TextbookEkf
from services.estimation.parameters import FilterParameters
from services.estimation.rows import RHYTHM_CHANNELS

Array = NDArray[np.float64]

STEPS, REPEATS, TEXTBOOK_STEPS, TEXTBOOK_REPEATS = 1000, 15, 100, 5
DT_S = 0.01
ALONE_US, WITH_RHYTHM_US = 16.0, 20.0
BODY = Anthropometry(
    height_m=1.75, mass_kg=70, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
)
PAPER = (LowerBodyModel(BODY, translations=True, soft_knees=False), MeasurementModel(True, True, "world"))
OURS = (LowerBodyModel(BODY), MeasurementModel())
BESIDE = CompanionModel((1.0, FilterParameters().calm_share), RHYTHM_CHANNELS)
CONFIGURATIONS: dict[str, tuple[LowerBodyModel, MeasurementModel, CompanionModel | None]] = {
    "14 dof dynamic, 36 states": (*PAPER, None),
    "15 dof gravity, 45 states": (*OURS, None),
    "the same with rhythm, gate and third state": (*OURS, BESIDE),
}


@numba.njit
def _loop(samples, x, P, dt, jerk, fresh, bias, rest, *tables):  # type: ignore[no-untyped-def]
    for k in range(samples.shape[0]):
        step(x, P, dt, jerk, samples[k], fresh, bias, rest, *tables)


class Walk:
    """A filter and the samples of a swinging body to feed it."""

    def __init__(
        self, model: LowerBodyModel, measurement: MeasurementModel, companions: CompanionModel | None = None
    ) -> None:
        self.model, self.measurement, self.companions = model, measurement, companions
        self.mounts = [SensorMount(segment, np.eye(3)) for segment in SEGMENTS]
        self.jerk = np.zeros(len(model.dofs))
        self.rest = np.zeros((3, len(model.dofs)))
        self.rest[0, model.soft] = NoiseModel().soft_knee_std ** 2
        self.fresh = np.ones(len(SEGMENTS), dtype=np.bool_)
        self.samples = self._samples()

    def _samples(self) -> Array:
        random, body = np.random.default_rng(0), PinocchioBody(self.model, self.mounts)
        n, w = len(self.model.dofs), 6.0
        amplitude, phase = random.uniform(0.05, 0.4, n), random.uniform(0, 6, n)
        samples = np.empty((STEPS, len(SEGMENTS), 6))
        for k in range(STEPS):
            angle = w * k * DT_S + phase
            x = amplitude * np.stack([np.sin(angle), w * np.cos(angle), -w * w * np.sin(angle)])
            samples[k] = [body.sample(s, x) for s in range(len(SEGMENTS))]
        return samples + 0.05 * random.normal(size=samples.shape)

    def compiled(self) -> LowerBodyEkf:
        """A fresh compiled filter."""
        return LowerBodyEkf(
            self.model, self.mounts, np.zeros((len(SEGMENTS), 3)), self.measurement, companions=self.companions
        )

    def loop_us(self) -> float:
        """Median us per step inside a compiled loop."""
        return statistics.median(self._loop_once() for _ in range(REPEATS))

    def _loop_once(self) -> float:
        ekf = self.compiled()
        rest = self.rest.copy()
        arguments = (
            ekf.x, ekf.padded_covariance, DT_S, self.jerk, self.fresh, ekf.bias, rest, *ekf.tables()
        )  # fmt: skip
        _loop(self.samples[:1], *arguments)
        return _us_per_step(lambda: _loop(self.samples, *arguments), STEPS)

    def calls_us(self) -> list[float]:
        """us of each step called from Python, as the node does."""
        ekf, times = self.compiled(), []
        for sample in self.samples:
            start = time.thread_time()
            ekf.advance(DT_S, sample, self.fresh, self.jerk, self.rest)
            times.append((time.thread_time() - start) * 1e6)
        return times

    def textbook_us(self) -> float:
        """Median us per step of the textbook filter."""
        return statistics.median(self._textbook_once() for _ in range(TEXTBOOK_REPEATS))

    def _textbook_once(self) -> float:
        ekf = TextbookEkf(self.model, self.mounts, self.measurement, NoiseModel())

        def all_steps() -> None:
            for sample in self.samples[:TEXTBOOK_STEPS]:
                ekf.advance(DT_S, sample, self.jerk)

        return _us_per_step(all_steps, TEXTBOOK_STEPS)


def _us_per_step(work: Callable[[], None], steps: int) -> float:
    start = time.thread_time()
    work()
    return (time.thread_time() - start) / steps * 1e6


def run(json_path: Path | None = None) -> Scoreboard:
    """Measure both configurations."""
    rows: list[Row] = []
    for name, configuration in CONFIGURATIONS.items():
        walk = Walk(*configuration)
        loop, textbook, calls = walk.loop_us(), walk.textbook_us(), walk.calls_us()
        rows += [
            at_most(f"{name}: step in a loop", loop, "us", WITH_RHYTHM_US if walk.companions else ALONE_US, textbook),
            at_least(f"{name}: faster than the textbook", textbook / loop, "x", 15.0),
            informative(f"{name}: one call from Python, median", statistics.median(calls), "us"),
            informative(f"{name}: one call from Python, p99", float(np.quantile(calls, 0.99)), "us"),
        ]
    board = Scoreboard(
        "filter step", rows, "Baseline: the same filter in numpy with Pinocchio, same machine, same run."
    )
    if json_path is not None:
        board.write_json(json_path)
    return board
