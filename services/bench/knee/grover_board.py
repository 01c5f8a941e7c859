"""The published band: both filters side by side, bias by window, cost, ours beside (figures 5 and 6, table 1)."""

import numpy as np
from rich.progress import Progress

from services.bench.knee.grover_charts import figure_5, figure_6, first_minute
from services.bench.knee.grover_cost import (
    ONE_STATE,
    SESSION_S,
    TWO_STATES,
    Cost,
    compiled_cost,
    operations,
    over_a_session,
    plain_cost,
)
from services.bench.knee.grover_recorded import recorded, recorded_difference
from services.bench.knee.grover_scores import (
    LITERAL,
    WINDOWS,
    Traces,
    bias_curves,
    bias_errors,
    largest_difference,
    motions,
    synthetic,
    traces,
)
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.ingest.errors import MissingFile

LIMITS = {"walking": 3.7, "flexion": 1.8, "cycling": 1.8}
"""deg, section 4."""
CADENCES = np.linspace(0.8, 1.2, 9)
SEEDS = range(3)
LEGS = 64
PARAGRAPHS = [
    "The paper's constants at 20 Hz with its biases (0.83 and -0.5 deg/s); synthetic legs with noise and 1 deg of soft "
    "tissue, 110 s. Differences are those of the two filters from 1 s after the simplified one starts. The mean of the "
    "rate is bias plus net turn over the window: the 5 % hold in one plane and fail where the trunk sways.",
    "Run time: the same steps in one compiled form, processor time, both filters of the knee, median of interleaved "
    f"repetitions. One leg alone waits for a division in every sample and measures latency; {LEGS} legs side by side "
    "measure work. 'Interpreted' are the library's objects. The published factor holds for work and for operations and "
    "not for latency. A Fourier transform for the sake of its constant term costs as much as some thousand samples.",
    "Recorded: the rates and forces as means over 50 ms, across the axis that our estimator finds. No recording at "
    "hand shows thigh and shank walking or cycling for the 50 s that the biases need. The longest walk, 25 s from "
    "standing to standing, is played three times; drop landings and a hinge moved by hand (with whole turns) have no "
    "published counterpart. The 100 s of qmt's whole-body example are no planar knee: the principal axes of its "
    "gyroscopes lie 30 deg off the horizontal.",
]


def grover_section(progress: Progress) -> Section:
    """All rows, tables and charts."""
    rows: list[Row] = []
    shown: dict[str, Traces] = {}
    for name, motion in progress.track(motions().items(), description="band: activities"):
        largest = max(largest_difference(synthetic(motion, seed)) for seed in SEEDS)
        rows.append(at_most(f"{name}: simplified against conventional, largest", _deg(largest), "deg", LIMITS[name]))
        shown[name] = traces(motion, 0)
    errors = error_table(shown)
    costs = _costs()
    rows += recorded_rows(progress) + bias_rows(progress) + cost_rows(costs)
    charts = {"figure_5": figure_5()}
    charts |= {f"figure_6_{name}": figure_6(name, found) for name, found in shown.items()}
    charts["band_first_minute"] = first_minute("walking", shown["walking"])
    return Section("Grover's band", PARAGRAPHS, rows, [table_1(costs), errors, bias_table()], charts)


def bias_rows(progress: Progress) -> list[Row]:
    """Error of the learned bias over cadences, in one plane and with sway."""
    rows: list[Row] = []
    for is_planar in progress.track((True, False), description="band: biases"):
        for name in motions():
            errors = np.array([bias_errors(motions(c, is_planar=is_planar)[name], k) for k, c in enumerate(CADENCES)])
            published, ours = np.median(errors, axis=0).tolist()
            title = f"{name}{'' if is_planar else ' with sway'}: bias after {LITERAL.debias_samples} samples, median"
            rows.append(
                at_most(title, 100.0 * published, "%", 5.0) if is_planar else informative(title, 100.0 * published, "%")
            )
            rows.append(informative(f"{title}, our band while running", 100.0 * ours, "%"))
            rows.append(informative(f"{title}: worst", 100.0 * float(errors[:, 0].max()), "%", detail=True))
    return rows


def recorded_rows(progress: Progress) -> list[Row]:
    """Both filters on recordings; the walk has the published limit."""
    try:
        recordings = recorded()
    except MissingFile as error:
        return [Row("recorded: simplified against conventional, largest", None, "deg", str(error), None, None)]
    rows: list[Row] = []
    for name, recording in progress.track(recordings.items(), description="band: recordings"):
        figure, largest = f"{name}: simplified against conventional, largest", _deg(recorded_difference(recording))
        is_walk = name.startswith("walking")
        rows.append(
            at_most(figure, largest, "deg", LIMITS["walking"]) if is_walk else informative(figure, largest, "deg")
        )
    return rows


def _costs() -> dict[str, Cost]:
    samples = synthetic(motions()["cycling"], 0)
    return {
        "compiled, one leg": compiled_cost(samples, 1, LITERAL),
        f"compiled, {LEGS} legs side by side": compiled_cost(samples, LEGS, LITERAL),
        "interpreted, one leg": plain_cost(samples, LITERAL),
    }


def cost_rows(costs: dict[str, Cost]) -> list[Row]:
    """Run time of the conventional filter over that of the simplified one; the published factor is asked of each."""
    rows = [
        at_least(f"table 1: conventional over simplified, {form}", cost.ratio, "x", 2.0) for form, cost in costs.items()
    ]
    counts = operations(LITERAL)
    total = {name: sum(count for what, count in done.items() if what != "compare") for name, done in counts.items()}
    ratio = total["conventional"] / total["simplified"]
    return [*rows, at_least("table 1: conventional over simplified, arithmetic operations", ratio, "x", 2.0)]


def table_1(costs: dict[str, Cost]) -> Table:
    """Table 1 with its unit, both filters of a knee together."""
    counts = operations(LITERAL)
    header = ("", "conventional", "simplified", "conventional over simplified")
    lines = [
        ["states of a filter (paper: 2, 1)", "2", "1", "2.00"],
        ["numbers kept, thigh and knee", str(2 * TWO_STATES), str(2 * ONE_STATE + 2),
         number(2 * TWO_STATES / (2 * ONE_STATE + 2))],
        ["numbers kept while the biases are learned", str(2 * TWO_STATES), str(2 * LITERAL.debias_samples), "-"],
    ]  # fmt: skip
    for what, title in (("add", "additions"), ("multiply", "multiplications"), ("divide", "divisions")):
        two, one = counts["conventional"][what], counts["simplified"][what]
        lines.append([f"{title} in a sample", str(two), str(one), number(two / one)])
    for form, cost in costs.items():
        lines.append([f"{form}: time of a sample, ns (paper: 2X, 1X)", number(1e9 * cost.conventional_s),
                      number(1e9 * cost.simplified_s), number(cost.ratio)])  # fmt: skip
    alone = costs["compiled, one leg"]
    lines.append(["learning both biases by Fourier transform, once, us", "0", number(1e6 * alone.learning_s), "-"])
    lines.append([f"compiled, one leg: a session of {SESSION_S:g} s with its learning", "", "",
                  number(over_a_session(alone, LITERAL))])  # fmt: skip
    return Table("Table 1: both models on one processor in the same run", header, lines)


def error_table(shown: dict[str, Traces]) -> Table:
    """RMSE against the truth after the simplified filter has begun, and ours from the first second on."""
    lines = []
    begun = slice(LITERAL.debias_samples + int(LITERAL.rate_hz), None)
    for name, found in shown.items():
        figures = [
            _rmse(getattr(found, method)[begun] - found.truth[begun])
            for method in ("conventional", "simplified", "ours")
        ]
        early = slice(int(LITERAL.rate_hz), LITERAL.debias_samples)
        figures += [_rmse(getattr(found, method)[early] - found.truth[early]) for method in ("conventional", "ours")]
        lines.append([name, *map(number, figures)])
    header = ("", "conventional", "simplified", "ours", "conventional, 1 to 50 s", "ours, 1 to 50 s")
    return Table("RMSE against the truth, deg, from 51 s on unless said otherwise", header, lines)


def bias_table() -> Table:
    """Figure 5 in numbers."""
    curves = bias_curves()
    lines = [
        [str(window), *(f"{_deg(float(curve[k])):.3f}" for curve in curves.values())]
        for k, window in enumerate(WINDOWS)
    ]
    return Table("Figure 5: bias of the thigh, deg/s, by window (truth 0.83)", ("samples", *curves), lines)


def _rmse(error: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    return _deg(float(np.sqrt(np.mean(np.angle(np.exp(1j * error)) ** 2))))


def _deg(angle: float) -> float:
    return float(np.degrees(angle))
