"""One measure over the visits: baseline +- MDC, reference, treatments; a triangle stands only for a real change."""

from collections.abc import Sequence
from dataclasses import dataclass

from schemas.vocabulary import Side
from services.report.charts.axes import Plot, digits_of, draw_axes, ticks
from services.report.charts.canvas import SIDE_DASHES, TEXT_SIZE, Box, Canvas, Point
from services.report.charts.colours import CHANGE_BAND, INK, LINE, REFERENCE, SIDE, SOFT_INK, WHITE, WHOLE
from services.report.charts.labels import Label, apart

WIDTH, HEIGHT = 136.0, 106.0
LEFT, TOP, RIGHT, BOTTOM = 24.0, 20.0, 12.0, 14.0
MOST_NUMBERS = 10
"""Visits that have room for their numbers; of more, every second or third has its own."""
MARK = 3.2
"""Half the size of a mark."""


@dataclass(frozen=True, slots=True)
class VisitMark:
    """One visit in shown units. `real` +1 or -1: real change up or down; 0: none, or cannot tell."""

    number: int
    value: float
    low: float | None
    high: float | None
    baseline: bool
    real: int


@dataclass(frozen=True, slots=True)
class ProgressLine:
    """One side's visits, in order, with the band of its own baseline."""

    side: Side | None
    marks: Sequence[VisitMark]
    baseline: float | None
    mdc: float | None


@dataclass(frozen=True, slots=True)
class TreatmentMark:
    """Something done between visits: its place in visit numbers, and its letter."""

    at: float
    letter: str


@dataclass(frozen=True, slots=True)
class ProgressLabels:
    """Words of the chart in the report's language."""

    title: str
    description: str
    y_axis: str
    x_axis: str
    letters: dict[Side, str]
    decimal_mark: str


def progress_chart(
    name: str, lines: Sequence[ProgressLine], reference: tuple[float, float] | None,
    treatments: Sequence[TreatmentMark], labels: ProgressLabels,
) -> str:  # fmt: skip
    """The chart as SVG. `name` is its id on the page."""
    canvas = Canvas(WIDTH, HEIGHT)
    numbers = sorted({mark.number for line in lines for mark in line.marks})
    y_ticks = _y_ticks(lines, reference)
    across = (numbers[0] - 0.4, max(numbers[-1], numbers[0] + 1) + 0.4)
    plot = Plot(Box(LEFT, TOP, WIDTH - RIGHT, HEIGHT - BOTTOM), across, (y_ticks[0], y_ticks[-1]))
    _bands(canvas, plot, lines, reference)
    digits = digits_of(y_ticks[1] - y_ticks[0])
    texts = [f"{value:.{digits}f}".replace("-", "\u2212").replace(".", labels.decimal_mark) for value in y_ticks]
    draw_axes(canvas, plot, list(zip(y_ticks, texts, strict=True)), _visit_ticks(numbers))
    for treatment in treatments:
        x = plot.across(min(max(treatment.at, across[0]), across[1]))
        canvas.line((x, TOP), (x, plot.box.bottom), LINE, 0.9, "3 2")
        canvas.text((x, TOP - 2), treatment.letter, anchor="middle", colour=SOFT_INK, bold=True, size=7)
    for line in lines:
        _line(canvas, plot, line)
    ends = [
        Label(plot.up(line.marks[-1].value), labels.letters[line.side], SIDE[line.side]) for line in lines if line.side
    ]
    for label in apart(ends, TEXT_SIZE):
        canvas.text((plot.box.right + 3, label.at + TEXT_SIZE * 0.35), label.text, colour=label.colour, bold=True)
    canvas.text((0, 7.5), labels.y_axis, colour=SOFT_INK)
    canvas.text((0, HEIGHT - 3.5), labels.x_axis, colour=SOFT_INK)
    return canvas.svg(name, labels.title, labels.description)


def _visit_ticks(numbers: Sequence[int]) -> list[tuple[float, str]]:
    every = -(-len(numbers) // MOST_NUMBERS)
    return [(number, str(number)) for number in numbers[::every]]


def _y_ticks(lines: Sequence[ProgressLine], reference: tuple[float, float] | None) -> list[float]:
    values = [
        value
        for line in lines
        for mark in line.marks
        for value in (mark.value, mark.low, mark.high)
        if value is not None
    ]
    for line in lines:
        if line.baseline is not None and line.mdc is not None:
            values += [line.baseline - line.mdc, line.baseline + line.mdc]
    if reference is not None:
        values += reference
    low, high = min(values), max(values)
    lack = max(0.0, 0.05 * abs(high) - (high - low)) / 2 or (0.5 if high == low else 0.0)
    return ticks(low - lack, high + lack, 4)


def _bands(canvas: Canvas, plot: Plot, lines: Sequence[ProgressLine], reference: tuple[float, float] | None) -> None:
    box = plot.box
    if reference is not None:
        canvas.rectangle(
            Box(box.left, plot.up(reference[1]), box.right, plot.up(reference[0])), REFERENCE, opacity=0.55
        )
    for line in lines:
        if line.baseline is None:
            continue
        colour = WHOLE if line.side is None else SIDE[line.side]
        if line.mdc is not None:
            edges = Box(box.left, plot.up(line.baseline + line.mdc), box.right, plot.up(line.baseline - line.mdc))
            if len(lines) == 1:
                canvas.rectangle(edges, CHANGE_BAND, opacity=0.8)
            for y in (edges.top, edges.bottom):
                canvas.line((box.left, y), (box.right, y), colour, 0.5)
        y = plot.up(line.baseline)
        canvas.line((box.left, y), (box.right, y), colour, 0.7, "4 2")


def _line(canvas: Canvas, plot: Plot, line: ProgressLine) -> None:
    colour = WHOLE if line.side is None else SIDE[line.side]
    points = [plot.at(mark.number, mark.value) for mark in line.marks]
    dash = None if line.side is None else SIDE_DASHES[line.side]
    if len(points) > 1:
        canvas.path(points, colour, 1.1, dash)
    for mark, point in zip(line.marks, points, strict=True):
        if mark.low is not None and mark.high is not None:
            canvas.line((point[0], plot.up(mark.low)), (point[0], plot.up(mark.high)), colour, 0.8)
        _mark(canvas, point, mark, colour)


def _mark(canvas: Canvas, at: Point, mark: VisitMark, colour: str) -> None:
    x, y = at
    if mark.real:
        tip = y - mark.real * (MARK + 1)
        base = y + mark.real * MARK
        canvas.area([(x, tip), (x + MARK + 0.6, base), (x - MARK - 0.6, base)], INK)
    elif mark.baseline:
        canvas.rectangle(Box(x - MARK + 0.6, y - MARK + 0.6, x + MARK - 0.6, y + MARK - 0.6), WHITE, colour)
    else:
        canvas.circle(at, MARK - 0.8, colour, colour)
