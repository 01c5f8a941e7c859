"""The section about FHIR measures what it says, and would say otherwise of what is wrong."""

import pytest

from services.bench.metrics import fhir
from services.report.press import Press


@pytest.fixture(scope="module")
def computed():
    """The one session, with its printed report."""
    return fhir._source("synthetic:walk?duration=12&seed=2", 0, Press())


@pytest.fixture(autouse=True)
def _one_short_session(monkeypatch, computed):
    monkeypatch.setattr(fhir, "KINDS", {"short": "computed once"})
    monkeypatch.setattr(fhir, "_source", lambda *_: computed)


def values(section):
    return {row.name: (row.value, row.met) for row in section.rows}


def test_a_right_bundle_meets_both_targets():
    steps = []
    section = fhir.fhir_section(lambda: steps.append(1))
    said = values(section)
    assert said["FHIR: faults by our own check"] == (0, True)
    assert said["FHIR: resources that fhir.resources refuses"] == (0, True)
    assert said["FHIR: largest bundle with PDF"][0] > said["FHIR: largest bundle without PDF"][0] > 100
    assert len(steps) == len(section.tables[0].rows) == 1


def test_a_wrong_bundle_meets_neither(monkeypatch):
    right = fhir.bundle

    def wrong(source):
        made = right(source)
        made["entry"][0]["resource"]["name"] = [{"text": fhir.TYPED}]
        made["entry"][-1]["resource"]["status"] = 7
        return made

    monkeypatch.setattr(fhir, "bundle", wrong)
    said = values(fhir.fhir_section(lambda: None))
    assert said["FHIR: faults by our own check"][0] >= 3
    assert said["FHIR: resources that fhir.resources refuses"] == (1, False)
