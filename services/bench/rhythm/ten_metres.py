"""Ten-metre walks of synthetic people through ingest and estimation: a second trial, cold and knowing the first."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.rhythm import KnownRhythm, LearnedRhythm, Rhythm
from schemas.session import SessionDescription
from services.bench.rhythm.warm import early_deg, phase_percent, strides_to_lock, wrong_percent
from services.bench.rhythm.warm_scores import WarmScore, score_walk
from services.bench.scoreboard import Row, at_most, informative
from services.estimation.node import build
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.ingest.source import iter_messages, open_source

FloatArray = NDArray[np.float64]

DISTANCE_M = 10.0
STANDING_S, PAUSE_S = 4.0, 2.0
MOVING = 1.0  # rad/s of the true stride frequency


class Trial(NamedTuple):
    """What a trial is scored by, and what it leaves."""

    score: WarmScore
    learned: LearnedRhythm | None


def walk_spec(person: int, trial: int) -> str:
    """A person's trial: own speed and asymmetry, and a speed of the day that differs by up to 10 %."""
    own, today = np.random.default_rng([7, person]), np.random.default_rng([8, person, trial])
    speed = own.uniform(0.7, 1.3) * today.uniform(0.9, 1.1)
    asymmetry, seed = own.uniform(0.0, 0.3), 2 * person + trial
    duration = STANDING_S + DISTANCE_M / speed + PAUSE_S
    return (
        f"synthetic:walk?speed={speed:.3f}&asymmetry={asymmetry:.3f}&seed={seed}&standing={STANDING_S:g}"
        f"&pause={PAUSE_S:g}&duration={duration:.2f}&turn_every=0"
    )


def walk_trial(spec: str, known: Sequence[KnownRhythm] = ()) -> Trial:
    """Run a trial through estimation and score its rhythm against the true phase."""
    source = open_source(spec, session="ten", known_rhythms=list(known))
    description = source.describe()
    chain = Chain([HostedNode("estimation", description.session, build(description))])
    truth: dict[int, tuple[float, float]] = {}
    readings: dict[int, list[float]] = {}
    learned: LearnedRhythm | None = None
    for message in iter_messages(source):
        if isinstance(message.payload, ReferenceBatch):
            truth |= _true_rhythm(description, message.payload)
        for produced in chain.push(message):
            match produced.payload:
                case Rhythm() as rhythm:
                    values = zip(rhythm.phase, rhythm.frequency, rhythm.quality, rhythm.locked, strict=True)
                    readings |= dict(zip(rhythm.captured_ns, map(list, values), strict=True))
                case LearnedRhythm() as newest:
                    learned = newest
    return Trial(_scored(truth, readings), learned)


def _true_rhythm(description: SessionDescription, batch: ReferenceBatch) -> dict[int, tuple[float, float]]:
    names = [channel.name for channel in description.reference]
    phase, frequency = names.index("stride_phase"), names.index("stride_frequency")
    return {
        captured_ns: (row[phase] or 0.0, row[frequency] or 0.0)
        for captured_ns, row in zip(batch.captured_ns, batch.values, strict=True)
    }


def _scored(truth: dict[int, tuple[float, float]], readings: dict[int, list[float]]) -> WarmScore:
    """From the first estimate to the last movement. Before the first estimate nobody has moved."""
    moving = [captured_ns for captured_ns, (_, frequency) in truth.items() if frequency > MOVING]
    times = [captured_ns for captured_ns in sorted(readings) if captured_ns in truth and captured_ns <= moving[-1]]
    start = int(np.searchsorted(times, moving[0]))
    return score_walk(
        np.array([readings[t] for t in times], dtype=np.float64), np.array([truth[t][0] for t in times]), start
    )


def score_second_trial(person: int) -> tuple[Trial, Trial]:
    """The second trial of a person: cold, and with what the first trial learned."""
    first = walk_trial(walk_spec(person, 0)).learned
    known = [] if first is None else [KnownRhythm(name="first", kind="previous trial", rhythm=first)]
    spec = walk_spec(person, 1)
    return walk_trial(spec), walk_trial(spec, known)


def ten_metre_rows(people: Sequence[tuple[Trial, Trial]]) -> list[Row]:
    """The started one, with the cold one as baseline."""
    cold, warm = ([pair[i].score for pair in people] for i in range(2))
    return [
        at_most("10 m: until right and locked, median", strides_to_lock(warm, 0.5), "strides", 1.2,
                strides_to_lock(cold, 0.5)),
        informative("10 m: until right and locked, p90", strides_to_lock(warm, 0.9), "strides",
                    strides_to_lock(cold, 0.9)),
        at_most("10 m: wrong while locked", wrong_percent(warm), "%", max(0.5, wrong_percent(cold)),
                wrong_percent(cold)),
        informative("10 m: strides with phase", phase_percent(warm), "%", phase_percent(cold)),
        informative("10 m: phase error, first 3 strides", early_deg(warm), "deg", early_deg(cold)),
        informative("10 m: strides of a walk", float(np.mean([score.strides for score in warm])), "strides"),
    ]  # fmt: skip
