"""A plain chart of lines and dots as SVG text."""

from collections.abc import Callable, Collection, Mapping, Sequence
from html import escape
from itertools import groupby
from math import floor, isfinite, log10

WIDTH, HEIGHT = 720, 400
LEFT, RIGHT, TOP, BOTTOM = 72, 200, 44, 56
COLOURS = ("#4d4d4d", "#c0392b", "#1f6fb2", "#2e8b57", "#8e5ea2", "#d98c1f")
FEW = 25
"""Points of a line up to which each is marked."""
LEVEL_COLOUR, DASHES = "#777777", ("7 4", "2 3")

Points = Sequence[tuple[float, float]]


def line_chart(
    title: str,
    x_label: str,
    y_label: str,
    lines: Mapping[str, Points],
    *,
    log_x: bool = False,
    from_zero: bool = True,
    levels: Mapping[str, float] | None = None,
    colours: Mapping[str, str] | None = None,
    dots: Collection[str] = (),
    dashed: Collection[str] = (),
) -> str:
    """An SVG document with one line per entry of `lines`, the first on top.

    Args:
        title: above the chart.
        x_label: below it, with unit.
        y_label: beside it, with unit.
        lines: points (x, y) by name; the names make the legend. Where y is not finite, the line is interrupted.
        log_x: decades on the x axis; x > 0 then.
        from_zero: whether the y axis begins at zero.
        levels: y of dashed levels across the chart, by name.
        colours: of lines by name; the others take their turn in COLOURS.
        dots: names whose points are not joined.
        dashed: names of dashed lines.

    Raises:
        ValueError: there is nothing to draw.
    """
    points = [(log10(x) if log_x else x, y) for line in lines.values() for x, y in line if isfinite(y)]
    if not points:
        raise ValueError("a chart needs at least one point")
    levels, colours = levels or {}, colours or {}
    heights = [*(y for _, y in points), *([0.0] if from_zero else []), *levels.values()]
    x_ticks, y_ticks = _ticks([x for x, _ in points], whole=log_x), _ticks(heights)
    place = _placing(x_ticks, y_ticks)
    parts = [_text(LEFT, TOP - 20, title, size=15), *_grid(place, x_ticks, y_ticks, log_x=log_x)]
    for i, (name, height) in enumerate(levels.items()):
        y = place(x_ticks[0], height)[1]
        parts.append(_polyline([(LEFT, y), (WIDTH - RIGHT, y)], LEVEL_COLOUR, DASHES[i % len(DASHES)]))
        parts += _legend(LEVEL_COLOUR, name, len(lines) + i, DASHES[i % len(DASHES)])
    for i, (name, line) in reversed(list(enumerate(lines.items()))):
        drawn = [place(log10(x) if log_x else x, y) if isfinite(y) else None for x, y in line]
        colour = colours.get(name, COLOURS[i % len(COLOURS)])
        dashes = DASHES[0] if name in dashed else ""
        parts += _dots(drawn, colour) if name in dots else _line(drawn, colour, dashes)
        parts += _spot(colour, name, i) if name in dots else _legend(colour, name, i, dashes)
    parts += _labels(x_label, y_label)
    size = f'width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif">'
    return "\n".join([head, f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', *parts, "</svg>", ""])


def _placing(x_ticks: Sequence[float], y_ticks: Sequence[float]) -> Callable[[float, float], tuple[float, float]]:
    """From values to places on the sheet."""
    width, height = WIDTH - LEFT - RIGHT, HEIGHT - TOP - BOTTOM

    def place(x: float, y: float) -> tuple[float, float]:
        across = (x - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        up = (y - y_ticks[0]) / (y_ticks[-1] - y_ticks[0])
        return LEFT + across * width, HEIGHT - BOTTOM - up * height

    return place


def _grid(
    place: Callable[[float, float], tuple[float, float]], x_ticks: list[float], y_ticks: list[float], *, log_x: bool
) -> list[str]:
    parts = []
    for tick in x_ticks:
        x, y = place(tick, y_ticks[0])
        parts += [_rule(x, y, x, TOP), _power(x, y + 19, tick) if log_x else _text(x, y + 19, f"{tick:g}", "middle")]
    for tick in y_ticks:
        x, y = place(x_ticks[0], tick)
        parts += [_rule(x, y, WIDTH - RIGHT, y), _text(x - 8, y + 4, f"{tick:g}", "end")]
    return parts


def _labels(x_label: str, y_label: str) -> list[str]:
    middle = (TOP + HEIGHT - BOTTOM) / 2
    beside = f'<g transform="rotate(-90 18 {middle:g})">{_text(18, middle, y_label, "middle")}</g>'
    return [_text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, x_label, "middle"), beside]


def _ticks(values: Sequence[float], *, whole: bool = False) -> list[float]:
    """Four to eight round numbers that span the values."""
    low, high = min(values), max(values)
    span = high - low if high > low else 1.0
    step = 10.0 ** floor(log10(span))
    for finer in (0.5, 0.4, 0.5):
        if span / step < 4.0:
            step *= finer
    step = max(step, 1.0) if whole else step
    first = floor(low / step + 1e-9)
    last = first + 1
    while last * step < high - 1e-9 * span:
        last += 1
    return [round(k * step, 12) for k in range(first, last + 1)]


def _line(points: Sequence[tuple[float, float] | None], colour: str, dashes: str) -> list[str]:
    pieces = [[point for point in piece if point] for there, piece in groupby(points, bool) if there]
    parts = [_polyline(piece, colour, dashes) for piece in pieces]
    if 2 < len(points) <= FEW:
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.8" fill="{colour}"/>' for piece in pieces for x, y in piece]
    return parts


def _dots(points: Sequence[tuple[float, float] | None], colour: str) -> list[str]:
    circles = [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.8"/>' for x, y in filter(None, points)]
    return [f'<g fill="{colour}" fill-opacity="0.45">', *circles, "</g>"]


def _polyline(points: Sequence[tuple[float, float]], colour: str, dashes: str = "") -> str:
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    style = f' stroke-dasharray="{dashes}"' if dashes else ""
    return f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.8"{style}/>'


def _legend(colour: str, name: str, place: int, dashes: str = "") -> list[str]:
    x, y = WIDTH - RIGHT + 14, TOP + 8 + 20 * place
    style = f'stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes or "none"}"'
    return [_rule(x, y, x + 20, y, style), _text(x + 27, y + 4, name)]


def _spot(colour: str, name: str, place: int) -> list[str]:
    x, y = WIDTH - RIGHT + 14, TOP + 8 + 20 * place
    return [f'<circle cx="{x + 10:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>', _text(x + 27, y + 4, name)]


def _rule(x1: float, y1: float, x2: float, y2: float, style: str = 'stroke="#dddddd"') -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {style}/>'


def _power(x: float, y: float, exponent: float) -> str:
    raised = f'<tspan dy="-5" font-size="9">{exponent:g}</tspan>'
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="12" text-anchor="middle">10{raised}</text>'


def _text(x: float, y: float, text: str, anchor: str = "start", *, size: int = 12) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}">{escape(text)}</text>'
