"""A small drawing surface: SVG elements with attributes only, so that no style sheet and no script is needed."""

from collections.abc import Sequence
from html import escape
from typing import NamedTuple

from services.report.charts.colours import INK

FONT = "Source Sans Pro, Segoe UI, system-ui, Helvetica, Arial, DejaVu Sans, sans-serif"
TEXT_SIZE = 8.0
"""Units of a drawing; charts are drawn so large that this is 6.5 points or more on paper."""
SIDE_DASHES = {"left": None, "right": "5 2.5"}

Point = tuple[float, float]


class Box(NamedTuple):
    """A rectangle of the drawing."""

    left: float
    top: float
    right: float
    bottom: float


class Canvas:
    """Collects elements and gives one SVG with title and description."""

    def __init__(self, width: float, height: float) -> None:
        self.width, self.height = width, height
        self._elements: list[str] = []

    def line(self, start: Point, end: Point, colour: str, width: float = 0.6, dash: str | None = None) -> None:
        """A straight line."""
        (x1, y1), (x2, y2) = start, end
        self._add("line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=colour, stroke_width=width, stroke_dasharray=dash)

    def path(self, points: Sequence[Point], colour: str, width: float = 1.3, dash: str | None = None) -> None:
        """An open polyline."""
        self._add(
            "path", d=_along(points), fill="none", stroke=colour, stroke_width=width, stroke_dasharray=dash,
            stroke_linejoin="round",
        )  # fmt: skip

    def area(self, points: Sequence[Point], colour: str, opacity: float = 1.0) -> None:
        """A filled outline."""
        self._add("path", d=_along(points) + "Z", fill=colour, fill_opacity=None if opacity == 1.0 else opacity)

    def rectangle(self, box: Box, fill: str, stroke: str | None = None, opacity: float = 1.0) -> None:
        """A rectangle."""
        self._add(
            "rect", x=box.left, y=box.top, width=box.right - box.left, height=box.bottom - box.top, fill=fill,
            fill_opacity=None if opacity == 1.0 else opacity, stroke=stroke,
            stroke_width=None if stroke is None else 0.7,
        )  # fmt: skip

    def circle(self, centre: Point, radius: float, fill: str, stroke: str) -> None:
        """A circle."""
        self._add("circle", cx=centre[0], cy=centre[1], r=radius, fill=fill, stroke=stroke, stroke_width=1.0)

    def text(
        self, at: Point, content: str, *, anchor: str = "start", colour: str = INK, bold: bool = False,
        size: float = TEXT_SIZE,
    ) -> None:  # fmt: skip
        """Text with its baseline at a point; anchor start, middle or end."""
        weight = ' font-weight="600"' if bold else ""
        placed = "" if anchor == "start" else f' text-anchor="{anchor}"'
        self._elements.append(
            f'<text x="{_short(at[0])}" y="{_short(at[1])}" font-size="{_short(size)}" fill="{colour}"{placed}{weight}>'
            f"{escape(content)}</text>"
        )

    def svg(self, name: str, title: str, description: str) -> str:
        """The whole drawing. `name` is unique on the page, so that title and description can be referred to."""
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_short(self.width)} {_short(self.height)}" '
            f'font-family="{FONT}" role="img" aria-labelledby="{name}-title {name}-desc">'
        )
        labels = f'<title id="{name}-title">{escape(title)}</title><desc id="{name}-desc">{escape(description)}</desc>'
        return f"{head}{labels}{''.join(self._elements)}</svg>"

    def _add(self, element: str, **attributes: float | str | None) -> None:
        parts = [
            f'{name.replace("_", "-")}="{value if isinstance(value, str) else _short(value)}"'
            for name, value in attributes.items()
            if value is not None
        ]
        self._elements.append(f"<{element} {' '.join(parts)}/>")


def _along(points: Sequence[Point]) -> str:
    return "M" + "L".join(f"{_short(x)} {_short(y)}" for x, y in points)


def _short(value: float) -> str:
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text
