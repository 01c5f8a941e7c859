"""Our own check of a bundle: what schema libraries leave unchecked is codes, units, references and who could be known.

It knows the profile and not how bundles are made, so that a mistake in the making is found.
"""

import re
import uuid
from collections.abc import Iterable, Iterator
from datetime import datetime
from typing import Any

from services.exports.fhir.attachments import attachment_problems
from services.exports.fhir.codes import ABSENT, METRICS, Json
from services.exports.fhir.profile import CODES, ELEMENTS, POINTS_TO, REQUIRED, STATUSES, SYSTEMS_AT, VALUES
from services.exports.fhir.ucum import is_ucum
from services.exports.fhir.units import UCUM, UNITS

_YEAR = re.compile(r"[12][0-9]{3}")
_INSTANT = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?(Z|[+-]\d\d:\d\d)")
_UCUM_CODES = frozenset(unit.code for unit in UNITS.values())


def problems(bundle: Json, secrets: Iterable[str] = ()) -> list[str]:
    """What is wrong, each with its place; empty when nothing is.

    `secrets` are texts that must occur nowhere: titles, names of sensors, whatever somebody typed.
    """
    found = [f"Bundle: {each}" for each in _bundle(bundle)]
    resources = {entry.get("fullUrl", ""): entry.get("resource", {}) for entry in bundle.get("entry", [])}
    for resource in resources.values():
        place = f"{resource.get('resourceType')}/{resource.get('id')}"
        found += [f"{place}: {each}" for each in _resource(resource, resources)]
    texts = [(place, text) for place, text in _texts(bundle, "Bundle") if not place.endswith(".data")]
    for secret in filter(None, secrets):
        found += [f"{place}: holds what somebody typed: {secret!r}" for place, text in texts if secret in text]
    return found


def _bundle(bundle: Json) -> Iterator[str]:
    if (bundle.get("resourceType"), bundle.get("type")) != ("Bundle", "collection"):
        yield "is no Bundle of type collection"
    if not _is_instant(bundle.get("timestamp")):
        yield "timestamp is no instant with a time zone"
    urls = [entry.get("fullUrl") for entry in bundle.get("entry", [])]
    if len(set(urls)) < len(urls):
        yield "two entries have the same fullUrl"
    kinds = [entry.get("resource", {}).get("resourceType") for entry in bundle.get("entry", [])]
    if kinds.count("DiagnosticReport") != 1 or kinds.count("Patient") > 1:
        yield "has not exactly one DiagnosticReport and at most one Patient"
    for entry in bundle.get("entry", []):
        name = entry.get("resource", {}).get("id")
        if entry.get("fullUrl") != f"urn:uuid:{name}" or not _is_uuid(name):
            yield f"fullUrl {entry.get('fullUrl')} is not that of its resource"


def _resource(resource: Json, known: dict[str, Json]) -> Iterator[str]:
    kind = str(resource.get("resourceType"))
    if kind not in ELEMENTS:
        yield "a resource of this type has no place in our bundles"
        return
    there = set(resource) - {"resourceType", "id"}
    yield from (f"{name} has no place here" for name in sorted(there - ELEMENTS[kind]))
    yield from (f"{name} is missing" for name in sorted(REQUIRED[kind] - there))
    if kind in STATUSES and resource.get("status") not in STATUSES[kind]:
        yield f"status {resource.get('status')!r} is none of {sorted(STATUSES[kind])}"
    yield from _codings(resource, kind)
    yield from _references(resource, known)
    yield from _times(resource)
    if kind == "Observation":
        yield from _observation(resource)
    if kind == "Patient":
        yield from _patient(resource)
    for place, attachment in _attachments(resource):
        yield from (f"{place}: {each}" for each in attachment_problems(attachment))


def _codings(value: Any, place: str) -> Iterator[str]:
    """Each code is one of its system, and of a system that belongs there."""
    for where, coding in _walk(value, place):
        if not isinstance(coding, dict) or "system" not in coding or "code" not in coding:
            continue
        system, code = coding["system"], coding["code"]
        if system == UCUM:
            continue
        spot = where.removesuffix(".coding")
        if re.fullmatch(r"LA\d+-\d", str(code)):
            yield f"{where}: {code} is the code of an answer in a survey"
        elif code not in CODES.get(system, ()):
            yield f"{where}: {code} is no code of {system} that we use"
        elif system not in SYSTEMS_AT.get(spot, ()):
            yield f"{where}: no code of {system} belongs there"


def _references(resource: Json, known: dict[str, Json]) -> Iterator[str]:
    for name, kinds in POINTS_TO.items():
        targets = resource.get(name, [])
        for target in targets if isinstance(targets, list) else [targets]:
            found = known.get(target.get("reference"), {}).get("resourceType")
            if found is None:
                yield f"{name} points to {target.get('reference')}, which is not in the bundle"
            elif found not in kinds or target.get("type") != found:
                yield f"{name} points to a {found}"


def _times(resource: Json) -> Iterator[str]:
    for name in ("issued", "date"):
        if name in resource and not _is_instant(resource[name]):
            yield f"{name} is no instant with a time zone"
    period = resource.get("effectivePeriod")
    if period is not None:
        start, end = period.get("start"), period.get("end")
        if not (_is_instant(start) and _is_instant(end) and _moment(start) <= _moment(end)):
            yield "effectivePeriod does not start before it ends"


def _observation(resource: Json) -> Iterator[str]:
    codes = resource.get("code", {}).get("coding", [])
    of_a_metric = bool(codes) and codes[0].get("system") == METRICS
    yield from _value(resource, "Observation", wanted=of_a_metric)
    names = []
    for component in resource.get("component", []):
        names.append(component.get("code", {}).get("coding", [{}])[0].get("code"))
        yield from _value(component, f"component {names[-1]}", wanted=True)
    if len(set(names)) < len(names):
        yield "two components say the same"


def _value(element: Json, place: str, *, wanted: bool) -> Iterator[str]:
    """Either a value or the reason why there is none; a quantity has a UCUM unit of ours."""
    values = [name for name in VALUES if name in element]
    if len(values) + ("dataAbsentReason" in element) != (1 if wanted else 0):
        yield f"{place}: needs either one value or dataAbsentReason"
    for coding in element.get("dataAbsentReason", {}).get("coding", []):
        if coding.get("system") != ABSENT:
            yield f"{place}: dataAbsentReason is not coded"
    amount = element.get("valueQuantity")
    if amount is None:
        return
    number, code = amount.get("value"), amount.get("code")
    if not isinstance(number, int | float) or isinstance(number, bool) or number != number or abs(number) > 1e12:
        yield f"{place}: value {number!r} is no number"
    if amount.get("system") != UCUM or not is_ucum(str(code)) or code not in _UCUM_CODES:
        yield f"{place}: {code!r} is no UCUM unit of ours"


def _patient(resource: Json) -> Iterator[str]:
    if resource.get("gender", "female") not in ("female", "male"):
        yield "gender is not as declared"
    if "birthDate" in resource and not _YEAR.fullmatch(str(resource["birthDate"])):
        yield "birthDate tells more than a year"
    if not all(re.fullmatch(r"[0-9A-Z]{1,16}", str(each.get("value"))) for each in resource.get("identifier", [])):
        yield "identifier is no patient code"


def _attachments(resource: Json) -> Iterator[tuple[str, Json]]:
    for form in resource.get("presentedForm", []):
        yield "presentedForm", form
    for content in resource.get("content", []):
        yield "content", content.get("attachment", {})


def _walk(value: Any, place: str) -> Iterator[tuple[str, Any]]:
    """Every element below, with its path without indices."""
    yield place, value
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from _walk(inner, f"{place}.{name}")
    elif isinstance(value, list):
        for inner in value:
            yield from _walk(inner, place)


def _texts(value: Any, place: str) -> Iterator[tuple[str, str]]:
    return ((where, text) for where, text in _walk(value, place) if isinstance(text, str))


def _is_instant(text: Any) -> bool:
    return isinstance(text, str) and _INSTANT.fullmatch(text) is not None


def _moment(text: str) -> datetime:
    return datetime.fromisoformat(text.replace("Z", "+00:00"))


def _is_uuid(text: Any) -> bool:
    try:
        return bool(str(uuid.UUID(str(text))) == text)
    except ValueError:
        return False
