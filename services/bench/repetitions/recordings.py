"""Recorded people: the repetitions of an estimated knee against those of the measured one, and steps that are none."""

import math

import numpy as np

from schemas.tasks import Repetition
from schemas.vocabulary import Side
from services.bench.repetitions.runs import of_reference, strides_of, through_chain
from services.bench.repetitions.scores import mean_absolute
from services.bench.scoreboard import Row, at_most, informative
from services.ingest.errors import SourceError
from services.segmentation.repetitions.movement_watch import range_of

MEASURED = {
    "sit to stand (Al Borno)": ("alborno_sub03_sts1", Side.LEFT),
    "drop landings (Fan)": ("fan_knee_drop_landing_left", Side.LEFT),
}
"""Recordings with an optical knee. Nothing was chosen on them. The mechanical hinge of other benchmarks is no knee: it
was turned past 180 deg, where an angle begins anew."""
WALKS = {
    "walk with turns (NeuRA)": "neura_s02_walk",
    "the same, sensors on mid-shank": "neura_s02_walk_midshank",
    "synthetic, slow": "synthetic:walk?speed=0.5&seed=311&duration=60",
    "synthetic, usual": "synthetic:walk?speed=1.1&seed=312&duration=60",
    "synthetic, fast": "synthetic:walk?speed=1.5&seed=313&duration=60",
    "synthetic, one leg alone": "synthetic:walk?worn=2&speed=1.0&seed=314&duration=60",
}
NEAR_S = 0.5
"""s by which turns of the same repetition may differ."""


def measured_rows() -> list[Row]:
    """Agreement with the same segmentation of the optical angle."""
    rows: list[Row] = []
    for name, (spec, side) in MEASURED.items():
        try:
            run = through_chain(spec)
        except (SourceError, ValueError) as error:
            rows.append(Row(f"{name}: {error}"[:120], None, "", None, None, None))
            continue
        ours = [one for one in run.of(side) if one.valid]
        theirs = [one for one in of_reference(run, side) if one.valid]
        pairs = _pairs(ours, theirs)
        ranges = [range_of(one) - range_of(other) for one, other in pairs]
        turns = [(one.turn_ns - other.turn_ns) / 1e9 for one, other in pairs]
        starts = [(one.start_ns - other.start_ns) / 1e9 for one, other in pairs]
        unlike = len(ours) + len(theirs) - 2 * len(pairs)
        rows.append(at_most(f"{name}: repetitions of one angle alone", unlike, "", 0.0, len(theirs)))
        if not pairs:
            continue
        rows += [
            at_most(f"{name}: range, mean absolute difference", math.degrees(mean_absolute(ranges)), "deg", 5.0),
            informative(f"{name}: range, standard deviation", float(np.degrees(np.std(ranges))), "deg"),
            informative(f"{name}: turn, mean absolute difference", mean_absolute(turns), "s"),
            informative(f"{name}: start, mean absolute difference", mean_absolute(starts), "s", detail=True),
        ]
    return rows


def _pairs(ours: list[Repetition], theirs: list[Repetition]) -> list[tuple[Repetition, Repetition]]:
    """Each with the one of the others that turns next to it, nearest first, none twice."""
    near = sorted(
        (abs(one.turn_ns - other.turn_ns), i, k) for i, one in enumerate(ours) for k, other in enumerate(theirs)
    )
    taken: tuple[set[int], set[int]] = set(), set()
    pairs = []
    for apart_ns, i, k in near:
        if apart_ns < NEAR_S * 1e9 and i not in taken[0] and k not in taken[1]:
            taken[0].add(i)
            taken[1].add(k)
            pairs.append((ours[i], theirs[k]))
    return pairs


def walking_rows() -> list[Row]:
    """Steps that were counted as repetitions, per hundred strides."""
    rows: list[Row] = []
    for name, spec in WALKS.items():
        try:
            run, strides = through_chain(spec), strides_of(spec)
        except (SourceError, ValueError) as error:
            rows.append(Row(f"{name}: {error}"[:120], None, "", None, None, None))
            continue
        counted = sum(one.valid for one in run.repetitions)
        rows.append(at_most(f"{name}: steps counted", 100 * counted / strides, "%", 1.0, strides))
    return rows
