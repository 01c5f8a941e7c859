"""Scoreboard of the strides: reviewed contacts of a recorded walk, and the truth of synthetic walks.

Everything passes the whole chain, sensors to strides. The baseline is the plain EKF in the place of the default.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from schemas.gait import GaitEvent, Stride
from schemas.imu import ReferenceBatch
from schemas.vocabulary import GaitEventKind, Side
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.bench.stride_scores import Found, Matched, Truth, length_errors, match, together
from services.cli.assembly import build_chain
from services.ingest.errors import SourceError
from services.ingest.source import iter_messages, open_source

NEURA = "neura_s02_walk"
ESTIMATOR, BASELINE = "rhythmic_ekf", "ekf"
WALKS = {
    "slow": "speed=0.5&seed=11&duration=40",
    "usual": "speed=1.1&seed=12&duration=40",
    "fast": "speed=1.5&seed=13&duration=40",
    "lame": "speed=0.8&seed=14&duration=40&asymmetry=0.4",
    "turns and stops": "speed=1.0&seed=15&duration=60&turn_every=9&stop_every=20",
}
SPEED_TARGET = 0.05  # m/s, mean absolute error
IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF


class Run(NamedTuple):
    """A session through the chain."""

    found: Found
    truth: Truth


def through_chain(spec: str, estimator: str) -> Run:
    """Run a source to its end. Raises SourceError when it cannot be read."""
    source = open_source(spec, estimator=estimator)
    description = source.describe()
    chain, found, truth = build_chain(description), Found(), Truth(description)
    for message in iter_messages(source):
        if isinstance(message.payload, ReferenceBatch):
            truth.take(message.payload)
        for produced in chain.push(message):
            if isinstance(produced.payload, GaitEvent):
                found.events.append(produced.payload)
            elif isinstance(produced.payload, Stride):
                found.strides.append(produced.payload)
    return Run(found, truth)


def run(json_path: Path | None = None, subject: str = "all") -> Scoreboard:
    """Score the strides of `neura`, of the `synthetic` walks, or of `all`."""
    if subject not in ("neura", "synthetic", "all"):
        raise ValueError(f"no strides of {subject!r}: choose neura, synthetic or all")
    rows: list[Row] = []
    if subject != "synthetic":
        try:
            rows += neura_rows(through_chain(NEURA, ESTIMATOR), through_chain(NEURA, BASELINE))
        except SourceError as missing:
            rows.append(Row("neura: skipped", None, "", str(missing), None, None))
    if subject != "neura":
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
    return rows + _lengths("neura", default, baseline)


def synthetic_rows(name: str, default: Run, baseline: Run) -> list[Row]:
    """Events missed and invented, times, lengths. A walk starts and ends with steps too small to be one."""
    rows = []
    for kind in (IC, TO):
        matches = [_against(run, kind, optical=False) for run in (default, baseline)]
        if kind is IC:
            value, base = (matched.missed + matched.extra for matched in matches)
            rows.append(informative(f"synthetic {name}: contacts missed or invented", value, "", base))
        rows += _timing(f"synthetic {name}: {_words(kind)}", *matches)
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
