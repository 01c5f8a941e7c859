"""Distances between learned rhythms: of the two legs, and of each leg from what was known before."""

from schemas.rhythm import RhythmKind
from services.definitions.definition import Basis, Definition

SIDE_DISTANCE = Definition(
    "rhythm_side_distance",
    "rad",
    False,
    "Root mean square difference of the learned hip and knee flexion of the two legs over the stride, each about its "
    "mean, after the one shift in time that makes it smallest.",
    basis=Basis.RHYTHM,
)
SIDE_SHAPE = Definition(
    "rhythm_side_shape",
    "1",
    False,
    "The same after one leg was scaled to the other by one factor, as a share of its size: 0 equal, 1 unlike.",
    basis=Basis.RHYTHM,
)
SIDE_TIMING = Definition(
    "rhythm_side_timing",
    "1",
    False,
    "By how much of a stride the right leg follows the left by more than half a stride; negative: by less.",
    basis=Basis.RHYTHM,
)


def _compared_with(name: str, whose: str) -> tuple[Definition, Definition]:
    distance = Definition(
        f"rhythm_distance_{name}",
        "rad",
        True,
        f"Root mean square difference of the leg's learned hip and knee flexion from {whose} over the stride, each "
        "about its mean, after the one shift in time that makes it smallest.",
        basis=Basis.RHYTHM,
    )
    shape = Definition(
        f"rhythm_shape_{name}",
        "1",
        True,
        f"The same after {whose} was scaled by one factor, as a share of its size: 0 equal, 1 unlike.",
        basis=Basis.RHYTHM,
    )
    return distance, shape


COMPARED_WITH: dict[RhythmKind, tuple[Definition, Definition]] = {
    "previous trial": _compared_with("previous_trial", "the previous trial's"),
    "previous visit": _compared_with("previous_visit", "the previous visit's"),
    "exemplar": _compared_with("exemplar", "the exemplar's"),
}
"""Distance and shape distance from each kind of known rhythm; in a message only where one of that kind is known."""

RHYTHMS: tuple[Definition, ...] = (
    SIDE_DISTANCE,
    SIDE_SHAPE,
    SIDE_TIMING,
    *(definition for pair in COMPARED_WITH.values() for definition in pair),
)
