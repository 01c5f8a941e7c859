"""Whether a text is a UCUM unit, as far as units of movement go (ucum.org, case sensitive)."""

import re

PREFIXES = ("", "k", "c", "m", "u", "d")
METRIC_ATOMS = ("m", "g", "s", "rad", "N", "W", "J", "Hz", "Pa")
OTHER_ATOMS = ("deg", "min", "h", "d", "wk", "a", "%", "1", "10*")
ATOMS = frozenset([prefix + atom for atom in METRIC_ATOMS for prefix in PREFIXES] + list(OTHER_ATOMS))

_ANNOTATION = r"\{[!-z|~]+\}"
_COMPONENT = re.compile(rf"(?:(?P<atom>10\*|[A-Za-z%]+|1)(?P<exponent>-?[1-9])?)?(?P<annotation>{_ANNOTATION})?")


def is_ucum(text: str) -> bool:
    """Terms joined by `.` and `/`; each is a known atom, with a prefix and an exponent where it may, or annotated."""
    pieces = re.split(r"[./](?![^{]*\})", text)
    if pieces[0] == "" and text.startswith("/") and len(pieces) > 1:
        pieces = pieces[1:]
    return all(_is_component(piece) for piece in pieces)


def _is_component(text: str) -> bool:
    match = _COMPONENT.fullmatch(text)
    if match is None or not text:
        return False
    return match["atom"] is None or match["atom"] in ATOMS
