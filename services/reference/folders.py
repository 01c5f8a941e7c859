"""Reading of reference sets: the only module here that opens files."""

import csv
import os
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from services.reference.curve_table import curves_of
from services.reference.errors import ReferenceSetError
from services.reference.sets import Manifest, ReferenceCurve, ReferenceSet
from services.reference.table import strata_of

SHIPPED = Path(__file__).parent / "shipped"
"""Sets that come with the software."""

LARGEST_FILE = 2**20
"""Bytes; a table or curves of this size is no summary of people any more."""


@dataclass(frozen=True, slots=True)
class Shelf:
    """All sets that could be read, the clinic's own first, and what was refused."""

    sets: tuple[ReferenceSet, ...]
    refused: tuple[ReferenceSetError, ...]

    def named(self, name: str) -> ReferenceSet | None:
        """One set."""
        return next((each for each in self.sets if each.manifest.name == name), None)


def read_shelf(own: Iterable[Path]) -> Shelf:
    """The clinic's own sets, folder by folder in this order, then the shipped ones.

    A path is a set itself or holds sets. What is no set is refused with its reason, so that one bad file takes nothing
    else away; so is a second set of the same name.
    """
    sets: dict[str, ReferenceSet] = {}
    refused: list[ReferenceSetError] = []
    for folder, is_own in [*((each, True) for path in own for each in _folders(path)), *_shipped()]:
        try:
            found = read_set(folder, own=is_own)
            if found.manifest.name in sets:
                raise ReferenceSetError(folder.name, "manifest.toml", "another set has this name; give it its own")
            sets[found.manifest.name] = found
        except ReferenceSetError as error:
            refused.append(error)
    return Shelf(tuple(sets.values()), tuple(refused))


def own_folders(variable: str) -> list[Path]:
    """Paths of a list as the operating system writes it (`:` between them, `;` on Windows)."""
    return [Path(part) for part in variable.split(os.pathsep) if part]


def read_set(folder: Path, own: bool) -> ReferenceSet:
    """One folder. Raises ReferenceSetError."""
    manifest = _manifest(folder)
    strata = strata_of(folder.name, _rows(folder, "table.csv"), manifest)
    curves: dict[str, ReferenceCurve] = {}
    if (folder / "curves.csv").exists():
        if manifest.datum is None:
            raise ReferenceSetError(
                folder.name, "manifest.toml", "curves need a datum: say what an angle of zero means"
            )
        curves = curves_of(folder.name, _rows(folder, "curves.csv"))
    return ReferenceSet(manifest, strata, curves, own)


def _shipped() -> Iterator[tuple[Path, bool]]:
    return ((folder, False) for folder in _folders(SHIPPED))


def _folders(path: Path) -> list[Path]:
    if (path / "manifest.toml").exists() or not path.is_dir():
        return [path]
    return sorted(each for each in path.iterdir() if each.is_dir() and not each.name.startswith((".", "__")))


def _manifest(folder: Path) -> Manifest:
    try:
        manifest = Manifest.model_validate(tomllib.loads(_text(folder, "manifest.toml")))
    except tomllib.TOMLDecodeError as error:
        raise ReferenceSetError(folder.name, "manifest.toml", str(error)) from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        raise ReferenceSetError(folder.name, f"manifest.toml: {where}", first["msg"]) from error
    if manifest.name != folder.name:
        raise ReferenceSetError(folder.name, "manifest.toml: name", f"is {manifest.name}; name it as the folder")
    return manifest


def _rows(folder: Path, name: str) -> list[dict[str, str]]:
    lines = _text(folder, name).splitlines()
    rows = list(csv.DictReader(lines, strict=True, restkey="", restval=""))
    if not rows:
        raise ReferenceSetError(folder.name, name, "has no rows")
    return rows


def _text(folder: Path, name: str) -> str:
    path = folder / name
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ReferenceSetError(folder.name, name, f"is larger than {LARGEST_FILE} bytes")
        return path.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise ReferenceSetError(folder.name, name, "is missing; a set has manifest.toml and table.csv") from error
    except (OSError, UnicodeDecodeError) as error:
        raise ReferenceSetError(folder.name, name, f"cannot be read: {error}") from error
