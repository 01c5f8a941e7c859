"""Tables II, III and IV in the form of the paper, from the scores of any recordings."""

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.stats import wilcoxon

from services.bench.joukov.marching import ESTIMATORS, PLAIN, TITLES, Setting
from services.bench.joukov.regions import BOTTOM, JOINT_NAMES, QUANTITIES, REGIONS, TOP, RegionErrors
from services.bench.report import Table, number

FloatArray = NDArray[np.float64]

UNITS = ("deg", "deg/s", "deg/s2")
SIGNIFICANT = 0.05


class Scored(Protocol):
    """What a table needs of a filter on a recording."""

    @property
    def errors(self) -> RegionErrors:
        """By region, quantity and joint."""

    @property
    def prediction(self) -> FloatArray:
        """RMSE of the next sample, (2, 2): gyroscope rad/s and accelerometer m/s^2 by thigh and shank."""


People = Mapping[str, Mapping[Setting, Scored]]
"""Scores by person."""


def error_table(people: People, model: str, at: str, S: float, region: int) -> Table:
    """Table II (region TOP) or III (BOTTOM): RMSE +- SD of the error, and the mean over the people.

    A star: smaller than the plain filter's in a one-sided Wilcoxon test, paired over the people, at 5 %.
    """
    header = ["", *(f"{TITLES[estimator]} {joint}" for estimator in ESTIMATORS for joint in JOINT_NAMES)]
    rows = []
    for q, quantity in enumerate(QUANTITIES):
        rows.append([f"*{quantity}, {UNITS[q]}*", *("" for _ in header[1:])])
        for person, scores in people.items():
            cells = [_spread(scores[Setting(model, e, S)].errors, region, q, j) for e in ESTIMATORS for j in range(2)]
            rows.append([person, *cells])
        if len(people) > 1:
            means = [_mean(people, Setting(model, e, S), (region, q, j)) for e in ESTIMATORS for j in range(2)]
            rows.append(["**mean**", *means])
    name = {TOP: "Table II", BOTTOM: "Table III"}.get(region, "Table II, by another reading")
    return Table(f"{name} at {at}: RMSE ± SD of the error, {REGIONS[region]} by acceleration", header, rows)


def _spread(errors: RegionErrors, region: int, quantity: int, joint: int) -> str:
    rmse, sd = (float(np.degrees(part[region, quantity, joint])) for part in errors)
    return f"{number(rmse)} ± {number(sd)}"


def _mean(people: People, setting: Setting, place: tuple[int, int, int]) -> str:
    ours = np.array([scores[setting].errors.rmse[place] for scores in people.values()])
    plain = np.array(
        [scores[Setting(setting.model, PLAIN, setting.S)].errors.rmse[place] for scores in people.values()]
    )
    star = "\\*" if setting.estimator != PLAIN and is_smaller(ours, plain) else ""
    return f"**{number(float(np.degrees(ours.mean())))}**{star}"


def is_smaller(ours: FloatArray, theirs: FloatArray) -> bool:
    """Whether paired values (n,) are smaller, by a one-sided Wilcoxon signed-rank test."""
    if np.all(ours == theirs):
        return False
    return bool(wilcoxon(ours, theirs, alternative="less").pvalue < SIGNIFICANT)


def prediction_table(people: People, models: Mapping[str, str], at: str, S: float) -> Table:
    """Table IV: RMSE per axis of the next sample, thigh ("knee" IMU in the paper) and shank ("ankle" IMU).

    Args:
        people: scores by person.
        models: what to call each measurement model.
        at: name of S.
        S: (rad/s^3)^2.
    """
    header = ["", *(f"{TITLES[e]} {place}" for e in ESTIMATORS for place in ("thigh", "shank"))]
    rows: list[Sequence[str]] = []
    for model, words in models.items():
        for kind, title in enumerate(("gyroscope, deg/s", "accelerometer, m/s2")):
            rows.append([f"*{title}; {words}*", *("" for _ in header[1:])])
            table = {
                person: [scores[Setting(model, e, S)].prediction[kind, place] for e in ESTIMATORS for place in range(2)]
                for person, scores in people.items()
            }
            values = {person: np.degrees(cells) if kind == 0 else np.array(cells) for person, cells in table.items()}
            rows += [[person, *map(number, cells.tolist())] for person, cells in values.items()]
            if len(people) > 1:
                mean = np.mean(list(values.values()), axis=0)
                rows.append(["**mean**", *(f"**{number(value)}**" for value in mean.tolist())])
    return Table(f"Table IV at {at}: RMSE of the predicted next sample", header, rows)
