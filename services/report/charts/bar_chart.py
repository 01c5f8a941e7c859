"""Values in order as bars: ranges of repetitions, speeds of minutes. What does not count is an empty bar."""

from collections.abc import Sequence
from dataclasses import dataclass

from schemas.vocabulary import Side
from services.report.charts.axes import Plot, digits_of, draw_axes, ticks
from services.report.charts.canvas import Box, Canvas
from services.report.charts.colours import SIDE, SOFT_INK, WHITE, WHOLE

HALF, WHOLE_WIDTH, HEIGHT = 290.0, 600.0, 120.0
"""Widths for half a page and for a whole one, so that text is as large on either."""
LEFT, TOP, RIGHT, BOTTOM = 26.0, 18.0, 6.0, 24.0
MOST_LABELS = 12
WIDEST_SHARE = 0.7
"""Share of its room that a bar takes."""


@dataclass(frozen=True, slots=True)
class Bar:
    """One value in what is shown: whose it is, and whether it counts."""

    side: Side | None
    value: float
    counts: bool


@dataclass(frozen=True, slots=True)
class BarLabels:
    """Words of the chart in the report's language."""

    title: str
    description: str
    x_axis: str
    y_axis: str
    decimal_mark: str


def bar_chart(name: str, bars: Sequence[Bar], labels: BarLabels, *, wide: bool = False) -> str:
    """The chart as SVG. `name` is its id on the page."""
    width = WHOLE_WIDTH if wide else HALF
    canvas = Canvas(width, HEIGHT)
    y_ticks = ticks(0.0, max(bar.value for bar in bars), 4)
    room = max(len(bars), 6)
    plot = Plot(Box(LEFT, TOP, width - RIGHT, HEIGHT - BOTTOM), (0.4, room + 0.6), (0.0, y_ticks[-1]))
    digits = digits_of(y_ticks[1])
    texts = [f"{value:.{digits}f}".replace(".", labels.decimal_mark) for value in y_ticks]
    step = max(1, -(-len(bars) // MOST_LABELS))
    numbers = [(number, str(number)) for number in range(1, len(bars) + 1) if (number - 1) % step == 0]
    draw_axes(canvas, plot, list(zip(y_ticks, texts, strict=True)), numbers)
    for number, bar in enumerate(bars, start=1):
        colour = WHOLE if bar.side is None else SIDE[bar.side]
        left, right = plot.across(number - WIDEST_SHARE / 2), plot.across(number + WIDEST_SHARE / 2)
        box = Box(left, plot.up(bar.value), right, plot.box.bottom)
        canvas.rectangle(box, colour if bar.counts else WHITE, colour)
    canvas.text((0, 7.5), labels.y_axis, colour=SOFT_INK)
    canvas.text((width - RIGHT, HEIGHT - 3), labels.x_axis, anchor="end", colour=SOFT_INK)
    return canvas.svg(name, labels.title, labels.description)
