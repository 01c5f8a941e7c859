import re
from pathlib import Path

import pytest

from services.metrics import definitions
from services.metrics.definitions import METRICS
from services.metrics.exercise_definitions import EXERCISES
from services.metrics.repetition_definitions import REPETITIONS
from services.metrics.tug_definitions import TUG

README = (Path(definitions.__file__).parent / "README.md").read_text()
UNITS = {"s", "m", "m/s", "rad", "1", "steps/min", "rad/s", "rad/repetition", "repetitions/min"}
ALL = (*METRICS, *REPETITIONS, *EXERCISES, *TUG)


@pytest.mark.parametrize("definition", ALL, ids=lambda definition: definition.name)
def test_a_metric_is_defined_in_full(definition):
    assert re.fullmatch(r"[a-z]+(_[a-z]+)*", definition.name)
    assert definition.unit in UNITS
    assert definition.sentence.endswith(".")
    assert len(definition.sentence) > 20


@pytest.mark.parametrize("definition", ALL, ids=lambda definition: definition.name)
def test_a_metric_is_documented(definition):
    sides = "each side" if definition.per_side else "whole body"
    assert f"| `{definition.name}` | {definition.unit} | {sides} | {definition.sentence} |" in README


def test_the_documentation_has_no_other_metrics():
    assert len(re.findall(r"^\| `", README, re.MULTILINE)) == len(ALL)


def test_names_are_unique():
    names = [definition.name for definition in ALL]
    assert len(set(names)) == len(names)


def test_ratios_and_variability_rest_on_metrics_that_exist():
    measured = {definition.name: definition for definition in definitions.STRIDE_METRICS}
    assert all(measured[name].per_side for name in definitions.RATIOS_OF)
    assert set(definitions.VARIABILITY_OF) <= set(measured)
    assert all(definition.measure is not None for definition in measured.values())
