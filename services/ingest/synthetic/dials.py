"""A dial of a simulated session: a number with a range and a meaning, and how it is written: `speed=1.1&seed=3`."""

import dataclasses
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self
from urllib.parse import parse_qsl

from services.ingest.errors import InvalidOption


def dial(default: float, low: float, high: float, meaning: str, words: tuple[str, ...] = ()) -> Any:
    """A dataclass field; whole numbers where the default is one. `words` may be written for the numbers 0, 1, ..."""
    if words:
        listed = ", ".join(f"{number} {words[number]}" for number in range(int(low), int(high) + 1))
        meaning = f"{meaning}: {listed}"
    return field(default=default, metadata={"low": low, "high": high, "meaning": meaning, "words": words})


@dataclass(frozen=True)
class Dials:
    """Options of `synthetic:<motion>?...`, one field each."""

    motion: ClassVar[str]

    @classmethod
    def parse(cls, query: str) -> Self:
        """From `speed=1.1&seed=3`. Raises InvalidOption for an unknown name, a word, or a value out of range."""
        try:
            pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), max_num_fields=64)
        except ValueError as error:
            raise InvalidOption(f"{query[:80]!r} is no list of options; write seed=3&duration=60") from error
        dials = {dial.name: dial for dial in dataclasses.fields(cls)}
        values: dict[str, float] = {}
        for name, text in pairs:
            if name not in dials:
                known = ", ".join(dials)
                raise InvalidOption(f"synthetic {cls.motion} has no option {name[:40]!r}; it has {known}")
            values[name] = _number(dials[name], text)
        return cls(**values)


def _number(dial: "dataclasses.Field[Any]", text: str) -> float:
    low, high, words = (dial.metadata[name] for name in ("low", "high", "words"))
    text = str(words.index(text)) if text and text in words else text
    try:
        value: float = int(text) if isinstance(dial.default, int) else float(text)
    except ValueError as error:
        raise InvalidOption(f"{dial.name}={text[:40]!r} is not a number; it is {dial.metadata['meaning']}") from error
    if not low <= value <= high:
        raise InvalidOption(f"{dial.name}={value:g} is outside {low:g} .. {high:g} ({dial.metadata['meaning']})")
    return value
