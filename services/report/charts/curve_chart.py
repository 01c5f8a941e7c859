"""One joint over the stride: mean and spread of both sides, toe-off, and a grey reference where one fits."""

from collections.abc import Sequence
from dataclasses import dataclass

from schemas.vocabulary import Side
from services.report.charts.axes import Plot, digits_of, draw_axes, ticks
from services.report.charts.canvas import SIDE_DASHES, TEXT_SIZE, Box, Canvas
from services.report.charts.colours import REFERENCE, SIDE, WHOLE
from services.report.charts.labels import Label, apart

WIDTH, HEIGHT = 168.0, 174.0
LEFT, TOP, RIGHT, BOTTOM = 24.0, 18.0, 12.0, 24.0
LEAST_RANGE_DEG = 20.0
"""deg: smaller movements are not drawn larger than this, so that noise does not look like motion."""


@dataclass(frozen=True, slots=True)
class SideCurve:
    """Mean and standard deviation in degrees at 0 to 100 %, in equal steps. `toe_off` in %; side None: both."""

    side: Side | None
    mean: Sequence[float]
    spread: Sequence[float]
    toe_off: float | None


@dataclass(frozen=True, slots=True)
class CurveBand:
    """Reference in degrees at 0 to 100 %, in equal steps."""

    low: Sequence[float]
    high: Sequence[float]


@dataclass(frozen=True, slots=True)
class CurveLabels:
    """Words of the chart in the report's language."""

    title: str
    description: str
    x_axis: str
    y_axis: str
    letters: dict[Side, str]
    decimal_mark: str


def curve_chart(name: str, curves: Sequence[SideCurve], band: CurveBand | None, labels: CurveLabels) -> str:
    """The chart as SVG. `name` is its id on the page."""
    canvas = Canvas(WIDTH, HEIGHT)
    y_ticks = _y_ticks(curves, band)
    plot = Plot(Box(LEFT, TOP, WIDTH - RIGHT, HEIGHT - BOTTOM), (0, 100), (y_ticks[0], y_ticks[-1]))
    digits = digits_of(y_ticks[1] - y_ticks[0])
    texts = [f"{value:.{digits}f}".replace("-", "\u2212").replace(".", labels.decimal_mark) for value in y_ticks]
    if band is not None:
        _fill(canvas, plot, band.low, band.high, REFERENCE, 0.75)
    draw_axes(
        canvas, plot, list(zip(y_ticks, texts, strict=True)), [(value, str(value)) for value in (0, 25, 50, 75, 100)]
    )
    if y_ticks[0] < 0 < y_ticks[-1]:
        canvas.line((plot.box.left, plot.up(0)), (plot.box.right, plot.up(0)), "#8A979F", 0.7)
    for curve in curves:
        _draw_side(canvas, plot, curve)
    _letters(canvas, plot, curves, labels)
    canvas.text(((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 2.5), labels.x_axis, anchor="middle", colour="#51626C")
    canvas.text((0, 7.5), labels.y_axis, colour="#51626C")
    return canvas.svg(name, labels.title, labels.description)


def _y_ticks(curves: Sequence[SideCurve], band: CurveBand | None) -> list[float]:
    lows = [m - s for curve in curves for m, s in zip(curve.mean, curve.spread, strict=True)]
    highs = [m + s for curve in curves for m, s in zip(curve.mean, curve.spread, strict=True)]
    if band is not None:
        lows, highs = [*lows, *band.low], [*highs, *band.high]
    low, high = min(lows), max(highs)
    lack = max(0.0, LEAST_RANGE_DEG - (high - low)) / 2
    return ticks(low - lack, high + lack)


def _percent(count: int) -> list[float]:
    return [100 * number / (count - 1) for number in range(count)]


def _fill(canvas: Canvas, plot: Plot, low: Sequence[float], high: Sequence[float], colour: str, opacity: float) -> None:
    upper = plot.points(_percent(len(high)), map(plot.inside, high))
    lower = plot.points(_percent(len(low)), map(plot.inside, low))
    canvas.area([*upper, *reversed(lower)], colour, opacity)


def _draw_side(canvas: Canvas, plot: Plot, curve: SideCurve) -> None:
    colour = WHOLE if curve.side is None else SIDE[curve.side]
    low = [m - s for m, s in zip(curve.mean, curve.spread, strict=True)]
    high = [m + s for m, s in zip(curve.mean, curve.spread, strict=True)]
    _fill(canvas, plot, low, high, colour, 0.16)
    dash = None if curve.side is None else SIDE_DASHES[curve.side]
    canvas.path(plot.points(_percent(len(curve.mean)), curve.mean), colour, 1.5, dash)
    if curve.toe_off is not None:
        x = plot.across(curve.toe_off)
        canvas.line((x, plot.box.top), (x, plot.box.bottom), colour, 1.0, "1 2")


def _letters(canvas: Canvas, plot: Plot, curves: Sequence[SideCurve], labels: CurveLabels) -> None:
    sided = [curve for curve in curves if curve.side is not None]
    ends = [
        Label(plot.up(curve.mean[-1]), labels.letters[curve.side], SIDE[curve.side]) for curve in sided if curve.side
    ]
    for label in apart(ends, TEXT_SIZE):
        canvas.text((plot.box.right + 3, label.at + TEXT_SIZE * 0.35), label.text, colour=label.colour, bold=True)
    tops = [
        Label(plot.across(curve.toe_off), labels.letters[curve.side], SIDE[curve.side])
        for curve in sided
        if curve.side is not None and curve.toe_off is not None
    ]
    for label in apart(tops, TEXT_SIZE * 0.8):
        canvas.text((label.at, plot.box.top - 1.5), label.text, anchor="middle", colour=label.colour, bold=True, size=7)
