"""How often the truth lies within the interval that was stated, by family of metrics."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from schemas.metrics import Metric, TrustGrade
from services.definitions.definition import CV_SUFFIX, SD_SUFFIX, Basis
from services.definitions.symmetry import PARETIC_RATIOS, RATIOS
from services.definitions.table import BY_NAME
from services.metrics.intervals import Z95

Truth = Mapping[tuple[str, str | None], float]

_BY_BASIS = {
    Basis.CONTACTS: "stride and step times",
    Basis.TOE_OFFS: "stance, swing and support",
    Basis.LENGTHS: "lengths and speed",
    Basis.KNEE: "knee angles",
    Basis.HIP: "hip angles",
    Basis.PELVIS: "pelvis angles",
}
_RATIOS = {definition.name for definition in (*RATIOS, *PARETIC_RATIOS)}
FAMILIES = (*_BY_BASIS.values(), "symmetry ratios", "variability")


@dataclass
class Family:
    """Every shown value of a family of metrics, with its truth."""

    within: list[bool] = field(default_factory=list)
    within_naive: list[bool] = field(default_factory=list)
    widths: list[float] = field(default_factory=list)
    """Of the whole interval, relative to the truth's size over the family's persons."""
    widths_naive: list[float] = field(default_factory=list)
    by_name: dict[str, list[bool]] = field(default_factory=dict)
    withheld: int = 0

    @property
    def coverage(self) -> float:
        """% of the intervals."""
        return 100.0 * float(np.mean(self.within)) if self.within else float("nan")

    @property
    def coverage_naive(self) -> float:
        """% of value +- 1.96 standard errors of the scatter over the strides."""
        return 100.0 * float(np.mean(self.within_naive)) if self.within_naive else float("nan")


def family_of(name: str) -> str | None:
    """None of what has no interval, or says another one's again."""
    definition = BY_NAME.get(name)
    if definition is None or definition.export_only:
        return None
    if name in _RATIOS:
        return "symmetry ratios"
    return "variability" if name.endswith((SD_SUFFIX, CV_SUFFIX)) else _BY_BASIS.get(definition.basis)


def score(metrics: Iterable[Metric], truth: Truth, families: dict[str, Family]) -> None:
    """Add one session's metrics."""
    for metric in metrics:
        name, key = family_of(metric.name), (metric.name, metric.side)
        if name is None or key not in truth:
            continue
        family = families.setdefault(name, Family())
        if metric.grade is TrustGrade.WITHHELD or metric.value is None or metric.low is None or metric.high is None:
            family.withheld += 1
            continue
        true = truth[key]
        naive = Z95 * (metric.mean_std or 0.0)
        hit = metric.low <= true <= metric.high
        family.within.append(hit)
        family.by_name.setdefault(metric.name, []).append(hit)
        family.within_naive.append(abs(metric.value - true) <= naive)
        size = max(abs(true), 1e-9)
        family.widths.append((metric.high - metric.low) / size)
        family.widths_naive.append(2.0 * naive / size)
