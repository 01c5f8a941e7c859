"""How often the truth lies within the 95 % intervals that a report states, on patients nothing was chosen on."""

from collections.abc import Callable

import numpy as np

from services.bench.metrics.coverage_scores import FAMILIES, Family, score
from services.bench.metrics.coverage_sessions import measured_metrics
from services.bench.metrics.coverage_truth import true_metrics
from services.bench.metrics.patients import SETTING, SPEEDS
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, informative

FIRST_SEED = 5001
"""Persons that are scored; those of 2001 to 2032, 3001 to 3016 and 4001 to 4032 have set the parameters."""
PERSONS = 2
"""Of each kind at each speed."""
ESTIMATOR = "rhythmic_ekf"
STEPS = PERSONS * sum(map(len, SPEEDS.values()))
LEAST, MOST = 90.0, 99.0
NOTE = (
    "coverage: share of the stated 95 % intervals in which the truth lies, of every number that is not withheld. The "
    "truth is how the person walks over 160 s as planned; measured are 40 s of it, a body known to 3 %, sensors on "
    f"soft tissue. Persons from seed {FIRST_SEED} on; what the intervals rest on was chosen on those of 2001 to 2032, "
    "3001 to 3016 and 4001 to 4032. Baseline: value +- 1.96 standard errors of the scatter over the strides, as usual"
)


def coverage_section(advance: Callable[[], None]) -> Section:
    """Coverage and width by family of metrics."""
    families = scored(advance)
    rows = [_row(name, families[name]) for name in FAMILIES if name in families]
    details = [
        informative(f"coverage, {name}", 100.0 * float(np.mean(hits)), "%", detail=True)
        for family in families.values()
        for name, hits in family.by_name.items()
    ]
    return Section("95 % intervals", [NOTE], [*rows, *details], [_table(families)])


def scored(advance: Callable[[], None], first_seed: int = FIRST_SEED, persons: int = PERSONS) -> dict[str, Family]:
    """Every family of metrics over all persons."""
    families: dict[str, Family] = {}
    seed = first_seed
    for _ in range(persons):
        for kind, speeds in SPEEDS.items():
            for speed in speeds:
                side = ("left", "right")[seed % 2]
                person = f"patient={kind}&speed={speed}&seed={seed}&affected={side}"
                session = measured_metrics(f"{person}&{SETTING}", ESTIMATOR)
                score(session.metrics, true_metrics(person), families)
                seed += 1
                advance()
    return families


def _row(name: str, family: Family) -> Row:
    met = LEAST <= family.coverage <= MOST
    return Row(f"coverage, {name}", family.coverage, "%", f"{LEAST:g} to {MOST:g}", met, family.coverage_naive)


def _table(families: dict[str, Family]) -> Table:
    return Table(
        "95 % intervals: coverage and median width, as a share of the truth",
        ("family", "numbers", "withheld", "covered %", "width %", "naive: covered %", "naive: width %"),
        [
            (
                name,
                str(len(family.within)),
                str(family.withheld),
                number(family.coverage),
                number(100.0 * float(np.median(family.widths))),
                number(family.coverage_naive),
                number(100.0 * float(np.median(family.widths_naive))),
            )
            for name, family in families.items()
        ],
    )
