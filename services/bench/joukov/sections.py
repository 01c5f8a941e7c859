"""One experiment of the report, and what it says of the published figures."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from services.bench import report

COLOURS = {
    "truth": "#222222",
    "EKF": "#d98c1f",
    "literal": "#8e5ea2",
    "ours": "#1f6fb2",
    "ours, adaptive noise": "#2e8b57",
    "ours, as for walking": "#8fc1e8",
    "literal, velocity": "#c9a3d4",
    "literal, acceleration": "#8e5ea2",
    "ours, position": "#9aa5ab",
    "ours, velocity": "#7db8e8",
    "ours, acceleration": "#1f6fb2",
}
"""Of what is drawn in several charts."""


class Finding(NamedTuple):
    """A figure that the paper reports, and what became of it."""

    published: str
    here: str
    S: str
    """Under which S."""


@dataclass(frozen=True)
class Section(report.Section):
    """One experiment: which parameters were chosen on what and scored on what, and under which S."""

    findings: Sequence[Finding] = ()


def up_to(S: float | None) -> str:
    """The largest S at which something holds, in words."""
    return "at no S tried" if S is None else f"up to {power(S)}"


def power(S: float) -> str:
    """S as a power of ten, for a table."""
    mantissa, exponent = f"{S:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def change(ratio: float) -> str:
    """A ratio as a change in percent."""
    return f"{100.0 * (ratio - 1.0):+.0f} %"
