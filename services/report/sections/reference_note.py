"""Whose a reference is, in words: number of people, age, sex, source."""

import math
from collections.abc import Iterable

from schemas.population import Sex
from services.report.catalogue import Catalogue
from services.report.source import ReferenceCurve, ReferenceOrigin, ReferenceRange

SEXES = {Sex.FEMALE: "women", Sex.MALE: "men", None: "both_sexes"}


def age_text(words: Catalogue, origin: ReferenceOrigin) -> str:
    """`60-74 y`; what is open is said so."""
    low, high = (None if age is None else str(math.floor(age)) for age in (origin.age_from, origin.age_to))
    if low is not None and high is not None:
        return words.text("reference.ages", low=low, high=high)
    if low is not None:
        return words.text("reference.age_from", low=low)
    return words.text("reference.any_age") if high is None else words.text("reference.age_to", high=high)


def short_origin(words: Catalogue, origin: ReferenceOrigin) -> str:
    """Number, age, sex and source."""
    sex = words.text(f"reference.{SEXES[origin.sex]}")
    n = words.text("reference.n_unsaid") if origin.n is None else f"n = {origin.n}"
    return words.text("reference.who", n=n, age=age_text(words, origin), sex=sex, source=origin.source)


def kind_text(words: Catalogue, reference: ReferenceRange | ReferenceCurve) -> str:
    """What the ends of the range are."""
    return words.text(f"reference.kind_{reference.kind}")


def reference_notes(words: Catalogue, references: Iterable[ReferenceRange]) -> list[str]:
    """One note for each origin and kind of range that is shown, with the metrics it is of."""
    names: dict[tuple[ReferenceOrigin, str], list[str]] = {}
    for reference in references:
        measured = names.setdefault((reference.origin, kind_text(words, reference)), [])
        name = words.metric(reference.metric)
        if name not in measured:
            measured.append(name)
    return [
        words.text(
            "reference.band",
            names=", ".join(metrics),
            kind=kind,
            who=short_origin(words, origin),
            set=set_text(words, origin),
        )
        for (origin, kind), metrics in names.items()
    ]


def set_text(words: Catalogue, origin: ReferenceOrigin) -> str:
    """Name and version."""
    return words.text("reference.set", name=origin.name, version=origin.version)
