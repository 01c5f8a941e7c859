"""Scoreboard of the rhythm estimators: random periodic velocities, synthetic gait, cost per sample.

Each figure of the trusted rhythm stands beside that of the published oscillator on the same motions. Seeds are
20000-20999 for random motions and from 1000 on for gait; parameters were chosen on other seeds.
"""

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from services.bench.rhythm_motions import INTERVAL_S, Motion, Scenario, gait_motion, random_motion
from services.bench.rhythm_scores import RhythmScore, score_gait, score_random
from services.bench.rhythm_strides import StrideShapes, load_stride_shapes
from services.bench.scoreboard import Row, Scoreboard
from services.biomech.rhythm.joukov import JoukovOscillator
from services.biomech.rhythm.parameters import JoukovParameters
from services.biomech.rhythm.trusted import TrustedRhythm
from services.ingest.errors import MissingFile

PROCESSES = 2
RANDOM_SEED, GAIT_SEED = 20000, 1000
RANDOM_MOTIONS, GAIT_MOTIONS, METRONOME_RUNS = 1000, 100, 6
STRONG_RMS = 0.5  # rad/s: signal to noise of 0 dB
ONE_KNEE, BOTH_KNEES, FOUR_JOINTS = (0,), (0, 1), (0, 1, 2, 3)
RANDOM_RATES = JoukovParameters(coefficient_rate=0.2)
GAIT_RATES = JoukovParameters(coefficient_rate=0.05)

Progressed = Callable[[], None]


class Pair(NamedTuple):
    """Scores of both estimators on one motion."""

    trusted: RhythmScore
    literal: RhythmScore
    rms: float
    """rad/s, of the noise-free velocity."""


def run(json_path: Path | None = None, motions: int = RANDOM_MOTIONS) -> Scoreboard:
    """Score both estimators.

    Args:
        json_path: where to write the rows as well.
        motions: random motions; gait uses a tenth of that, at least 10, for each scenario and set of joints.
    """
    rows = []
    try:
        shapes: StrideShapes | None = load_stride_shapes()
    except MissingFile as missing:
        shapes = None
        rows.append(Row("gait: skipped", None, "", str(missing), None, None))
    walks = min(GAIT_MOTIONS, max(10, motions // 10))
    with Progress() as progress, ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        score = partial(_score_all, pool, progress)
        rows += random_rows(score("random motions", score_random_seed, range(RANDOM_SEED, RANDOM_SEED + motions)))
        if shapes is not None:
            rows += gait_rows(partial(_score_gait, score, shapes, walks))
    rows += cost_rows()
    scoreboard = Scoreboard("rhythm", rows)
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def _score_all(
    pool: ProcessPoolExecutor, progress: Progress, title: str, score: Callable[[int], Pair], seeds: Sequence[int]
) -> list[Pair]:
    return list(progress.track(pool.map(score, seeds, chunksize=4), total=len(seeds), description=title))


def _score_gait(
    score: Callable[[str, Callable[[int], Pair], Sequence[int]], list[Pair]],
    shapes: StrideShapes,
    walks: int,
    scenario: Scenario,
    joints: tuple[int, ...],
) -> list[Pair]:
    count, duration_s = (METRONOME_RUNS, 180.0) if scenario == "metro" else (walks, 60.0)
    seed = partial(score_gait_seed, scenario=scenario, joints=joints, shapes=shapes, duration_s=duration_s)
    return score(f"gait, {scenario}, {len(joints)} joints", seed, range(GAIT_SEED, GAIT_SEED + count))


def score_random_seed(seed: int) -> Pair:
    """Both estimators on one random motion; the published one is told the frequency within +-50 %."""
    motion = random_motion(seed)
    rates = JoukovParameters(initial_frequency=motion.guess, coefficient_rate=RANDOM_RATES.coefficient_rate)
    return _pair(motion, motion.measured, rates, score_random)


def score_gait_seed(
    seed: int, scenario: Scenario, joints: tuple[int, ...], shapes: StrideShapes, duration_s: float
) -> Pair:
    """Both estimators on one walk; the published one starts at walking frequency, driven by the left knee."""
    motion = gait_motion(seed, scenario, shapes, duration_s)
    return _pair(motion, motion.measured[:, list(joints)], GAIT_RATES, score_gait)


def _pair(
    motion: Motion,
    measured: NDArray[np.float64],
    rates: JoukovParameters,
    score: Callable[[Motion, NDArray[np.float64]], RhythmScore],
) -> Pair:
    channels = measured.shape[1]
    trusted = TrustedRhythm(channels).run(measured, INTERVAL_S)
    literal = JoukovOscillator(channels, rates).run(measured, INTERVAL_S)
    rms = float(np.sqrt(np.mean(motion.velocity**2)))
    return Pair(score(motion, trusted), score(motion, literal), rms)


def random_rows(pairs: list[Pair]) -> list[Row]:
    """Set R, all and where the signal is at least as strong as the noise."""
    strong = [pair for pair in pairs if pair.rms >= STRONG_RMS]
    weak = [pair for pair in pairs if pair.rms < STRONG_RMS]
    return [
        _at_least("random >= 0 dB: right", "%", 99.0, right_percent, strong),
        _at_most("random >= 0 dB: wrong while locked", "%", 0.5, wrong_percent, strong),
        _at_most("random >= 0 dB: cycles to right, median", "cycles", 2.0, partial(cycles_to_right, share=0.5), strong),
        _at_most("random >= 0 dB: cycles to right, p90", "cycles", 2.5, partial(cycles_to_right, share=0.9), strong),
        _plain("random >= 0 dB: phase error", "deg", phase_error_deg, strong),
        _at_least("random, all: right", "%", 75.0, right_percent, pairs),
        _at_most("random, all: wrong while locked", "%", 1.5, wrong_percent, pairs),
        _plain("random < 0 dB: right", "%", right_percent, weak),
    ]


def gait_rows(score: Callable[[Scenario, tuple[int, ...]], list[Pair]]) -> list[Row]:
    """Set G."""
    rows = []
    for name, joints in (("1 knee", ONE_KNEE), ("both knees", BOTH_KNEES), ("4 joints", FOUR_JOINTS)):
        plain, stop, speed = score("plain", joints), score("stop", joints), score("speed", joints)
        speed_target = 6.0 if joints == BOTH_KNEES else np.inf
        rows += [
            _at_least(f"gait, {name}: right", "%", 95.0, right_percent, plain),
            _at_most(f"gait, {name}: ends on 2x or 0.5x", "%", 0.0, harmonic_percent, plain),
            _at_most(f"gait, {name}: wrong while locked", "%", 0.5, wrong_percent, plain),
            _at_most(f"gait, {name}: phase error", "deg", 5.0, phase_error_deg, plain),
            _at_most(
                f"gait, {name}: cycles to lock, median", "cycles", 3.5, partial(cycles_to_right, share=0.5), plain
            ),
            _at_most(f"gait, {name}: cycles to lock, p90", "cycles", 4.5, partial(cycles_to_right, share=0.9), plain),
            _at_most(f"stop, {name}: recovery, p90", "cycles", 3.0, partial(recovery_cycles, share=0.9), stop),
            _at_most(f"stop, {name}: locked while standing", "%", 3.0, standing_percent, stop),
            _plain(f"stop, {name}: shift of phase reference, p90", "deg", reference_shift_deg, stop),
            _at_most(
                f"speed +-30 %, {name}: recovery, p90",
                "cycles",
                speed_target,
                partial(recovery_cycles, share=0.9),
                speed,
            ),
        ]
    metro = score("metro", BOTH_KNEES)
    rows.append(_plain("metronome, both knees: time within 2 %", "%", right_time_percent, metro))
    rows.append(_plain("metronome, both knees: wrong while locked", "%", wrong_percent, metro))
    return rows


def cost_rows(samples: int = 60000, repeats: int = 5) -> list[Row]:
    """Time per sample of the compiled loop, best of the repeats, one core."""
    rows = []
    for channels in (1, 4):
        wave = np.sin(0.05 * np.arange(samples)[:, None] + np.arange(channels))
        trusted = _cost_us(partial(TrustedRhythm, channels), wave, repeats)
        literal = _cost_us(partial(JoukovOscillator, channels), wave, repeats)
        rows.append(Row(f"cost, {channels} channels", trusted, "us/sample", "<= 1", trusted <= 1.0, literal))
    return rows


def _cost_us(build: Callable[[], TrustedRhythm | JoukovOscillator], wave: NDArray[np.float64], repeats: int) -> float:
    build().run(wave[:100], INTERVAL_S)
    best_s = float("inf")
    for _ in range(repeats):
        estimator = build()
        start_s = time.perf_counter()
        estimator.run(wave, INTERVAL_S)
        best_s = min(best_s, time.perf_counter() - start_s)
    return best_s / wave.shape[0] * 1e6


Figure = Callable[[list[RhythmScore]], float]


def _figures(figure: Figure, pairs: list[Pair]) -> tuple[float, float]:
    return figure([pair.trusted for pair in pairs]), figure([pair.literal for pair in pairs])


def _at_least(name: str, unit: str, target: float, figure: Figure, pairs: list[Pair]) -> Row:
    ours, literal = _figures(figure, pairs)
    return Row(name, ours, unit, f">= {target:g}", ours >= target, literal)


def _at_most(name: str, unit: str, target: float, figure: Figure, pairs: list[Pair]) -> Row:
    if not np.isfinite(target):
        return _plain(name, unit, figure, pairs)
    ours, literal = _figures(figure, pairs)
    return Row(name, ours, unit, f"<= {target:g}", ours <= target, literal)


def _plain(name: str, unit: str, figure: Figure, pairs: list[Pair]) -> Row:
    ours, literal = _figures(figure, pairs)
    return Row(name, ours, unit, "", None, literal)


def right_percent(scores: list[RhythmScore]) -> float:
    """Share of motions with the right frequency."""
    return 100.0 * float(np.mean([score.is_right for score in scores]))


def right_time_percent(scores: list[RhythmScore]) -> float:
    """Share of time with the right frequency."""
    return 100.0 * float(np.mean([score.right_share for score in scores]))


def wrong_percent(scores: list[RhythmScore]) -> float:
    """Share of the time declared locked that is more than 5 % off."""
    return 100.0 * sum(score.wrong_s for score in scores) / max(sum(score.locked_s for score in scores), 1e-9)


def cycles_to_right(scores: list[RhythmScore], share: float) -> float:
    """Quantile of the cycles until the frequency is right; infinite where too many never are."""
    return _quantile([score.cycles_to_right for score in scores], share)


def recovery_cycles(scores: list[RhythmScore], share: float) -> float:
    """Quantile of the cycles until recovered after an event."""
    return _quantile([score.recovery_cycles for score in scores], share)


def phase_error_deg(scores: list[RhythmScore]) -> float:
    """Median over the motions, degrees."""
    return float(np.degrees(_quantile([score.phase_rms for score in scores], 0.5)))


def reference_shift_deg(scores: list[RhythmScore]) -> float:
    """90th percentile over the motions, degrees."""
    return float(np.degrees(_quantile([score.reference_shift for score in scores], 0.9)))


def standing_percent(scores: list[RhythmScore]) -> float:
    """Mean share of standing time with the lock flag up."""
    return 100.0 * float(np.mean([score.locked_while_standing for score in scores]))


def harmonic_percent(scores: list[RhythmScore]) -> float:
    """Share of motions that end at twice or half the frequency."""
    ratio = np.array([score.final_ratio for score in scores])
    return 100.0 * float(np.mean((np.abs(ratio / 2.0 - 1.0) < 0.05) | (np.abs(ratio / 0.5 - 1.0) < 0.05)))


def _quantile(values: list[float], share: float) -> float:
    """Smallest value that at least `share` of the values do not exceed (infinities allowed)."""
    return float(np.quantile(values, share, method="inverted_cdf")) if values else np.nan
