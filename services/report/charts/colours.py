"""Colours of charts and pages. Sides differ in dash and letter as well (clinical conventions, section 10.4)."""

from schemas.vocabulary import Side

WHITE = "#FFFFFF"
INK = "#1C2B33"
SOFT_INK = "#51626C"
GRID = "#DDE4E7"
LINE = "#AEB7BD"
REFERENCE = "#D5DADD"
"""Grey of reference bands; nothing is written in it."""
CHANGE_BAND = "#E9EDF0"
"""Baseline +- MDC."""
SIDE: dict[Side, str] = {Side.LEFT: "#C44E00", Side.RIGHT: "#0072B2"}
WHOLE = "#33505F"
"""Of what has no side."""
GOOD, FAIR, POOR = "#1B6E44", "#7A5A00", "#A3262A"
"""Words of a trust grade."""

TEXT_COLOURS: dict[str, str] = {
    "ink": INK, "soft ink": SOFT_INK, "left": SIDE[Side.LEFT], "right": SIDE[Side.RIGHT], "whole": WHOLE,
    "good": GOOD, "fair": FAIR, "poor": POOR,
}  # fmt: skip
"""Everything text is written in."""
HEAD_GROUND = "#F1F4F6"
"""Ground of the quality line."""
TEXT_ON: dict[str, tuple[str, ...]] = {
    WHITE: tuple(TEXT_COLOURS),
    HEAD_GROUND: ("ink", "soft ink", "good", "fair", "poor"),
}
"""What is written on which ground. The sides' own colours stand on white only: on any grey they would be too faint."""


def relative_luminance(colour: str) -> float:
    """Of `#rrggbb`, 0 black to 1 white (WCAG 2.2, relative luminance)."""
    parts = [int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """Contrast ratio of two colours, 1 to 21 (WCAG 2.2)."""
    darker, lighter = sorted((relative_luminance(one), relative_luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)
