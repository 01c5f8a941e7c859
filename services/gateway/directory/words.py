"""Finding a person however the name is written."""

import unicodedata
from collections.abc import Callable

from services.gateway.directory.cipher import Name

_SINGLE = str.maketrans({"ø": "o", "đ": "d", "ł": "l", "æ": "ae", "œ": "oe", "ı": "i", "ð": "d", "þ": "th"})
"""Letters that Unicode does not take apart."""


def folded(text: str) -> str:
    """Without case and accents: Müller, MULLER and müller are one."""
    apart = unicodedata.normalize("NFKD", text.casefold())
    return "".join(letter for letter in apart if not unicodedata.combining(letter)).translate(_SINGLE)


def matching(text: str) -> Callable[[Name], bool]:
    """Whether every word that was asked for is in the name or the record number, in any order."""
    wanted = folded(text).split()

    def matches(name: Name) -> bool:
        found = folded(f"{name.name} {name.record_number or ''}")
        return bool(wanted) and all(word in found for word in wanted)

    return matches
