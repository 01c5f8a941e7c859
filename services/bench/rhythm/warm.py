"""Rows about a rhythm that was learned before: the person's own, and every kind of wrong one, against a cold start."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.rhythm.motions import INTERVAL_S
from services.bench.rhythm.short_walks import Person, draw_person, restless, short_walk
from services.bench.rhythm.stride_shapes import StrideShapes
from services.bench.rhythm.warm_scores import WarmScore, score_walk
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.rhythm.learned import LearnedStrides, velocity_waveform
from services.biomech.rhythm.trusted import TrustedRhythm

FloatArray = NDArray[np.float64]

TEN_METRES_S = 9.0
LEARNING_S, RESTLESS_S = 25.0, 30.0
STANDING = 200
"""Samples before the first movement."""
STRANGER = 100_000
"""Distance between the number of a person and of the stranger whose rhythm is taken for theirs."""
COLD, OWN = "cold", "own"


class Known(NamedTuple):
    """A rhythm as it is given to the estimator."""

    waveform: FloatArray  # (2, C, N) rad/s
    frequency: float  # rad/s


class Start(NamedTuple):
    """One start of one person."""

    walk: WarmScore
    restless_locked: float
    """Share of the time in lock on motion that has no period."""


Starts = dict[str, Start]
"""By what was known."""


def learn(person: Person, joints: Sequence[int]) -> Known:
    """What the person's first trial leaves; a walk that gave nothing leaves a still waveform."""
    walk = short_walk(person, 0, LEARNING_S)
    rhythm, learned = TrustedRhythm(len(joints)), LearnedStrides(len(joints))
    for velocity in walk.measured[:, list(joints)]:
        learned.take(velocity.tolist(), rhythm.step(velocity, INTERVAL_S), INTERVAL_S)
    result = learned.result()
    return Known(velocity_waveform(result.cosine, result.sine, result.frequency), result.frequency)


def known_rhythms(person: Person, shapes: StrideShapes, joints: Sequence[int]) -> dict[str, Known | None]:
    """Nothing, the person's own, and wrong ones: a stranger's, other speeds, one step for a stride, noise, mirrored."""
    own = learn(person, joints)
    waveform, frequency = own
    doubled = np.zeros_like(waveform)
    doubled[:, :, 1::2] = waveform[:, :, : doubled.shape[2] // 2]
    rng = np.random.default_rng([6, person.seed])
    noise = rng.standard_normal(waveform.shape) * np.abs(waveform).mean(axis=(0, 1))
    known: dict[str, Known | None] = {
        COLD: None,
        OWN: own,
        "stranger": learn(draw_person(person.seed + STRANGER, shapes), joints),
        "half the frequency": Known(waveform, 0.5 * frequency),
        "twice the frequency": Known(waveform, 2.0 * frequency),
        "two strides in one": Known(doubled, frequency),
        "noise": Known(noise, frequency),
        "backwards": Known(waveform * np.array([1.0, -1.0])[:, None, None], frequency),
    }
    if len(joints) > 1:
        known["sides exchanged"] = Known(waveform[:, [1, 0, 3, 2][: len(joints)]], frequency)
    return known


def score_person(seed: int, shapes: StrideShapes, joints: Sequence[int]) -> Starts:
    """The second trial of a person from every kind of start."""
    person = draw_person(seed, shapes)
    walk = short_walk(person, 1, TEN_METRES_S)
    measured = np.ascontiguousarray(walk.measured[:, list(joints)])
    aimless = np.ascontiguousarray(restless(person, 1, RESTLESS_S)[:, list(joints)])
    starts: Starts = {}
    for name, known in known_rhythms(person, shapes, joints).items():
        scored = score_walk(_readings(measured, known), walk.phase, STANDING)
        starts[name] = Start(scored, float(np.mean(_readings(aimless, known)[:, 3] > 0.5)))
    return starts


def _readings(measured: FloatArray, known: Known | None) -> FloatArray:
    rhythm = TrustedRhythm(measured.shape[1])
    if known is not None and known.frequency > 0.0:
        rhythm.start_from(*known)
    return rhythm.run(measured, INTERVAL_S)


def warm_rows(name: str, people: Sequence[Starts], *, judged: bool) -> list[Row]:
    """The own rhythm beside the cold start, and the worst of the wrong ones. One knee alone is not judged."""
    wrong_ones = [kind for kind in people[0] if kind not in (COLD, OWN)]
    case = f"known rhythm, {name}"

    def limited(figure: str, value: float, unit: str, limit: float, baseline: float) -> Row:
        row = f"{case}: {figure}"
        return at_most(row, value, unit, limit, baseline) if judged else informative(row, value, unit, baseline)

    def of(kind: str, figure: Callable[[list[WarmScore]], float]) -> float:
        return figure([person[kind].walk for person in people])

    wrong_cold = of(COLD, wrong_percent)
    rows = [
        limited("until right and locked, median", of(OWN, _median), "strides", 1.0, of(COLD, _median)),
        limited("until right and locked, p90", of(OWN, _p90), "strides", 1.2, of(COLD, _p90)),
        limited("wrong while locked", of(OWN, wrong_percent), "%", max(0.5, wrong_cold), wrong_cold),
        informative(f"{case}: strides with phase", of(OWN, phase_percent), "%", of(COLD, phase_percent)),
        informative(f"{case}: phase error, first 3 strides", of(OWN, early_deg), "deg", of(COLD, early_deg)),
        informative(f"{case}: locked without a period", _restless(people, OWN), "%", _restless(people, COLD)),
    ]  # fmt: skip
    latest = max((of(kind, _median), kind) for kind in wrong_ones)
    worst = max((of(kind, wrong_percent), kind) for kind in wrong_ones)
    return [
        *rows,
        limited(f"wrong one ({latest[1]}): until locked", latest[0], "strides", of(COLD, _median) + 0.05,
                of(COLD, _median)),
        limited(f"wrong one ({worst[1]}): wrong while locked", worst[0], "%", max(0.5, wrong_cold), wrong_cold),
    ]  # fmt: skip


def _restless(people: Sequence[Starts], kind: str) -> float:
    return 100.0 * float(np.mean([person[kind].restless_locked for person in people]))


def wrong_percent(scores: list[WarmScore]) -> float:
    """Share of the locked time with a wrong phase."""
    return 100.0 * sum(score.wrong_s for score in scores) / max(sum(score.locked_s for score in scores), 1e-9)


def phase_percent(scores: list[WarmScore]) -> float:
    """Share of all whole strides that have a phase."""
    return 100.0 * sum(score.strides_with_phase for score in scores) / sum(score.strides for score in scores)


def early_deg(scores: list[WarmScore]) -> float:
    """Median over the walks, degrees."""
    return float(np.degrees(np.nanmedian([score.early_error for score in scores])))


def strides_to_lock(scores: list[WarmScore], share: float) -> float:
    """Quantile over the walks; 99 stands for never."""
    found = float(np.quantile([score.strides_to_lock for score in scores], share, method="inverted_cdf"))
    return found if np.isfinite(found) else 99.0


def _median(scores: list[WarmScore]) -> float:
    return strides_to_lock(scores, 0.5)


def _p90(scores: list[WarmScore]) -> float:
    return strides_to_lock(scores, 0.9)
