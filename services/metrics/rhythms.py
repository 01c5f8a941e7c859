"""Distances between learned rhythms: of the two legs, and of each leg from what was known before the session."""

from collections.abc import Sequence
from math import pi

import numpy as np

from schemas.metrics import Doubt, DoubtKind, Metric
from schemas.rhythm import KnownRhythm, LearnedJoint, LearnedRhythm
from schemas.vocabulary import Side
from services.biomech.rhythm.comparison import Comparison, Leg, compare_legs
from services.definitions.definition import Definition
from services.definitions.rhythm import COMPARED_WITH, SIDE_DISTANCE, SIDE_SHAPE, SIDE_TIMING
from services.metrics.intervals import of_mean
from services.metrics.summary import shown, withheld

NOT_YET = "compared at the end of the session"
NOT_LEARNED = "the rhythm was not locked for 3 whole strides"


def rhythm_metrics(learned: LearnedRhythm | None, known: Sequence[KnownRhythm], *, final: bool) -> list[Metric]:
    """The legs against each other, then each leg against each known rhythm; withheld before the end."""
    if learned is None:
        because = NOT_LEARNED if final else NOT_YET
        doubts = [Doubt(kind=DoubtKind.NOT_LOCKED, value=0.0, limit=3.0, subject=None)] if final else []
        rows = (SIDE_DISTANCE, SIDE_SHAPE, SIDE_TIMING)
        metrics = [withheld(definition, None, 0, because, doubts) for definition in rows]
        return metrics + [
            withheld(definition, side.value, 0, because, doubts)
            for each in known
            for definition in COMPARED_WITH[each.kind]
            for side in Side
        ]
    return _between_sides(learned) + [
        metric for each in known for metric in _from_known(learned, each.rhythm, *COMPARED_WITH[each.kind])
    ]


def _between_sides(learned: LearnedRhythm) -> list[Metric]:
    left, right = _legs(learned, Side.LEFT, learned, Side.RIGHT)
    if left is None or right is None:
        because = "no joint was learned on both sides"
        return [
            withheld(definition, None, learned.strides, because)
            for definition in (SIDE_DISTANCE, SIDE_SHAPE, SIDE_TIMING)
        ]
    result = compare_legs(left, right)
    # The right leg has at phase W + shift what the left has at W: half a stride later in a symmetric walk.
    late = (result.shift % (2.0 * pi) - pi) / (2.0 * pi)
    error = result.shift_std / (2.0 * pi)
    timing = shown(SIDE_TIMING, None, late, None, error, learned.strides, of_mean(late, error, learned.strides - 1))
    return [*_distances(result, SIDE_DISTANCE, SIDE_SHAPE, None, learned.strides), timing]


def _from_known(learned: LearnedRhythm, known: LearnedRhythm, distance: Definition, shape: Definition) -> list[Metric]:
    strides = min(learned.strides, known.strides)
    pairs = []
    for side in Side:
        now, then = _legs(learned, side, known, side)
        if now is None or then is None:
            because = "no joint of this leg was learned both times"
            pairs.append([withheld(definition, side.value, strides, because) for definition in (distance, shape)])
        else:
            pairs.append(_distances(compare_legs(now, then), distance, shape, side.value, strides))
    return [metric for metrics in zip(*pairs, strict=True) for metric in metrics]


def _distances(
    result: Comparison, distance: Definition, shape: Definition, side: str | None, strides: int
) -> list[Metric]:
    """`spread` is the distance of single strides from their mean, `mean_std` what chance alone would give."""
    return [
        shown(distance, side, result.distance, result.stride_spread, result.chance, strides),
        shown(shape, side, result.shape, None, result.shape_chance, strides),
    ]


def _legs(
    first: LearnedRhythm, first_side: Side, second: LearnedRhythm, second_side: Side
) -> tuple[Leg | None, Leg | None]:
    """Legs of two rhythms with the joints and harmonics that both have; none where they share no joint."""
    ours, theirs = _joints(first, first_side), _joints(second, second_side)
    shared = sorted(ours.keys() & theirs.keys())
    if not shared:
        return None, None
    harmonics = min(len(first.joints[0].cosine), len(second.joints[0].cosine))
    return (
        _leg([ours[name] for name in shared], harmonics, first.strides),
        _leg([theirs[name] for name in shared], harmonics, second.strides),
    )


def _joints(rhythm: LearnedRhythm, side: Side) -> dict[str, LearnedJoint]:
    """Joints of one side by their name without it."""
    ending = f"_{side.value}"
    return {
        joint.degree_of_freedom.removesuffix(ending): joint
        for joint in rhythm.joints
        if joint.degree_of_freedom.endswith(ending)
    }


def _leg(joints: Sequence[LearnedJoint], harmonics: int, strides: int) -> Leg:
    def terms(values: Sequence[Sequence[float]]) -> "np.typing.NDArray[np.float64]":
        return np.array([row[:harmonics] for row in values])

    return Leg(
        cosine=terms([joint.cosine for joint in joints]),
        sine=terms([joint.sine for joint in joints]),
        spread=terms([joint.spread for joint in joints]),
        strides=strides,
    )
