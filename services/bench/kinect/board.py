"""`ambula bench kinect`: simulated tasks, recordings and cost, or one of them."""

from collections.abc import Callable
from pathlib import Path

from rich.progress import Progress

from services.bench.kinect import cost_section, recorded_section, simulated_section, walking_section
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import MissingFile

Section = Callable[[Callable[[], None]], list[Row]]


def _quietly(rows: Callable[[], list[Row]]) -> Section:
    def run(advance: Callable[[], None]) -> list[Row]:
        found = rows()
        advance()
        return found

    return run


SECTIONS: dict[str, tuple[Section, int, str]] = {
    "clinic": (simulated_section.clinic_rows, simulated_section.METHODS, simulated_section.NOTE),
    "paper": (simulated_section.paper_rows, 2, ""),
    "ours": (simulated_section.our_rows, 1, ""),
    "kimore": (_quietly(recorded_section.kimore_rows), 1, recorded_section.NOTE),
    "keraal": (_quietly(recorded_section.keraal_rows), 1, ""),
    "walking": (walking_section.walking_rows, walking_section.STEPS, walking_section.NOTE),
    "cost": (_quietly(cost_section.cost_rows), 1, cost_section.NOTE),
}
"""Section -> what it measures, how many methods it runs, what is to be said about it."""

WHOLE = ("clinic", "paper", "kimore", "keraal", "walking", "cost")
"""What runs without a word; `ours` is the part of `clinic` that takes half a minute."""


def run(json_path: Path | None = None, subject: str | None = None) -> Scoreboard:
    """Score one of SECTIONS, or all.

    Raises:
        ValueError: the section is not known.
        MissingFile: the data of the one section asked for are not there; asked for all, its rows say so.
    """
    if subject is not None and subject not in SECTIONS:
        raise ValueError(f"kinect is measured on {', '.join(SECTIONS)}, not on {subject!r}")
    names = WHOLE if subject is None else (subject,)
    rows: list[Row] = []
    with Progress(transient=True) as progress:
        bar = progress.add_task("methods", total=sum(SECTIONS[name][1] for name in names))
        for name in names:
            rows += _rows(name, lambda: progress.advance(bar), skip=subject is None)
    note = "\n".join(SECTIONS[name][2] for name in names if SECTIONS[name][2])
    board = Scoreboard(f"kinect: {subject}" if subject else "kinect", rows, note)
    if json_path is not None:
        board.write_json(json_path)
    return board


def _rows(name: str, advance: Callable[[], None], *, skip: bool) -> list[Row]:
    try:
        return SECTIONS[name][0](advance)
    except MissingFile as error:
        if not skip:
            raise
        return [Row(name, None, "", str(error), None, None)]
