"""A plain line chart as SVG text."""

from collections.abc import Mapping, Sequence
from html import escape
from math import floor, log10

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 64, 170, 40, 52
COLOURS = ("#555555", "#c0392b", "#1f6fb2", "#2e8b57", "#8e5ea2", "#d98c1f")

Points = Sequence[tuple[float, float]]


def line_chart(title: str, x_label: str, y_label: str, lines: Mapping[str, Points], *, log_x: bool = False) -> str:
    """An SVG document with one line per entry of `lines`.

    Args:
        title: above the chart.
        x_label: below it, with unit.
        y_label: beside it, with unit.
        lines: points (x, y) by name; the names make the legend.
        log_x: decades on the x axis; x > 0 then.

    Raises:
        ValueError: there is nothing to draw.
    """
    points = [(log10(x) if log_x else x, y) for line in lines.values() for x, y in line]
    if not points:
        raise ValueError("a chart needs at least one point")
    x_ticks, y_ticks = _ticks([x for x, _ in points], whole=log_x), _ticks([0.0, *(y for _, y in points)])

    def place(x: float, y: float) -> tuple[float, float]:
        across = (x - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        up = (y - y_ticks[0]) / (y_ticks[-1] - y_ticks[0])
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - up * (HEIGHT - TOP - BOTTOM)

    parts = [_text(LEFT, TOP - 18, title, size=15)]
    for tick in x_ticks:
        x, y = place(tick, y_ticks[0])
        parts += [_rule(x, y, x, TOP), _text(x, y + 18, f"1e{tick:g}" if log_x else f"{tick:g}", anchor="middle")]
    for tick in y_ticks:
        x, y = place(x_ticks[0], tick)
        parts += [_rule(x, y, WIDTH - RIGHT, y), _text(x - 8, y + 4, f"{tick:g}", anchor="end")]
    for i, (name, line) in enumerate(lines.items()):
        drawn = [place(log10(x) if log_x else x, y) for x, y in line]
        parts += _line(drawn, COLOURS[i % len(COLOURS)], name, TOP + 8 + 20 * i)
    parts.append(_text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, x_label, anchor="middle"))
    parts.append(f'<g transform="rotate(-90 16 {HEIGHT / 2:g})">{_text(16, HEIGHT / 2, y_label, anchor="middle")}</g>')
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">'
    return "\n".join([head, f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>', *parts, "</svg>", ""])


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


def _line(points: Sequence[tuple[float, float]], colour: str, name: str, legend_y: float) -> list[str]:
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    x = WIDTH - RIGHT + 12
    return [
        f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>',
        *(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="2.5" fill="{colour}"/>' for px, py in points),
        f'<line x1="{x}" y1="{legend_y:g}" x2="{x + 18}" y2="{legend_y:g}" stroke="{colour}" stroke-width="2"/>',
        _text(x + 24, legend_y + 4, name),
    ]


def _rule(x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="#dddddd"/>'


def _text(x: float, y: float, text: str, *, anchor: str = "start", size: int = 12) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}">{escape(text)}</text>'
