"""Prints a report as tagged PDF, or its pages as pictures, with Typst: no system library, no font of the machine."""

import importlib.util
import json
import os
import shutil
import tempfile
import threading
import weakref
from datetime import UTC, date, datetime, time
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Literal

import typst

from schemas.vocabulary import Side
from services.report.charts import colours
from services.report.content import Report

STANDARDS: list[Literal["ua-1"]] = ["ua-1"]
"""PDF/UA-1: the compiler refuses a document that lacks a tag, a title, a language or a picture's text."""
FONT_PACKAGE = "font_source_sans_pro"
FACES = ("Regular", "It", "Semibold", "Bold")
PALETTE = {
    "ink": colours.INK, "soft": colours.SOFT_INK, "line": colours.LINE, "grid": colours.GRID,
    "head": colours.HEAD_GROUND, "accent": colours.WHOLE, "left": colours.SIDE[Side.LEFT],
    "right": colours.SIDE[Side.RIGHT], "good": colours.GOOD, "fair": colours.FAIR, "poor": colours.POOR,
    "withheld": colours.SOFT_INK,
}  # fmt: skip


class Press:
    """A compiler that is kept, so that fonts and page are read once. May be used from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        # The package has each face twice, as TTF and OTF; which one a folder gives first is up to the file system.
        folder = Path(tempfile.mkdtemp(prefix="ambula-report-"))
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        _link_faces(folder)
        fonts = typst.Fonts(include_system_fonts=False, include_embedded_fonts=False, font_paths=[folder])
        page = folder / "page.typ"
        page.write_bytes(files("services.report").joinpath("page.typ").read_bytes())
        self._compiler = typst.Compiler(page, root=folder, font_paths=fonts)

    def pdf(self, report: Report) -> bytes:
        """Tagged PDF. The same report gives the same bytes: its only time is the day of the session."""
        midnight = datetime.combine(date.fromisoformat(report.made_for), time(), UTC)
        with self._lock:
            made = self._compiler.compile(
                format="pdf",
                sys_inputs=_inputs(report),
                pdf_standards=[*STANDARDS],
                timestamp=int(midnight.timestamp()),
            )
        assert isinstance(made, bytes)
        return made

    def pictures(self, report: Report, pixels_per_inch: float = 110) -> list[bytes]:
        """Every page as PNG."""
        with self._lock:
            made = self._compiler.compile(format="png", sys_inputs=_inputs(report), ppi=pixels_per_inch)
        assert made is not None
        return made if isinstance(made, list) else [made]


@cache
def press() -> Press:
    """The one of this process."""
    return Press()


def _inputs(report: Report) -> dict[str, str]:
    return {"report": report.model_dump_json(), "palette": json.dumps(PALETTE)}


def _link_faces(folder: Path) -> None:
    package = importlib.util.find_spec(FONT_PACKAGE)
    if package is None or package.origin is None:
        raise ModuleNotFoundError("font-source-sans-pro is missing; install Ambula's requirements again")
    for face in FACES:
        name = f"SourceSansPro-{face}.ttf"
        os.symlink(Path(package.origin).parent / "files" / name, folder / name)
