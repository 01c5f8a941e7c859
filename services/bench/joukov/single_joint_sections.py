"""The published simulation and the curve over S of one joint, in the report."""

from collections.abc import Mapping, Sequence

import numpy as np

from services.bench.joukov.curve import curve_ratio, curve_rows, median_ratio, worst_ratio
from services.bench.joukov.sections import COLOURS, Finding, Section, change, up_to
from services.bench.joukov.simulation import (
    JERK_EDGES,
    PUBLISHED_DEG,
    SweepStudy,
    add_bins,
    lag_ms,
    median_error,
    simulation_rows,
)
from services.bench.joukov.study import FIRST, GRID, QUANTITIES, UNITS, Study
from services.bench.line_chart import line_chart
from services.bench.report import Table, number
from services.bench.scoreboard import Row, informative

S_LABEL = "process noise S, (rad/s³)²"
TITLES = {
    "plain": "EKF",
    "published": "literal",
    "trusted": "ours",
    "adaptive noise": "ours, adaptive noise",
    "unchanged": "ours, as for walking",
}
WORDS = {
    "random": "periodic, random shape",
    "knee": "a walking knee",
    "smooth": "random, no period",
    "reaches": "single reaches",
    "knee, stops": "a knee that stops",
    "knee, stumbles": "a knee that stumbles",
}


def simulation_section(sweeps: Mapping[str, Sequence[SweepStudy]], holds: Mapping[str, float]) -> Section:
    """Section IV-A of the paper, many times over."""
    motions = len(next(iter(sweeps.values())))
    ekf, rhythmic = PUBLISHED_DEG
    rows: list[Row] = [informative("as published, one motion: position", rhythmic, "deg", ekf)]
    tables, drawn = [], {}
    for name, sweep in sweeps.items():
        rows += simulation_rows(name, sweep, detail=holds[name] > 0.0)
        tables += [_error_table(name, sweep), _lock_table(name, sweep)]
        slug = name.replace(" ", "_")
        drawn[f"{slug}_jerk"] = jerk_chart(f"{name}: acceleration error over jerk at S*/10 (figure 6)", sweep)
        for i in (0, 2):
            title = f"{name}: {QUANTITIES[i]} error over S"
            drawn[f"{slug}_{QUANTITIES[i]}"] = error_chart(title, [item.study for item in sweep], i)
    paragraphs = [
        "A single joint turns as section IV-A of the paper describes: five harmonics with random coefficients, an IMU "
        "at 0.5 m, noise of 2 m/s² and 0.5 rad/s, the frequency raised from 1 to 5 rad/s. The paper shows one motion "
        f"(EKF {ekf} deg, Rhythmic-EKF {rhythmic} deg); these are medians over {motions}, seeds 60000 and on, and "
        "parameters were chosen on seeds below 2000. The text can be read as a ramp of 40 s at once, or after 40 s at "
        "1 rad/s (with hold); both are here.",
        "Literal: equations 10 to 21 as printed with 7 harmonics and rates 0.7 and 0.2, told a frequency 15 % off. "
        "Ours: the rhythm that has to prove its lock, told nothing, widened for a sweep that begins below any stride. "
        "S* is, for each motion, the smallest S of half decades at which the plain filter's position is within 1 % of "
        "its best, scored on the same motion, as the paper's minimisation does.",
    ]
    findings = [_finding(name, sweep) for name, sweep in sweeps.items()]
    return Section("The published simulation", paragraphs, rows, tables, drawn, findings)


def _finding(name: str, sweep: Sequence[SweepStudy]) -> Finding:
    """Where the published gain in position appears."""
    ekf, rhythmic = PUBLISHED_DEG
    here, where = [], []
    for filtered in ("trusted", "published"):
        position = {
            key: np.median([s.study.curves[key][FIRST:, 0] for s in sweep], axis=0) for key in ("plain", filtered)
        }
        reached = np.flatnonzero(position[filtered] <= rhythmic / ekf * position["plain"])
        where.append(f"{TITLES[filtered]}: {up_to(float(GRID[FIRST + reached[-1]]) if reached.size else None)}")
        for tenth, at in ((False, "S*"), (True, "S*/10")):
            plain, ours = (float(median_error(sweep, key, tenth)[0]) for key in ("plain", filtered))
            here.append(f"EKF {number(plain)} to {TITLES[filtered]} {number(ours)} at {at}")
    return Finding(
        f"position {ekf} to {rhythmic} deg ({change(rhythmic / ekf)}), {name}", "; ".join(here), "; ".join(where)
    )


def _error_table(name: str, sweep: Sequence[SweepStudy]) -> Table:
    rows = []
    for at, tenth in (("S*", False), ("S*/10", True)):
        for filtered, title in TITLES.items():
            error, plain = (median_error(sweep, key, tenth) for key in (filtered, "plain"))
            cells = [f"{number(float(e))} ({change(float(e / p))})" for e, p in zip(error, plain, strict=True)]
            rows.append([f"{title}, {at}", *cells])
    header = ["", *(f"{quantity}, {unit}" for quantity, unit in zip(QUANTITIES, UNITS, strict=True))]
    return Table(f"{name}: median RMSE once converged (against the EKF)", header, rows)


def _lock_table(name: str, sweep: Sequence[SweepStudy]) -> Table:
    rows = []
    for filtered in ("published", "trusted", "unchanged"):
        locked = 100.0 * float(np.mean([item.locked[filtered] for item in sweep]))
        lag = lag_ms(add_bins([item.bins[filtered][1] for item in sweep]))
        rows.append([TITLES[filtered], f"{locked:.0f} %", f"{lag:.1f} ms"])
    plain = lag_ms(add_bins([item.bins["plain"][1] for item in sweep]))
    rows.append([TITLES["plain"], "-", f"{plain:.1f} ms"])
    header = ["", "motions that end on the true fundamental", "lag of the acceleration at S*/10"]
    return Table(f"{name}: lock and lag", header, rows)


def curve_section(studies: Mapping[str, Sequence[Study]]) -> Section:
    """What the rhythm adds at every S, for motions with and without a period."""
    motions = len(next(iter(studies.values())))
    rows = [row for kind, study in studies.items() for row in curve_rows(kind, study)]
    drawn = {}
    for kind, study in studies.items():
        slug = kind.replace(", ", "_").replace(" ", "_")
        drawn[f"curve_{slug}"] = ratio_chart(f"One joint, {WORDS.get(kind, kind)}: error against the plain EKF", study)
    paragraphs = [
        f"The same joint and noise, {motions} motions of each kind: periodic ones of random shape, walking knees, and "
        "four kinds that are not periodic throughout. The tuning decides what a rhythm can add, so the whole curve is "
        "given, and two points of it: S* as above, and S*/10, the lag-limited filter of the published figures.",
        "Baseline in the rows: the literal oscillator on the same motions. Motions that are not periodic must not be "
        "made worse by more than 2 % in any quantity of any run.",
    ]
    return Section("One joint over the process noise", paragraphs, rows, [_ratio_table(studies)], drawn)


def _ratio_table(studies: Mapping[str, Sequence[Study]]) -> Table:
    rows = []
    for kind, study in studies.items():
        for at, tenth in (("S*", False), ("S*/10", True)):
            cells = []
            for name in ("published", "trusted"):
                cells += [change(float(ratio)) for ratio in median_ratio(study, name, tenth)]
            rows.append([f"{WORDS.get(kind, kind)}, {at}", *cells])
        worst = [f"{worst_ratio(study, name):.2f}" for name in ("published", "trusted")]
        rows.append([f"{WORDS.get(kind, kind)}, worst run", worst[0], "", "", worst[1], "", ""])
    header = ["", *(f"{title}: {quantity}" for title in ("literal", "ours") for quantity in QUANTITIES)]
    return Table("Median change of the RMSE against the plain EKF; worst ratio of any run", header, rows)


def jerk_chart(title: str, sweep: Sequence[SweepStudy]) -> str:
    """Figure 6: how far the acceleration is behind, by the jerk."""
    lines = {}
    for name in sweep[0].bins:
        bins = add_bins([item.bins[name][1] for item in sweep])
        lines[TITLES.get(name, name)] = [
            (float(edge), float(np.degrees(bins.lag[i] / bins.count[i])))
            for i, edge in enumerate(JERK_EDGES[:-1])
            if bins.count[i] > 0.0
        ]
    return line_chart(title, "|jerk| of at least, rad/s³", "acceleration behind by, deg/s²", lines, colours=COLOURS)


def error_chart(title: str, studies: Sequence[Study], quantity: int) -> str:
    """Median RMSE over S of each filter."""
    lines = {}
    for name in studies[0].curves:
        error = np.degrees(np.median([study.curves[name][FIRST:, quantity] for study in studies], axis=0))
        lines[TITLES.get(name, name)] = list(zip(GRID[FIRST:].tolist(), error.tolist(), strict=True))
    return line_chart(
        title, S_LABEL, f"median RMSE, {UNITS[quantity].replace('2', '²')}", lines, log_x=True, colours=COLOURS
    )


def ratio_chart(title: str, studies: Sequence[Study]) -> str:
    """Median ratio to the plain filter over S: the trusted rhythm in all quantities, the published in acceleration."""
    trusted, published = curve_ratio(studies, "trusted"), curve_ratio(studies, "published")
    lines = {f"ours, {name}": _points(trusted[:, i].tolist()) for i, name in enumerate(QUANTITIES)}
    lines["literal, acceleration"] = _points(published[:, 2].tolist())
    return line_chart(title, S_LABEL, "median ratio of RMSE", lines, log_x=True, levels={"EKF": 1.0}, colours=COLOURS)


def _points(values: list[float]) -> list[tuple[float, float]]:
    return list(zip(GRID[FIRST:].tolist(), values, strict=True))
