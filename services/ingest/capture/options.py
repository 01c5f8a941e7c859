"""What stands behind `device:kinect?`."""

import dataclasses
import math
from dataclasses import dataclass
from typing import Self
from urllib.parse import parse_qsl

from services.ingest.capture.settings import DEFAULT_PORT
from services.ingest.errors import InvalidOption

_RANGES = {"port": (1.0, 65535.0), "height": (0.5, 2.5), "duration": (1.0, 8 * 3600.0)}


@dataclass(frozen=True, slots=True)
class CaptureOptions:
    """Options of a camera."""

    port: int = DEFAULT_PORT
    height: float | None = None
    """m, the person's."""
    duration: float | None = None
    """s after which the session ends by itself; None: when it is stopped."""

    @classmethod
    def parse(cls, query: str) -> Self:
        """From `port=7788&height=1.71`. Raises InvalidOption for an unknown name, a word, or a value out of range."""
        try:
            pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), max_num_fields=16)
        except ValueError as error:
            raise InvalidOption(f"{query[:80]!r} is no list of options; write port=7788&height=1.71") from error
        values: dict[str, float] = {}
        for name, text in pairs:
            if name not in _RANGES:
                raise InvalidOption(f"a camera has no option {name[:40]!r}; it has {', '.join(_RANGES)}")
            values[name] = _number(name, text)
        given = cls(**values)  # type: ignore[arg-type]
        return dataclasses.replace(given, port=int(given.port))


def _number(name: str, text: str) -> float:
    least, most = _RANGES[name]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not least <= value <= most or (name == "port" and value != int(value)):
        raise InvalidOption(f"{name}={text[:40]}: give a number from {least:g} to {most:g}")
    return value
