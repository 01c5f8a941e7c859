"""Labels that would lie over one another, moved apart."""

from collections.abc import Sequence
from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Label:
    """A text at a place along one axis of the drawing."""

    at: float
    text: str
    colour: str


def apart(labels: Sequence[Label], least: float) -> list[Label]:
    """The labels in order of their place, neighbours at least `least` apart, moved by as little as two need."""
    placed = sorted(labels, key=lambda label: label.at)
    for index in range(1, len(placed)):
        lack = least - (placed[index].at - placed[index - 1].at)
        if lack > 0:
            placed[index - 1] = replace(placed[index - 1], at=placed[index - 1].at - lack / 2)
            placed[index] = replace(placed[index], at=placed[index].at + lack / 2)
    return placed
