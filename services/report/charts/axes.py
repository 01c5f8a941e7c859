"""Round ticks, and a plotting area that turns values into places on the drawing."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from services.report.charts.canvas import TEXT_SIZE, Box, Canvas, Point
from services.report.charts.colours import GRID, LINE, SOFT_INK

LEAST_SPAN = 1e-9
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


def step_for(span: float, most: int) -> float:
    """The smallest round step that divides `span` into at most `most` parts."""
    rough = max(span, LEAST_SPAN) / most
    size = 10.0 ** math.floor(math.log10(rough))
    return next(factor * size for factor in STEPS if factor * size >= rough * (1 - 1e-9))


def ticks(low: float, high: float, most: int = 5) -> list[float]:
    """Round values from just below `low` to just above `high`."""
    step = step_for(high - low, most)
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [number * step for number in range(first, max(last, first + 1) + 1)]


def digits_of(step: float) -> int:
    """Digits after the mark that tell multiples of `step` apart."""
    return next((digits for digits in range(4) if abs(round(step, digits) - step) < 1e-9), 4)


@dataclass(frozen=True, slots=True)
class Plot:
    """Where a chart's values lie: `box` on the drawing, from `x` and `y` (low, high) in what is shown."""

    box: Box
    x: tuple[float, float]
    y: tuple[float, float]

    def at(self, x: float, y: float) -> Point:
        """Place of a value."""
        return self.across(x), self.up(y)

    def across(self, x: float) -> float:
        """Place along the horizontal axis."""
        (low, high), box = self.x, self.box
        return box.left + (x - low) / (high - low) * (box.right - box.left)

    def up(self, y: float) -> float:
        """Place along the vertical axis."""
        (low, high), box = self.y, self.box
        return box.bottom - (y - low) / (high - low) * (box.bottom - box.top)

    def inside(self, y: float) -> float:
        """A value, drawn back to the edge of the plot."""
        return min(max(y, self.y[0]), self.y[1])

    def points(self, xs: Iterable[float], ys: Iterable[float]) -> list[Point]:
        """Places of a line's values."""
        return [self.at(x, y) for x, y in zip(xs, ys, strict=True)]


def draw_axes(
    canvas: Canvas, plot: Plot, y_ticks: Sequence[tuple[float, str]], x_ticks: Sequence[tuple[float, str]]
) -> None:
    """Horizontal grid with labels, and a base line with labels below."""
    box = plot.box
    for value, label in y_ticks:
        y = plot.up(value)
        canvas.line((box.left, y), (box.right, y), GRID)
        canvas.text((box.left - 3, y + TEXT_SIZE * 0.35), label, anchor="end", colour=SOFT_INK)
    canvas.line((box.left, box.bottom), (box.right, box.bottom), LINE, 0.8)
    for value, label in x_ticks:
        x = plot.across(value)
        canvas.line((x, box.bottom), (x, box.bottom + 2), LINE, 0.8)
        canvas.text((x, box.bottom + TEXT_SIZE + 2.5), label, anchor="middle", colour=SOFT_INK)
