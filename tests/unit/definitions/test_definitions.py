import re
from pathlib import Path

import pytest

import services.definitions
from services.definitions.definition import Basis
from services.definitions.strides import STRIDE_METRICS
from services.definitions.symmetry import OTHER_SYMMETRY, RATIOS_OF
from services.definitions.table import BY_NAME, DEFINITIONS
from services.definitions.trunk import TRUNK
from services.definitions.variability import VARIABILITY_OF

README = (Path(services.definitions.__file__).parent / "README.md").read_text()
UNITS = {"s", "m", "m/s", "rad", "1", "steps/min", "rad/s", "rad/repetition", "repetitions/min", "m/s/min"}


@pytest.mark.parametrize("definition", DEFINITIONS, ids=lambda definition: definition.name)
def test_a_metric_is_defined_in_full(definition):
    assert re.fullmatch(r"[a-z]+(_[a-z]+)*", definition.name)
    assert definition.unit in UNITS
    assert definition.sentence.endswith(".")
    assert len(definition.sentence) > 20


@pytest.mark.parametrize("definition", DEFINITIONS, ids=lambda definition: definition.name)
def test_a_metric_is_documented(definition):
    sides = "each side" if definition.per_side else "whole body"
    assert f"| `{definition.name}` | {definition.unit} | {sides} | {definition.sentence} |" in README


def test_the_documentation_has_no_other_metrics():
    assert len(re.findall(r"^\| `[a-z_]+` \| [^|]+ \| (each side|whole body) \|", README, re.MULTILINE)) == len(
        DEFINITIONS
    )


def test_names_are_unique():
    assert len(BY_NAME) == len(DEFINITIONS)


def test_ratios_and_variability_rest_on_metrics_that_exist():
    measured = {definition.name: definition for definition in STRIDE_METRICS}
    assert all(measured[name].per_side for name in RATIOS_OF)
    assert set(VARIABILITY_OF) <= set(measured)
    assert all(definition.measure is not None for definition in measured.values())


def test_everything_of_a_stride_says_what_it_rests_on():
    assert all(definition.basis not in (Basis.TASK, Basis.COUNT) for definition in STRIDE_METRICS)


def test_what_says_the_ratio_again_is_for_export_only():
    assert all(definition.export_only for definition in OTHER_SYMMETRY)
    assert sum(definition.export_only for definition in DEFINITIONS) == len(OTHER_SYMMETRY) + len(TRUNK)
    assert len(OTHER_SYMMETRY) == 3 * len(RATIOS_OF)
