"""`ambula bench knee`: one subject or all."""

from collections.abc import Callable
from pathlib import Path

from rich.progress import Progress

from services.bench.knee import grover_board, hinge_board, kam_board, worn_board
from services.bench.scoreboard import Row, Scoreboard
from services.ingest.errors import MissingFile

SUBJECTS: dict[str, tuple[Callable[[], list[Row]], str]] = {
    "weygers": (hinge_board.hinge_rows, hinge_board.NOTE),
    "fan": (worn_board.fan_rows, worn_board.NOTES["fan"]),
    "alborno": (worn_board.alborno_rows, worn_board.NOTES["alborno"]),
    "neura": (worn_board.neura_rows, worn_board.NOTES["neura"]),
    "kam": (kam_board.kam_rows, kam_board.NOTE),
    "grover": (grover_board.grover_rows, grover_board.NOTE),
}


def run(json_path: Path | None = None, subject: str | None = None, *, report: Path | None = None) -> Scoreboard:
    """Score one of SUBJECTS, or all.

    Raises:
        ValueError: the subject is not known.
        MissingFile: the data of the one subject asked for are not there; asked for all, its rows say so.
    """
    if subject is not None and subject not in SUBJECTS:
        raise ValueError(f"knee is measured on {', '.join(SUBJECTS)}, not on {subject!r}")
    rows: list[Row] = []
    with Progress(transient=True) as progress:
        names = [subject] if subject is not None else list(SUBJECTS)
        for name in progress.track(names, description="knees"):
            rows += _rows(name, report, skip=subject is None)
    title = f"knee on {subject}" if subject else "knee"
    board = Scoreboard(title, rows, "\n".join(SUBJECTS[name][1] for name in names))
    if json_path is not None:
        board.write_json(json_path)
    return board


def _rows(name: str, report: Path | None, *, skip: bool) -> list[Row]:
    try:
        return grover_board.grover_rows(report) if name == "grover" else SUBJECTS[name][0]()
    except MissingFile as error:
        if not skip:
            raise
        return [Row(name, None, "", str(error), None, None)]
