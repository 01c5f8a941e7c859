"""Words and numbers of one language. Every sentence of a report is a row of a TOML file in `wording/`."""

import tomllib
from datetime import date
from functools import cache
from importlib.resources import files
from typing import Any

from services.definitions.definition import CV_SUFFIX, PARETIC_RATIO_SUFFIX, RATIO_SUFFIX, SD_SUFFIX
from services.report.content import Language

SUFFIXES = {PARETIC_RATIO_SUFFIX: "ratio", RATIO_SUFFIX: "ratio", SD_SUFFIX: "sd", CV_SUFFIX: "cv"}
"""Metrics of metrics: what their names end with, and the message that names them."""
NO_BREAK = "\u00a0"
MINUS = "\u2212"
NOT_KNOWN = "\u2013"


class MissingWord(KeyError):
    """A key that the catalogue does not have; a bug, since tests compare the catalogues."""


class Catalogue:
    """The messages of one language by dotted key, e.g. `metric.walking_speed`."""

    def __init__(self, language: Language, messages: dict[str, str]) -> None:
        self.language = language
        self.messages = messages

    def has(self, key: str) -> bool:
        """Whether there is such a message."""
        return key in self.messages

    def text(self, key: str, **values: object) -> str:
        """The message with its placeholders filled. Raises MissingWord for an unknown key."""
        if key not in self.messages:
            raise MissingWord(f"{key} ({self.language})")
        return self.messages[key].format(**values) if values else self.messages[key]

    def one_or_more(self, key: str, count: int, **values: object) -> str:
        """`key.one` or `key.more`, with `{count}`; French counts nothing as one, English as more."""
        single = count == 1 or (count == 0 and self.language is Language.FRENCH)
        return self.text(f"{key}.{'one' if single else 'more'}", count=count, **values)

    def metric(self, name: str) -> str:
        """Name of a metric; one that is in no catalogue is shown as it is called, with blanks."""
        if f"metric.{name}" in self.messages:
            return self.messages[f"metric.{name}"]
        for suffix, key in SUFFIXES.items():
            if name.endswith(suffix):
                return self.text(f"metric_of.{key}", name=self.metric(name.removesuffix(suffix)))
        return name.replace("_", " ")

    def number(self, value: float | None, digits: int, *, signed: bool = False) -> str:
        """A number with the language's decimal mark, a true minus sign and no negative zero."""
        if value is None:
            return NOT_KNOWN
        text = f"{value:+.{digits}f}" if signed else f"{value:.{digits}f}"
        if float(text) == 0.0:
            text = text.lstrip("+-")
        return text.replace("-", MINUS).replace(".", self.messages["format.decimal_mark"])

    def day(self, on: date) -> str:
        """A date in words."""
        return self.text("format.date", day=on.day, month=self.text(f"month.{on.month}"), year=on.year)

    def listed(self, parts: list[str]) -> str:
        """`a, b and c`."""
        if len(parts) < 2:
            return "".join(parts)
        return f"{', '.join(parts[:-1])}{self.messages['format.last_of_list']}{parts[-1]}"


@cache
def catalogue(language: Language) -> Catalogue:
    """The catalogue of a language, read once."""
    content = files("services.report.wording").joinpath(f"{language}.toml").read_text(encoding="utf-8")
    return Catalogue(language, {key: _unbroken(text) for key, text in _flat(tomllib.loads(content))})


def _unbroken(text: str) -> str:
    """A mark that has a space before it stays on the line of its word."""
    for mark in (":", ";", "%", "±", "»"):
        text = text.replace(f" {mark}", f"{NO_BREAK}{mark}")
    return text.replace("« ", f"«{NO_BREAK}")


def _flat(table: dict[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    rows: list[tuple[str, str]] = []
    for name, value in table.items():
        key = f"{prefix}{name}"
        rows.extend(_flat(value, f"{key}.") if isinstance(value, dict) else [(key, value)])
    return rows
