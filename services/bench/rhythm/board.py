"""Scoreboard of the rhythm estimators: random periodic velocities, synthetic gait, a treadmill, cost per sample.

Each figure of the trusted rhythm stands beside that of the published oscillator on the same motions; where a rhythm is
known from before, beside that of the cold start. Seeds are 20000-20999 for random motions and from 1000 on for gait and
people; parameters were chosen on other seeds.
"""

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from services.bench.rhythm.distances import person_ratio, person_rows, recorded_rows, side_rows
from services.bench.rhythm.figures import (
    ALL_RANDOM,
    METRONOME,
    PACED_GAIT,
    PACED_GAIT_OF_TWO_KNEES,
    PLAIN_GAIT,
    STOPPED_GAIT,
    STRONG_RANDOM,
    WEAK_RANDOM,
    Pair,
    Wanted,
)
from services.bench.rhythm.motions import INTERVAL_S, Motion, Scenario, gait_motion, random_motion
from services.bench.rhythm.scores import RhythmScore, score_gait, score_random
from services.bench.rhythm.stride_shapes import StrideShapes, load_stride_shapes
from services.bench.rhythm.ten_metres import score_second_trial, ten_metre_rows
from services.bench.rhythm.treadmill import load_shank_rates, score_cadence
from services.bench.rhythm.warm import score_person, warm_rows
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.biomech.rhythm.joukov import JoukovOscillator
from services.biomech.rhythm.parameters import JoukovParameters
from services.biomech.rhythm.trusted import TrustedRhythm
from services.ingest.errors import MissingFile

PROCESSES = 2
RANDOM_SEED, GAIT_SEED = 20000, 1000
RANDOM_MOTIONS, GAIT_MOTIONS, METRONOME_RUNS = 1000, 100, 6
TEN_METRE_WALKS = 20
STRONG_RMS = 0.5  # rad/s: signal to noise of 0 dB
JOINTS = {"1 knee": (0,), "both knees": (0, 1), "4 joints": (0, 1, 2, 3)}
RANDOM_COEFFICIENT_RATE = 0.2  # 1/s, the published simulation's
GAIT_RATES = JoukovParameters()

Score = Callable[[str, Callable[[int], Pair], Sequence[int]], list[Pair]]
Scored = TypeVar("Scored")


class Follow(Protocol):
    """Work through seeds in other processes while a bar is shown."""

    def __call__(self, title: str, score: Callable[[int], Scored], seeds: Sequence[int]) -> list[Scored]:
        """The scores in the order of the seeds."""


def run(json_path: Path | None = None, motions: int = RANDOM_MOTIONS) -> Scoreboard:
    """Score both estimators.

    Args:
        json_path: where to write the rows as well.
        motions: random motions; of gait a tenth of that, 10 to 100, for each scenario and set of joints.
    """
    walks = min(GAIT_MOTIONS, max(10, motions // 10))
    with Progress() as progress, ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        score = partial(_follow_all, pool, progress)
        rows = random_rows(score("random motions", score_random_seed, range(RANDOM_SEED, RANDOM_SEED + motions)))
        rows += _or_skipped("gait", lambda: gait_rows(score, load_stride_shapes(), walks))
        follow = partial(_follow_all, pool, progress)
        rows += _or_skipped("known rhythm", lambda: known_rows(follow, load_stride_shapes(), walks))
        trials = range(GAIT_SEED, GAIT_SEED + min(TEN_METRE_WALKS, walks))
        rows += ten_metre_rows(follow("10 m walks", score_second_trial, trials))
        rows += side_rows(follow)
        rows += _or_skipped("distances", lambda: distance_rows(follow, load_stride_shapes(), walks))
    rows += _or_skipped("treadmill", treadmill_rows) + cost_rows()
    scoreboard = Scoreboard(
        "rhythm",
        rows,
        note="baseline: the published oscillator on the same motions; known rhythm and 10 m: the cold start",
    )
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def _or_skipped(name: str, measure: Callable[[], list[Row]]) -> list[Row]:
    try:
        return measure()
    except MissingFile as missing:
        return [Row(f"{name}: skipped", None, "", str(missing), None, None)]


def _follow_all(
    pool: ProcessPoolExecutor, progress: Progress, title: str, score: Callable[[int], Scored], seeds: Sequence[int]
) -> list[Scored]:
    return list(progress.track(pool.map(score, seeds, chunksize=2), total=len(seeds), description=title))


def score_random_seed(seed: int) -> Pair:
    """Both estimators on one random motion; the published one is told the frequency within +-50 %."""
    motion = random_motion(seed)
    rates = JoukovParameters(initial_frequency=motion.guess, coefficient_rate=RANDOM_COEFFICIENT_RATE)
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
    return Pair(score(motion, trusted), score(motion, literal), float(np.sqrt(np.mean(motion.velocity**2))))


def random_rows(pairs: list[Pair]) -> list[Row]:
    """Random motions: where the signal is at least as strong as the noise, where it is not, and all."""
    strong = [pair for pair in pairs if pair.rms >= STRONG_RMS]
    weak = [pair for pair in pairs if pair.rms < STRONG_RMS]
    return (
        _rows("random >= 0 dB", STRONG_RANDOM, strong)
        + _rows("random, all", ALL_RANDOM, pairs)
        + _rows("random < 0 dB", WEAK_RANDOM, weak)
    )


def gait_rows(score: Score, shapes: StrideShapes, walks: int) -> list[Row]:
    """Walking on, walking with a stop, with a change of speed by 30 %, and to a metronome."""

    def play(scenario: Scenario, name: str, count: int = walks, duration_s: float = 60.0) -> list[Pair]:
        seed = partial(score_gait_seed, scenario=scenario, joints=JOINTS[name], shapes=shapes, duration_s=duration_s)
        return score(f"{scenario}, {name}", seed, range(GAIT_SEED, GAIT_SEED + count))

    rows = []
    for name in JOINTS:
        paced = PACED_GAIT_OF_TWO_KNEES if name == "both knees" else PACED_GAIT
        rows += _rows(f"gait, {name}", PLAIN_GAIT, play("plain", name))
        rows += _rows(f"stop, {name}", STOPPED_GAIT, play("stop", name))
        rows += _rows(f"speed, {name}", paced, play("speed", name))
    return rows + _rows("metronome, both knees", METRONOME, play("metro", "both knees", METRONOME_RUNS, 180.0))


def known_rows(follow: Follow, shapes: StrideShapes, people: int) -> list[Row]:
    """Short walks that start from a rhythm known before, right or wrong."""
    rows = []
    for name, joints in JOINTS.items():
        score = partial(score_person, shapes=shapes, joints=joints)
        starts = follow(f"known rhythm, {name}", score, range(GAIT_SEED, GAIT_SEED + people))
        rows += warm_rows(name, starts, judged=len(joints) > 1)
    return rows


def distance_rows(follow: Follow, shapes: StrideShapes, people: int) -> list[Row]:
    """Distances of learned strides between people, and of the recorded walk."""
    seeds = range(GAIT_SEED, GAIT_SEED + people)
    return person_rows(follow("distance of people", partial(person_ratio, shapes=shapes), seeds)) + recorded_rows()


def _rows(case: str, wanted: Sequence[Wanted], pairs: list[Pair]) -> list[Row]:
    return [figure.row(case, pairs) for figure in wanted] if pairs else []


def treadmill_rows() -> list[Row]:
    """A stroke survivor's shanks: cadence over three strides, phase at mid-swing."""
    rates = load_shank_rates()
    ours = score_cadence(TrustedRhythm(rates.shape[1]).run(rates, INTERVAL_S), rates)
    literal = score_cadence(JoukovOscillator(rates.shape[1], GAIT_RATES).run(rates, INTERVAL_S), rates)
    return [
        at_least("treadmill: cadence within 2 %", ours.right_percent, "%", 93.0, literal.right_percent),
        at_most("treadmill: cadence wrong by 5 %", ours.wrong_percent, "%", 0.0, literal.wrong_percent),
        informative("treadmill: locked", ours.locked_percent, "%", literal.locked_percent),
        informative("treadmill: phase at mid-swing", ours.phase_spread_deg, "deg", literal.phase_spread_deg),
    ]


def cost_rows(samples: int = 60000, repeats: int = 5) -> list[Row]:
    """Processor time per sample of the compiled loop, best of the repeats."""
    rows = []
    for channels in (1, 4):
        wave = np.sin(0.05 * np.arange(samples)[:, None] + np.arange(channels))
        trusted = _cost_us(partial(TrustedRhythm, channels), wave, repeats)
        literal = _cost_us(partial(JoukovOscillator, channels), wave, repeats)
        rows.append(at_most(f"cost, {channels} channels", trusted, "us/sample", 1.0, literal))
    noise = np.random.default_rng(9).standard_normal((samples, 4))
    rows.append(
        informative(
            "cost, 4 channels, known rhythm never found",
            _cost_us(_knowing, noise, repeats),
            "us/sample",
            _cost_us(partial(TrustedRhythm, 4), noise, repeats),
        )
    )
    return rows


def _knowing() -> TrustedRhythm:
    rhythm = TrustedRhythm(4)
    rhythm.start_from(np.random.default_rng(8).standard_normal((2, 4, 7)), 6.0)
    return rhythm


def _cost_us(build: Callable[[], TrustedRhythm | JoukovOscillator], wave: NDArray[np.float64], repeats: int) -> float:
    build().run(wave[:100], INTERVAL_S)
    best_s = float("inf")
    for _ in range(repeats):
        estimator = build()
        start_s = time.process_time()
        estimator.run(wave, INTERVAL_S)
        best_s = min(best_s, time.process_time() - start_s)
    return best_s / len(wave) * 1e6
