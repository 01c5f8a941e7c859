"""One joint of one side, every stride as a thin line: how alike the strides are."""

from collections.abc import Sequence

from schemas.vocabulary import Side
from services.report.charts.axes import Plot, digits_of, draw_axes, ticks
from services.report.charts.canvas import Box, Canvas
from services.report.charts.colours import SIDE, SOFT_INK
from services.report.charts.curve_chart import BOTTOM, HEIGHT, LEAST_RANGE_DEG, LEFT, RIGHT, TOP, WIDTH, CurveLabels

EVERY = 2
"""Points of a stride of which one is drawn; thin lines need no more."""
THIN = 0.45


def strides_chart(name: str, side: Side, strides: Sequence[Sequence[float]], labels: CurveLabels) -> str:
    """The chart as SVG; strides in degrees at 0 to 100 %, in equal steps. `name` is its id on the page."""
    canvas = Canvas(WIDTH, HEIGHT)
    low, high = min(map(min, strides)), max(map(max, strides))
    lack = max(0.0, LEAST_RANGE_DEG - (high - low)) / 2
    y_ticks = ticks(low - lack, high + lack)
    plot = Plot(Box(LEFT, TOP, WIDTH - RIGHT, HEIGHT - BOTTOM), (0, 100), (y_ticks[0], y_ticks[-1]))
    digits = digits_of(y_ticks[1] - y_ticks[0])
    texts = [f"{value:.{digits}f}".replace("-", "\u2212").replace(".", labels.decimal_mark) for value in y_ticks]
    draw_axes(
        canvas, plot, list(zip(y_ticks, texts, strict=True)), [(value, str(value)) for value in (0, 25, 50, 75, 100)]
    )
    for stride in strides:
        shares = [100 * number / (len(stride) - 1) for number in range(0, len(stride), EVERY)]
        canvas.path(plot.points(shares, stride[::EVERY]), SIDE[side], THIN)
    canvas.text(((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 2.5), labels.x_axis, anchor="middle", colour=SOFT_INK)
    canvas.text((0, 7.5), labels.y_axis, colour=SOFT_INK)
    canvas.text((WIDTH - RIGHT, 7.5), labels.letters[side], anchor="end", colour=SIDE[side], bold=True)
    return canvas.svg(name, labels.title, labels.description)
