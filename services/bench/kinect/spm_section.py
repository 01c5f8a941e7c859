"""Figure 6 of the paper: at which part of a repetition one way of tuning is nearer to the truth than another."""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect.cells import PUBLISHED
from services.bench.kinect.contenders import BEST, BY_FREQUENCY, OPTIMISED, Piece, angles_of
from services.bench.kinect.gates import angle_name
from services.bench.kinect.motions import TASK_NAMES, TASKS
from services.bench.kinect.workers import Spread, workers
from services.bench.line_chart import line_chart
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, informative
from services.biomech.spm.paired import NODES, Cluster, Comparison, compare, normalised
from services.biomech.spm.sign_flips import Flipped, compare_by_flips
from services.ingest.synthetic.whole_body.people import TEST_PEOPLE

Array = NDArray[np.float64]

PROCESSES = 2
COMPARED = {"Q eq. 6-7 against Q eq. 8": (BY_FREQUENCY, OPTIMISED), "Q eq. 8 against ours": (OPTIMISED, BEST)}
"""Which methods; where t is positive, the second is nearer to the truth."""
METHODS = (BY_FREQUENCY, OPTIMISED, BEST)
STEPS = len(METHODS) * len(TASKS) * len(TEST_PEOPLE)
FIGURE_6 = ((1, 14), (1, 4), (4, 5), (2, 5), (3, 9))
"""(Task, angle) of panels a to e."""
MOSTLY = 0.6
"""Share of a repetition that the paper counts."""
SHARES = np.linspace(0.0, 100.0, NODES)
NOTE = (
    "spm: |error| of persons 1 to 7 over a repetition, mean of each person's ten, borders from the truth, 0 to 100 %; "
    "paired, two-tailed, alpha 0.05 for every angle by itself, as in the paper. A row says for how much of the "
    "repetition the second method is nearer (baseline: the first), where, and p of the stretches by random field "
    "theory. p by signs: of the highest |t|, by all 128 exchanges. Every repetition a pair: 70, which seven people "
    "are not; the paper, in which 33 of 40 tests favour eq. 8, does not say what its pairs are"
)


class Compared(NamedTuple):
    """One angle in one task, two methods."""

    task: int
    angle: int
    first: Array  # (people, nodes) deg
    second: Array
    spm: Comparison
    flips: Flipped
    pooled: Comparison  # every repetition a pair of its own


def spm_section(advance: Callable[[], None]) -> Section:
    """Both comparisons for every angle of table 1."""
    with workers(PROCESSES) as spread:
        curves = error_curves(spread, advance)
    rows: list[Row] = []
    tables: list[Table] = []
    charts: dict[str, str] = {}
    for name, (first, second) in COMPARED.items():
        found = [
            compared(task, angle, curves[first, task, angle], curves[second, task, angle])
            for task in TASKS for angle in PUBLISHED[task]
        ]  # fmt: skip
        rows += _rows(name, found)
        tables.append(_table(name, found))
        for one in found:
            if (one.task, one.angle) in FIGURE_6:
                charts |= _charts(name, (first, second), one)
    return Section("where in a repetition methods differ", [NOTE], rows, tables, charts)


def error_curves(spread: Spread, advance: Callable[[], None]) -> dict[tuple[str, int, int], Array]:
    """(people, repetitions, nodes) deg of |error| for (method, task, angle)."""
    pieces = [Piece(name, "clinic", number, task) for name in METHODS for task in TASKS for number in TEST_PEOPLE]
    found: dict[tuple[str, int, int], list[Array]] = {}
    for piece, curves in zip(pieces, spread(curves_of, pieces), strict=True):
        for angle, curve in curves.items():
            found.setdefault((piece.name, piece.task, angle), []).append(curve)
        advance()
    return {key: np.array(rows) for key, rows in found.items()}


def curves_of(piece: Piece) -> dict[int, Array]:
    """(repetitions, nodes) deg of |error| for each angle of the task."""
    angles, watched = angles_of(piece)
    error = np.degrees(np.abs(np.mod(angles - watched.angles + np.pi, 2.0 * np.pi) - np.pi))
    error = np.where(np.isfinite(error), error, 180.0)
    borders = repetition_borders(watched.trial.repetition)
    return {angle: normalised(error[:, angle - 1], borders) for angle in PUBLISHED[piece.task]}


def repetition_borders(repetition: Array) -> list[tuple[int, int]]:
    """[first, end) frames of each repetition, from its number per frame, 0 in none."""
    edges = np.flatnonzero(np.diff(repetition, prepend=0.0, append=0.0))
    return [(int(a), int(b)) for a, b in pairwise(edges) if repetition[a] > 0]


def compared(task: int, angle: int, first: Array, second: Array) -> Compared:
    """All tests of one angle, from (people, repetitions, nodes)."""
    people = first.mean(axis=1), second.mean(axis=1)
    pooled = compare(first.reshape(-1, NODES), second.reshape(-1, NODES))
    return Compared(task, angle, *people, compare(*people), compare_by_flips(*people), pooled)


def _rows(name: str, found: list[Compared]) -> list[Row]:
    better, worse = ([one for one in found if one.spm.share(positive=sign) > 0.0] for sign in (True, False))
    both = {(one.task, one.angle) for one in better} & {(one.task, one.angle) for one in worse}
    pooled = [one.pooled.share(positive=True) for one in found]
    mostly = sum(one.spm.share(positive=True) > MOSTLY for one in better)
    rows = [
        informative(f"spm, {name}: angles compared", len(found), ""),
        informative(f"spm, {name}: second nearer somewhere", len(better), ""),
        informative(f"spm, {name}: second nearer over 60 % of the repetition", mostly, ""),
        informative(f"spm, {name}: first nearer somewhere", len(worse), ""),
        informative(f"spm, {name}: either somewhere, in turns", len(both), ""),
        informative(f"spm, {name}: some difference by exchanged signs", sum(o.flips.p <= 0.05 for o in found), ""),
    ]
    label = f"spm, {name}, every repetition a pair: second nearer"
    rows += [
        informative(f"{label} somewhere", sum(share > 0.0 for share in pooled), ""),
        informative(f"{label} over 60 % of the repetition", sum(share > MOSTLY for share in pooled), ""),
    ]
    for one in found:
        shares = [100.0 * one.spm.share(positive=sign) for sign in (True, False)]
        label = f"spm, {name}: task {one.task}, {angle_name(one.angle)}: {clusters_text(one.spm.clusters)}"
        rows.append(informative(label, shares[0], "% of it", shares[1], detail=True))
    return rows


def clusters_text(clusters: list[Cluster]) -> str:
    """Where, which method is nearer there, and p."""
    return "; ".join(
        f"{c.first:.0f}-{c.last:.0f} % {'second' if c.positive else 'first'}, p {_p(c.p)}" for c in clusters
    ) or "no difference"  # fmt: skip


def _p(p: float) -> str:
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def _table(name: str, found: list[Compared]) -> Table:
    """Every angle: errors of both, t*, where they differ."""
    header = ("angle", "first, deg", "second, deg", "t*", "stretches, which is nearer", "p by signs")
    lines = [
        (
            f"{one.task} {TASK_NAMES[one.task]}: {angle_name(one.angle)}", f"{one.first.mean():.1f}",
            f"{one.second.mean():.1f}", f"{one.spm.threshold:.2f}", clusters_text(one.spm.clusters), _p(one.flips.p),
        )
        for one in found
    ]  # fmt: skip
    return Table(f"{name}: mean |error| over repetitions", header, lines)


def _charts(name: str, methods: tuple[str, str], one: Compared) -> dict[str, str]:
    """Errors with a deviation between people on top, SPM{t} with its threshold below."""
    title = f"{TASK_NAMES[one.task]}, {angle_name(one.angle)}"
    file = f"spm_{list(COMPARED).index(name) + 1}_task_{one.task}_angle_{one.angle}"
    errors: dict[str, list[tuple[float, float]]] = {}
    for method, curves in zip(methods, (one.first, one.second), strict=True):
        mean, deviation = curves.mean(axis=0), curves.std(axis=0, ddof=1)
        errors[_short(method)] = _points(mean)
        errors[f"{_short(method)} + SD"] = _points(mean + deviation)
    colours = dict(zip(errors, ("#1f6fb2", "#a9cbe8", "#2e8b57", "#a9d6bd"), strict=True))
    top = line_chart(f"|error|: {title}", "repetition, %", "deg", errors, colours=colours,
                     dashed=[label for label in errors if label.endswith("SD")])  # fmt: skip
    levels = {f"t* = {one.spm.threshold:.2f}": one.spm.threshold, "-t*": -one.spm.threshold}
    t = {"SPM{t}": _points(one.spm.t)}
    bottom = line_chart(f"{name}: {title}", "repetition, %", "t", t, from_zero=False, levels=levels)
    return {f"{file}_error": top, f"{file}_t": bottom}


def _short(method: str) -> str:
    return {BY_FREQUENCY: "Q eq. 6-7", OPTIMISED: "Q eq. 8", BEST: "ours"}[method]


def _points(curve: Array) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in zip(SHARES, curve, strict=True)]
