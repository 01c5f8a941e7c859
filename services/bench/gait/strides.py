"""Scoreboard of the strides: reviewed contacts of a recorded walk, a stroke survivor's treadmill, synthetic walks.

Everything passes the whole chain, sensors to strides. The baseline is the plain EKF in the place of the default.
"""

from collections.abc import Set
from pathlib import Path
from typing import NamedTuple

import numpy as np

from schemas.gait import GaitEvent, Stride
from schemas.imu import ReferenceBatch
from schemas.vocabulary import GaitEventKind, Segment, Side
from services.bench.gait.stride_scores import Found, Matched, Truth, length_errors, match, together
from services.bench.gait.worn import wearing, worn_only
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.cli.assembly import build_chain
from services.ingest.errors import SourceError
from services.ingest.source import iter_messages, open_source

NEURA = "neura_s02_walk"
STROKE = "moving_reality_pp11"
STROKE_SWINGS = {Side.LEFT: 113, Side.RIGHT: 112}
"""Peaks of the sagittal shank rate above 1.2 rad/s in the recording, which has no other truth."""
ESTIMATOR, BASELINE = "rhythmic_ekf", "ekf"
WALKS = {
    "slow": "speed=0.5&seed=11&duration=40",
    "usual": "speed=1.1&seed=12&duration=40",
    "fast": "speed=1.5&seed=13&duration=40",
    "lame": "speed=0.8&seed=14&duration=40&asymmetry=0.4",
    "turns and stops": "speed=1.0&seed=15&duration=60&turn_every=9&stop_every=20",
}
SPEED_TARGET = 0.05  # m/s, mean absolute error
CADENCE_TARGET = 0.02
IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF


class Run(NamedTuple):
    """A session through the chain."""

    found: Found
    truth: Truth


def through_chain(spec: str, estimator: str, worn: Set[Segment] = frozenset(Segment)) -> Run:
    """Run a source to its end, as if only these segments had a sensor. Raises SourceError when it cannot be read."""
    source = open_source(spec, estimator=estimator)
    description = source.describe()
    chain, found, truth = build_chain(wearing(description, worn)), Found(), Truth(description)
    for message in worn_only(iter_messages(source), description, worn):
        if isinstance(message.payload, ReferenceBatch):
            truth.take(message.payload)
        for produced in chain.push(message):
            if isinstance(produced.payload, GaitEvent):
                found.events.append(produced.payload)
            elif isinstance(produced.payload, Stride):
                found.strides.append(produced.payload)
    return Run(found, truth)


def run(json_path: Path | None = None, subject: str = "all") -> Scoreboard:
    """Score the strides of `neura`, of the `stroke` treadmill, of the `synthetic` walks, or of `all`."""
    recorded = {"neura": (NEURA, neura_rows), "stroke": (STROKE, stroke_rows)}
    if subject not in (*recorded, "synthetic", "all"):
        raise ValueError(f"no strides of {subject!r}: choose neura, stroke, synthetic or all")
    rows: list[Row] = []
    for title, (spec, rows_of) in recorded.items():
        if subject not in (title, "all"):
            continue
        try:
            rows += rows_of(through_chain(spec, ESTIMATOR), through_chain(spec, BASELINE))
        except SourceError as missing:
            rows.append(Row(f"{title}: skipped", None, "", str(missing), None, None))
    if subject in ("synthetic", "all"):
        for name, query in WALKS.items():
            spec = f"synthetic:walk?{query}"
            rows += synthetic_rows(name, through_chain(spec, ESTIMATOR), through_chain(spec, BASELINE))
    scoreboard = Scoreboard("strides", rows)
    if json_path is not None:
        scoreboard.write_json(json_path)
    return scoreboard


def neura_rows(default: Run, baseline: Run) -> list[Row]:
    """Counts against the reviewed contacts, times against two truths, lengths against the optical ankles.

    The reviewed channel is 1 while the foot rests flat: it rises about 0.3 s after initial contact and falls as
    early before toe-off, so only the spread of the difference judges the events. The optical ankles judge the bias
    that the estimate adds.
    """
    rows = []
    for side in Side:
        reviewed = len(default.truth.contact_edges_s(side, IC)) - 1
        value, base = (sum(s.side is side for s in run.found.strides) for run in (default, baseline))
        met = abs(value - reviewed) <= 1
        rows.append(Row(f"neura: strides {side}", value, "", f"{reviewed} +- 1", met, base))
    for kind in (IC, TO):
        for truth in ("optical ankles", "reviewed flat foot"):
            matches = [_against(run, kind, optical=truth == "optical ankles") for run in (default, baseline)]
            rows += _timing(f"neura: {_words(kind)} against {truth}", *matches)
        rows.append(_claimed(f"neura: {_words(kind)}", kind, default, baseline))
    return rows + _lengths("neura", default, baseline)


def stroke_rows(default: Run, baseline: Run) -> list[Row]:
    """Counts of both feet, from their shanks alone, and whether both see the same cadence."""
    rows = []
    for side, swings in STROKE_SWINGS.items():
        value, base = (sum(s.side is side for s in run.found.strides) for run in (default, baseline))
        rows.append(Row(f"stroke: strides {side}", value, "", f"{swings} +- 1", abs(value - swings) <= 1, base))
    apart, base_apart = (_cadence_difference(run.found) for run in (default, baseline))
    rows.append(at_most("stroke: median stride time, left and right apart", apart, "1", CADENCE_TARGET, base_apart))
    return rows


def _cadence_difference(found: Found) -> float:
    left, right = (float(np.median([s.stride_time_s for s in found.strides if s.side is side])) for side in Side)
    return round(abs(left - right) / (0.5 * (left + right)), 4)


def synthetic_rows(name: str, default: Run, baseline: Run) -> list[Row]:
    """Events missed and invented, times, lengths. A walk starts and ends with steps too small to be one."""
    rows = []
    for kind in (IC, TO):
        matches = [_against(run, kind, optical=False) for run in (default, baseline)]
        if kind is IC:
            value, base = (matched.missed + matched.extra for matched in matches)
            rows.append(informative(f"synthetic {name}: contacts missed or invented", value, "", base))
        rows += _timing(f"synthetic {name}: {_words(kind)}", *matches)
        rows.append(_claimed(f"synthetic {name}: {_words(kind)}", kind, default, baseline))
    return rows + _lengths(f"synthetic {name}", default, baseline)


def _against(run: Run, kind: GaitEventKind, *, optical: bool) -> Matched:
    true_s = run.truth.ankle_turns_s if optical else run.truth.contact_edges_s
    return together(match(true_s(side, kind), run.found.times_s(side, kind)) for side in Side)


def _words(kind: GaitEventKind) -> str:
    return kind.value.replace("_", " ")


def _timing(name: str, matched: Matched, baseline: Matched) -> list[Row]:
    bias, spread = f"{name}, bias of {len(matched.errors_s)}", f"{name}, SD"
    return [
        informative(bias, matched.bias_ms, "ms", baseline.bias_ms),
        informative(spread, matched.spread_ms, "ms", baseline.spread_ms),
    ]


def _claimed(name: str, kind: GaitEventKind, default: Run, baseline: Run) -> Row:
    value, base = (run.found.claimed_ms(kind) for run in (default, baseline))
    return informative(f"{name}, SD that the events claim", value, "ms", base)


def _lengths(name: str, default: Run, baseline: Run) -> list[Row]:
    (length, speed), (base_length, base_speed) = (length_errors(*run) for run in (default, baseline))
    if not len(length) or not len(base_length):
        return [Row(f"{name}: stride length", None, "m", "no straight stride with a length", None, None)]
    mean, base_mean = (round(float(np.mean(errors)), 3) for errors in (length, base_length))
    error, base = (round(float(np.mean(np.abs(errors))), 3) for errors in (speed, base_speed))
    return [
        informative(f"{name}: stride length, mean error of {len(length)}", mean, "m", base_mean),
        at_most(f"{name}: walking speed, mean absolute error", error, "m/s", SPEED_TARGET, base),
    ]
