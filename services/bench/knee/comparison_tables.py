"""Tables and charts of the error analysis: per trial, Bland-Altman, error over time (table 1 and figures 2 and 5)."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from services.bench.knee.agreement import Errors
from services.bench.knee.comparison import OURS, Judged, pooled
from services.bench.knee.peers import LITERAL
from services.bench.line_chart import line_chart
from services.bench.report import Table, number

Array = NDArray[np.float64]

COLOURS = {OURS: "#1f6fb2", LITERAL: "#8e5ea2", "McGrath on VQF": "#8e5ea2", "truth": "#222222"}
DOTS, TRACE = 500, 600
"""Points of a scatter and of a trace at most."""
Trials = Mapping[str, Sequence[Judged]]
"""Methods by trial, ours first."""


def per_trial_table(trials: Trials) -> Table:
    """Absolute and zero-mean RMSE of every trial and method, and of all samples together."""
    methods = list(dict.fromkeys(one.method for judged in trials.values() for one in judged))
    lines = []
    for trial, judged in trials.items():
        by_method = {one.method: one.errors for one in judged}
        pairs = [_pair(by_method[m]) if m in by_method else "-" for m in methods]
        lines.append([trial, *pairs])
    of_method = {m: [one for judged in trials.values() for one in judged if one.method == m] for m in methods}
    lines.append(["total", *(_pair(pooled(of_method[m])) for m in methods)])
    return Table("RMSE by trial, deg: zero-mean (absolute), best constant shift", ["trial", *methods], lines)


def agreement_table(trials: Trials) -> Table:
    """Bland-Altman analysis of ours and of the published method."""
    lines = []
    for trial, judged in trials.items():
        for one in judged:
            if one.method in (OURS, literal_of(judged)):
                a = one.agreement
                p = "< 0.001" if a.bias_p < 0.001 else f"{a.bias_p:.3f}"
                sign = "-" if a.intercept < 0.0 else "+"
                lines.append([
                    f"{trial}, {one.method}", f"{a.r_squared:.4f}", f"{a.slope:.3f} x {sign} {abs(a.intercept):.2f}",
                    f"{a.bias:.2f}", p, f"{a.lower_limit:.2f}", f"{a.upper_limit:.2f}", str(a.samples),
                ])  # fmt: skip
    header = ("trial, method", "r2", "estimate over truth", "bias, deg", "p of no bias", "lower limit, deg",
              "upper limit, deg", "samples")  # fmt: skip
    return Table("Bland-Altman agreement of the absolute angle, limits 95 %", header, lines)


def cost_table(trials: Trials) -> Table:
    """Processor time of a sample where it was measured with the method."""
    costs: dict[str, list[float]] = {}
    for judged in trials.values():
        for one in judged:
            if one.cost_us is not None:
                costs.setdefault(one.method, []).append(one.cost_us)
    lines = [[method, number(float(np.median(values)))] for method, values in costs.items()]
    return Table("Processor time of a sample of both sensors, median over the trials", ("method", "us"), lines)


def trial_charts(trials: Trials, rates_hz: Mapping[str, float]) -> dict[str, str]:
    """Regression, Bland-Altman and error over time of each trial, by file name."""
    charts = {}
    for trial, judged in trials.items():
        shown = [one for one in judged if one.method in (OURS, literal_of(judged))]
        name = "".join(c if c.isalnum() else "_" for c in trial)
        charts[f"regression_{name}"] = _regression(trial, shown)
        charts[f"bland_altman_{name}"] = _differences(trial, shown)
        charts[f"error_{name}"] = _errors_over_time(trial, shown, rates_hz[trial])
    return charts


def literal_of(judged: Sequence[Judged]) -> str:
    """The published method on orientations of the recording, else on those of VQF."""
    return LITERAL if any(one.method == LITERAL for one in judged) else "McGrath on VQF"


def _regression(trial: str, judged: Sequence[Judged]) -> str:
    dots = {one.method: _points(*_thinned(one.truth, one.estimate, DOTS)) for one in judged}
    lines = {}
    for one in judged:
        a, ends = one.agreement, np.array([one.truth.min(), one.truth.max()])
        lines[f"{one.method}, r2 {a.r_squared:.3f}"] = _points(ends, a.slope * ends + a.intercept)
    colours = COLOURS | {name: COLOURS[one.method] for name, one in zip(lines, judged, strict=True)}
    return line_chart(f"{trial}: estimate over truth", "true flexion, deg", "estimated flexion, deg", lines | dots,
                      from_zero=False, dots=dots, colours=colours)  # fmt: skip


def _differences(trial: str, judged: Sequence[Judged]) -> str:
    dots, lines, colours = {}, {}, dict(COLOURS)
    for one in judged:
        a, mean = one.agreement, 0.5 * (one.estimate + one.truth)
        dots[one.method] = _points(*_thinned(mean, one.estimate - one.truth, DOTS))
        for title, level in (("upper limit", a.upper_limit), ("bias", a.bias), ("lower limit", a.lower_limit)):
            name = f"{one.method}: {title}"
            lines[name] = [(float(mean.min()), level), (float(mean.max()), level)]
            colours[name] = COLOURS[one.method]
    limits = [name for name in lines if name.endswith("limit")]
    return line_chart(
        f"{trial}: difference over mean (Bland-Altman)",
        "mean of estimate and truth, deg",
        "estimate minus truth, deg",
        lines | dots,
        from_zero=False,
        dots=dots,
        colours=colours,
        dashed=limits,
    )


def _errors_over_time(trial: str, judged: Sequence[Judged], rate_hz: float) -> str:
    lines = {}
    for one in judged:
        error = one.estimate - one.truth
        whole = np.full(int(one.frames[-1]) + 1, np.nan)
        whole[one.frames] = error - error.mean()
        lines[one.method] = _points(*_thinned(np.arange(len(whole)) / rate_hz, whole, TRACE))
    return line_chart(f"{trial}: error over time, mean removed", "time, s", "error, deg", lines, from_zero=False,
                      colours=COLOURS)  # fmt: skip


def _thinned(x: Array, y: Array, most: int) -> tuple[Array, Array]:
    step = max(1, -(-len(x) // most))
    return x[::step], y[::step]


def _points(x: Array, y: Array) -> list[tuple[float, float]]:
    return list(zip(x.tolist(), y.tolist(), strict=True))


def _pair(e: Errors) -> str:
    return f"{number(e.zero_mean_rmse)} ({number(e.absolute_rmse)})"
