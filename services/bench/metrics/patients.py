"""Synthetic patients through the whole chain: what a report would say of them, against the footfalls as planned."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.bench.metrics.walked import TrueStride, Walked, walked
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, at_least, at_most, informative

SPEEDS: dict[str, tuple[float, ...]] = {
    "healthy": (0.5, 0.8, 1.2, 1.6),
    "hemiparetic": (0.3, 0.4, 0.6, 0.8),
    "stiff_knee": (0.4, 0.7, 1.0, 1.3),
    "steppage": (0.4, 0.8, 1.1, 1.4),
}
"""m/s, by kind of gait."""
FIRST_SEED = 501
"""Nothing was chosen on the persons from here on; on those from DEVELOPMENT_SEED on, what could be chosen was."""
DEVELOPMENT_SEED = 1
PERSONS = 1
"""Of each kind at each speed; every other one is affected on the left."""
SETTING = "duration=40&tape=0.03&soft_tissue=0.02"
"""A body measured by tape to within 3 %, sensors on skin that moves."""
OURS, PUBLISHED = "rhythmic_ekf", "joukov_published"
STEPS = 2 * PERSONS * sum(len(speeds) for speeds in SPEEDS.values())
NOTE = (
    "patients: each walk's mean against the planned footfalls of the same strides; the body's lengths are known to "
    "3 % (tape=0.03), baseline: the published estimator before the same segmentation. Ratios are affected over other "
    "leg, of healthy walkers right over left. Persons from seed 501 on, none of whom anything was chosen on"
)
RATIOS = ("step length", "stance time", "swing time")


class Errors(NamedTuple):
    """Of one walk, found minus true."""

    speed: float  # m/s
    steps: list[float]  # m, of each step
    cadence: float  # %
    stances: list[float]  # points of the stride, of each leg
    supports: list[float]  # points, first double support of each leg
    ratios: dict[str, float]
    circumduction: list[float]  # m, of each leg
    found: float  # % of the true strides
    invented: int


def patients_section(advance: Callable[[], None]) -> Section:
    """Ours and the published estimator, by kind and together."""
    ours, published = (measured(estimator, advance) for estimator in (OURS, PUBLISHED))
    rows = rows_of("patients", _all(ours), _all(published))
    for kind, walks in ours.items():
        rows += rows_of(f"patients, {kind}", walks, published[kind], detail=True)
    return Section("patients with known truth", [NOTE], rows, [_table(ours)])


def measured(
    estimator: str, advance: Callable[[], None], first_seed: int = FIRST_SEED, persons: int = PERSONS
) -> dict[str, list[Errors]]:
    """Errors of every walk by kind."""
    found: dict[str, list[Errors]] = {kind: [] for kind in SPEEDS}
    seed = first_seed
    for kind, speeds in SPEEDS.items():
        for speed in speeds:
            for _ in range(persons):
                side = ("left", "right")[seed % 2]
                query = f"patient={kind}&speed={speed}&seed={seed}&affected={side}&{SETTING}"
                found[kind].append(errors_of(walked(query, estimator)))
                seed += 1
                advance()
    return found


def errors_of(walk: Walked) -> Errors:
    """Means of the walk against means of the truth of the same strides."""
    straight = [(told, true) for told, true in walk.pairs if told.walking_speed is not None]
    side = walk.affected if walk.kind != "healthy" else Side.RIGHT
    legs = [[pair for pair in straight if pair[0].side is one] for one in (side, side.other)]
    if not all(legs):
        return Errors(np.nan, [], np.nan, [], [], dict.fromkeys(RATIOS, np.nan), [], 0.0, walk.invented)
    return Errors(
        _mean([told.walking_speed - true.speed for told, true in straight if told.walking_speed is not None]),
        [told.step_length_m - true.step_length_m for told, true in straight if told.step_length_m is not None],
        100.0 * (_mean([t.time_s for _, t in straight]) / _mean([s.stride_time_s for s, _ in straight]) - 1.0),
        [100.0 * _mean([_stance(told) - true.stance_fraction for told, true in leg]) for leg in legs],
        [100.0 * _mean([_support(told) - true.first_double_support for told, true in leg]) for leg in legs],
        _ratio_errors(legs),
        [_mean([_of(told.circumduction_m) - true.circumduction_m for told, true in leg]) for leg in legs],
        100.0 * len(walk.pairs) / walk.true,
        walk.invented,
    )


Pairs = Sequence[tuple[Stride, TrueStride]]


def _ratio_errors(legs: Sequence[Pairs]) -> dict[str, float]:
    found = []
    for told in (True, False):
        steps, stances, swings = ([_leg_mean(leg, what, told=told) for leg in legs] for what in RATIOS)
        found.append([one[0] / one[1] for one in (steps, stances, swings)])
    return {name: ours - true for name, ours, true in zip(RATIOS, *found, strict=True)}


def _leg_mean(leg: Pairs, what: str, *, told: bool) -> float:
    def of(stride: Stride, true: TrueStride) -> float:
        if what == "step length":
            return _of(stride.step_length_m) if told else true.step_length_m
        time_s, stance = (stride.stride_time_s, _stance(stride)) if told else (true.time_s, true.stance_fraction)
        return time_s * (stance if what == "stance time" else 1.0 - stance)

    return _mean([of(stride, true) for stride, true in leg])


def _stance(stride: Stride) -> float:
    return _of(stride.stance_fraction)


def _support(stride: Stride) -> float:
    if stride.opposite_toe_off_ns is None:
        return np.nan
    return (stride.opposite_toe_off_ns - stride.start_ns) * 1e-9 / stride.stride_time_s


def _of(value: float | None) -> float:
    return np.nan if value is None else value


def _mean(values: Sequence[float]) -> float:
    known = [value for value in values if np.isfinite(value)]
    return float(np.mean(known)) if known else np.nan


def _all(by_kind: dict[str, list[Errors]]) -> list[Errors]:
    return [walk for walks in by_kind.values() for walk in walks]


def rows_of(name: str, walks: Sequence[Errors], baseline: Sequence[Errors], *, detail: bool = False) -> list[Row]:
    """Mean absolute error, offset and worst case of each figure."""
    found, base_found = (_mean([walk.found for walk in some]) for some in (walks, baseline))
    invented, base_invented = (sum(walk.invented for walk in some) for some in (walks, baseline))
    rows = [
        at_least(f"{name}: strides found", found, "%", 90.0, base_found),
        informative(f"{name}: contacts of strides where no foot came down", invented, "", base_invented),
    ]
    figures: list[tuple[str, str, float | None, Callable[[Errors], list[float]]]] = [
        ("walking speed", "m/s", 0.05, lambda walk: [walk.speed]),
        ("step length", "m", 0.03, lambda walk: walk.steps),
        ("cadence", "%", 1.0, lambda walk: [walk.cadence]),
        ("stance", "% stride", 2.0, lambda walk: walk.stances),
        ("first double support", "% stride", None, lambda walk: walk.supports),
        *((f"{one} ratio", "1", 0.03, _ratio(one)) for one in RATIOS),
        ("circumduction", "m", None, lambda walk: walk.circumduction),
    ]
    for figure, unit, limit, of in figures:
        errors, base = (np.array([e for walk in some for e in of(walk)]) for some in (walks, baseline))
        value, base_value = (float(np.nanmean(np.abs(some))) for some in (errors, base))
        label = f"{name}: {figure}, mean absolute error"
        rows.append(
            informative(label, value, unit, base_value)
            if limit is None
            else at_most(label, value, unit, limit, base_value)
        )
        rows.append(informative(f"{name}: {figure}, offset", float(np.nanmean(errors)), unit, float(np.nanmean(base))))
        worst = (float(np.nanmax(np.abs(some))) for some in (errors, base))
        rows.append(informative(f"{name}: {figure}, worst", next(worst), unit, next(worst)))
    return [_shown(row, detail=detail) for row in rows]


def _shown(row: Row, *, detail: bool) -> Row:
    """Offsets and worst cases are details."""
    return replace(row, detail=detail or not row.name.endswith(("error", "found")))


def _ratio(name: str) -> Callable[[Errors], list[float]]:
    return lambda walk: [walk.ratios[name]]


def _table(by_kind: dict[str, list[Errors]]) -> Table:
    header = (
        "kind",
        "speed, m/s",
        "step, cm",
        "cadence, %",
        "stance, points",
        "ratio step",
        "stance",
        "swing",
        "found, %",
    )
    lines = []
    for kind, walks in by_kind.items():
        cells = [
            _absolute([w.speed for w in walks]), 100 * _absolute([e for w in walks for e in w.steps]),
            _absolute([w.cadence for w in walks]), _absolute([e for w in walks for e in w.stances]),
            *(_absolute([w.ratios[name] for w in walks]) for name in RATIOS), _mean([w.found for w in walks]),
        ]  # fmt: skip
        lines.append((kind, *(f"{cell:.3f}" if cell < 1 else f"{cell:.1f}" for cell in cells)))
    return Table("patients: mean absolute errors by kind", header, lines)


def _absolute(errors: Sequence[float]) -> float:
    return _mean([abs(error) for error in errors])
