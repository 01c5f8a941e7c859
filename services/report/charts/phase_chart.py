"""Phases of a timed test as bars on one line of time, one line for each attempt."""

from collections.abc import Sequence
from dataclasses import dataclass

from services.report.charts.canvas import TEXT_SIZE, Box, Canvas
from services.report.charts.colours import INK, LINE, SOFT_INK

WIDTH, ROW, HEAD = 600.0, 34.0, 46.0
LETTER_WIDTH = 0.5
"""Width of a letter in text sizes, about; decides whether a name fits into its bar."""
GROUNDS = {
    "sit_to_stand": "#D5E3F3", "walk_out": "#DDEEDF", "turn": "#FBEBC8", "walk_back": "#DDEEDF",
    "turn_to_sit": "#E6DDF0", "walk": "#DDEEDF", "rest": "#E3E6E8", "run_up": "#F1F4F6", "timed_zone": "#DDEEDF",
    "run_out": "#F1F4F6",
}  # fmt: skip
"""Under ink; every part that is wide enough also bears its name."""


@dataclass(frozen=True, slots=True)
class PhasePart:
    """One phase: what it is, its name in words, when it began and how long it took in s, and that as text."""

    kind: str
    name: str
    start_s: float
    length_s: float
    text: str


def phase_chart(name: str, title: str, description: str, rows: Sequence[tuple[str, Sequence[PhasePart]]]) -> str:
    """The chart as SVG. Every row begins at its own first phase, all rows share one scale."""
    canvas = Canvas(WIDTH, ROW * len(rows) + 2)
    longest = max(parts[-1].start_s + parts[-1].length_s - parts[0].start_s for _, parts in rows)
    scale = (WIDTH - HEAD - 2) / max(longest, 1e-9)
    for index, (head, parts) in enumerate(rows):
        top = 1 + index * ROW
        if len(rows) > 1:
            canvas.text((0, top + 14), head, colour=SOFT_INK)
        for part in parts:
            left = HEAD + (part.start_s - parts[0].start_s) * scale
            _part(canvas, part, Box(left, top, left + part.length_s * scale, top + 20))
    return canvas.svg(name, title, description)


def _part(canvas: Canvas, part: PhasePart, box: Box) -> None:
    canvas.rectangle(box, GROUNDS.get(part.kind, "#F1F4F6"), LINE)
    room, middle = box.right - box.left, (box.left + box.right) / 2
    if room >= len(part.name) * TEXT_SIZE * LETTER_WIDTH + 4:
        canvas.text((middle, box.top + 13), part.name, anchor="middle", colour=INK)
    if room >= len(part.text) * TEXT_SIZE * LETTER_WIDTH + 2:
        canvas.text((middle, box.bottom + 9), part.text, anchor="middle", colour=SOFT_INK)
