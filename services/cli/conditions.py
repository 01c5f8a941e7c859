"""How a test was done, as it is written on a command line: `aid=cane&paretic=left&zone=2-8`, or in a file."""

import tomllib
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import parse_qsl

import typer
from pydantic import ValidationError

from schemas.conditions import Conditions

SHORT = {"paretic": "paretic_side", "instruction": "speed_instruction", "duration": "test_duration_s"}
"""Names that are shorter here than in schemas/conditions.py; those hold as well."""
ZONE = "zone"
"""Both ends of the timed zone, m from the start: `zone=2-8`."""

Conditioned = Annotated[
    str | None,
    typer.Option(
        "--conditions",
        metavar="TEXT|FILE",
        help="how the test was done, e.g. aid=cane&paretic=left&zone=2-8&instruction=comfortable&duration=360;"
        " or a TOML file with such lines, e.g. aid = 'cane'",
        show_default=False,
    ),
]


def read_conditions(text: str | None) -> Conditions | None:
    """None where nothing was said. Raises ValueError that says what can be."""
    if text is None:
        return None
    said = _from_file(Path(text)) if "=" not in text else _from_text(text)
    known = sorted({*Conditions.model_fields, *SHORT, ZONE})
    unknown = [name for name in said if name not in known]
    if unknown:
        raise ValueError(f"--conditions: {', '.join(map(repr, unknown))} is unknown; there are {', '.join(known)}")
    try:
        return Conditions.model_validate(_spelled_out(said))
    except ValidationError as error:
        wrong = [f"{'.'.join(map(str, each['loc']))}: {each['msg']}" for each in error.errors()]
        raise ValueError(f"--conditions: {'; '.join(wrong)}") from None


def _from_text(text: str) -> dict[str, Any]:
    try:
        return dict(parse_qsl(text, keep_blank_values=True, strict_parsing=True))
    except ValueError:
        raise ValueError(f"--conditions: {text[:80]!r} is no list; write aid=cane&zone=2-8") from None


def _from_file(path: Path) -> dict[str, Any]:
    """A file of such lines, or a recording.toml with a table of them."""
    try:
        told = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"--conditions: {path} cannot be read: {error.strerror}; or write aid=cane") from None
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"--conditions: {path} is not TOML: {error}") from None
    table: dict[str, Any] = told.get("conditions", told)
    return table


def _spelled_out(said: dict[str, Any]) -> dict[str, Any]:
    found = {SHORT.get(name, name): value for name, value in said.items() if name != ZONE}
    if ZONE in said:
        ends = str(said[ZONE]).split("-")
        if len(ends) != 2:
            raise ValueError(f"--conditions: zone={said[ZONE]!r}: write zone=2-8, m from the start")
        found |= {"timed_from_m": ends[0], "timed_to_m": ends[1]}
    return found
