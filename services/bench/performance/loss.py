"""Scoreboard of lost samples: bursts on the radio, each sensor off for two seconds, and everything off.

The baseline is the plain EKF, which knows no rhythm: joints of a silent sensor are drawn to zero there.
"""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.progress import Progress

from services.bench.performance.disturbed import (
    FLEXIONS,
    Estimated,
    Walk,
    estimate,
    recorded_walk,
    synthetic_walk,
)
from services.bench.performance.loss_scores import Errors, errors_of, recovery_s
from services.bench.performance.lossy_strides import stride_rows
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.biomech.rotations import angle_between, matrix_from_quaternion
from services.faults.faults import HubGap, SampleFault, SensorOff, radio_loss
from services.ingest.errors import SourceError

ESTIMATOR, BASELINE = "rhythmic_ekf", "ekf"
SYNTHETIC = (
    "speed=1.1&seed=201&duration=25",
    "speed=1.4&seed=202&duration=25&soft_tissue=0.05",
    "speed=0.8&seed=203&duration=25&rate=50",
    "speed=1.2&seed=204&duration=25&rate=50&asymmetry=0.2",
)
RECORDED, RECORDED_WALKING_S = "neura_s02_walk", (11.19, 20.73)
SHARES = {0.05: 1.0, 0.2: 3.0}
"""Share of the samples that are lost, and by how many deg the error may grow."""
SEEDS = (1, 2)
OFF_S = 2.0
OFF_FROM_S = 13.0
RECORDED_OFF_FROM_S = 16.8
MOST_RECOVERY_S = 1.0
ALL = "all sensors"
NOTE = """RMSE of knee and hip flexion against the truth, minus that of the undisturbed run; baseline: the plain EKF.
Synthetic: four walks of 25 s, 50 and 100 Hz, two loss seeds each, from the first step on; the stand-ins were chosen on
seeds 103 to 106. Bursts as in services/faults/bursts.py. A sensor is off from 13 to 15 s, while the rhythm is locked.
Before the lock (the first three strides) nothing is known of a silent joint. neura has 6 strides and a turn: a sensor
is off from 16.8 to 18.8 s, right after the turn, and what was learned are two straight strides and the turn. Its walk
ends 1.9 s later, so 1.44 s means not recovered by then.
Recovered: the RMSE of every half second from then on is within 1 deg of the undisturbed run's."""


class Outage(NamedTuple):
    """A joint around the two seconds in which a sensor was off."""

    sensor: str
    affected: bool  # the joint was not valid all the time
    during: Errors
    after: Errors
    recovery_s: float


class Case(NamedTuple):
    """Everything that one estimator made of one walk."""

    losses: dict[float, list[Errors]]
    locked_losses: dict[float, list[Errors]]  # from the rhythm's first lock on
    turned_deg: dict[float, float]  # largest change of a sensor's alignment
    outages: list[Outage]


def run(json_path: Path | None = None, subject: str = "all") -> Scoreboard:
    """Score `synthetic` walks, the recorded `neura` walk, what becomes of `strides`, or `all`."""
    if subject not in ("synthetic", "neura", "strides", "all"):
        raise ValueError(f"no losses on {subject!r}: choose synthetic, neura, strides or all")
    rows: list[Row] = []
    with Progress(transient=True) as progress:
        if subject in ("synthetic", "all"):
            walks = [synthetic_walk(query) for query in progress.track(SYNTHETIC, description="walks")]
            rows += walk_rows("synthetic", walks, OFF_FROM_S, progress)
        if subject in ("neura", "all"):
            try:
                walk = recorded_walk(RECORDED, RECORDED_WALKING_S)
            except SourceError as missing:
                rows.append(Row("neura: skipped", None, "", str(missing), None, None))
            else:
                rows += walk_rows("neura", [walk], RECORDED_OFF_FROM_S, progress)
        if subject in ("strides", "all"):
            rows += stride_rows(progress)
    board = Scoreboard("loss", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board


def walk_rows(name: str, walks: Sequence[Walk], off_s: float, progress: Progress) -> list[Row]:
    """All figures of some walks, both estimators side by side. Targets hold for walks whose truth is perfect."""
    jobs = [(estimator, walk) for estimator in (ESTIMATOR, BASELINE) for walk in walks]
    cases: dict[str, list[Case]] = {ESTIMATOR: [], BASELINE: []}
    for estimator, walk in progress.track(jobs, description=name):
        cases[estimator].append(disturb_walk(walk, estimator, off_s))
    ours, plain = cases[ESTIMATOR], cases[BASELINE]
    rows = [row for share in SHARES for row in loss_rows(name, share, ours, plain)]
    for sensor in dict.fromkeys(outage.sensor for case in ours for outage in case.outages):
        rows += outage_rows(f"{name}, {sensor} off", *([_of(c, sensor) for c in side] for side in (ours, plain)))
    return rows


def _of(case: Case, sensor: str) -> list[Outage]:
    return [outage for outage in case.outages if outage.sensor == sensor]


def disturb_walk(walk: Walk, estimator: str, off_s: float) -> Case:
    """One estimator on one walk: undisturbed, with losses, and with each sensor off."""
    clean = estimate(walk, estimator)
    losses: dict[float, list[Errors]] = {}
    locked: dict[float, list[Errors]] = {}
    turned: dict[float, float] = {}
    for share in SHARES:
        runs = [estimate(walk, estimator, radio_loss(walk.sensors, share, seed)) for seed in SEEDS]
        losses[share] = [errors_of(walk, clean, lossy, joint) for lossy in runs for joint in FLEXIONS]
        from_s = [lossy.locked_from_s for lossy in runs for _ in FLEXIONS]
        locked[share] = [errors.within(s, math.inf) for errors, s in zip(losses[share], from_s, strict=True)]
        turned[share] = max(alignment_change_deg(clean, lossy) for lossy in runs)
    outages = []
    faults: list[tuple[str, SampleFault]] = [
        (str(sensor.segment), SensorOff(sensor.name, off_s, off_s + OFF_S))
        for sensor in walk.description.hubs[0].sensors
    ]
    for label, fault in [*faults, (ALL, HubGap(off_s, off_s + OFF_S))]:
        outages += outages_of(walk, clean, estimate(walk, estimator, [fault]), label, off_s)
    return Case(losses, locked, turned, outages)


def outages_of(walk: Walk, clean: Estimated, disturbed: Estimated, label: str, off_s: float) -> list[Outage]:
    """Every joint around one outage."""
    back_s, found = off_s + OFF_S, []
    for joint in FLEXIONS:
        errors = errors_of(walk, clean, disturbed, joint)
        during, after = errors.within(off_s, back_s), errors.within(back_s, back_s + OFF_S)
        found.append(Outage(label, not during.valid.all() or label == ALL, during, after, recovery_s(errors, back_s)))
    return found


def alignment_change_deg(clean: Estimated, lossy: Estimated) -> float:
    """Largest angle by which the flexion axis of a sensor differs between two calibrations."""
    axes = [
        {s.sensor: matrix_from_quaternion(np.array(s.quat_segment_from_sensor))[2] for s in run.calibration.sensors}
        for run in (clean, lossy)
    ]
    return float(np.degrees(max(angle_between(axis, axes[1][sensor]) for sensor, axis in axes[0].items())))


def loss_rows(name: str, share: float, ours: Sequence[Case], plain: Sequence[Case]) -> list[Row]:
    """What bursts add to the error: mean and worst of joints, walks and seeds."""
    title = f"{name}, {share:.0%} lost"
    (mean, worst), (base_mean, base_worst) = (_growths(_all_losses(side, share)) for side in (ours, plain))
    late, base_late = (_growths([e for case in side for e in case.locked_losses[share]]) for side in (ours, plain))
    shown, base_shown = (
        _growths([errors.where_valid() for errors in _all_losses(side, share)]) for side in (ours, plain)
    )
    turned, base_turned = (max(case.turned_deg[share] for case in side) for side in (ours, plain))
    valid, base_valid = (
        float(np.mean([errors.valid.mean() for errors in _all_losses(side, share)])) for side in (ours, plain)
    )
    return [
        at_most(f"{title}: RMSE growth, mean", mean, "deg", SHARES[share], base_mean),
        at_most(f"{title}: RMSE growth, worst joint", worst, "deg", SHARES[share], base_worst),
        at_most(f"{title}: RMSE growth where valid, worst joint", shown[1], "deg", SHARES[share], base_shown[1]),
        at_most(f"{title}: RMSE growth from the lock on, worst joint", late[1], "deg", SHARES[share], base_late[1]),
        informative(f"{title}: valid", valid, "1", base_valid),
        informative(f"{title}: change of a flexion axis, largest", turned, "deg", base_turned),
    ]


def _all_losses(cases: Iterable[Case], share: float) -> list[Errors]:
    return [errors for case in cases for errors in case.losses[share]]


def _growths(errors: Sequence[Errors]) -> tuple[float, float]:
    values = [each.growth for each in errors]
    return float(np.nanmean(values)), float(np.nanmax(values))


def outage_rows(title: str, ours: Sequence[list[Outage]], plain: Sequence[list[Outage]]) -> list[Row]:
    """Two seconds without a sensor: its joints, which are not valid then, and all others."""
    own, base = (_figures([o for case in side for o in case if o.affected]) for side in (ours, plain))
    rest, base_rest = (_figures([o for case in side for o in case if not o.affected]) for side in (ours, plain))
    rows = []
    if own and base and np.isfinite(own["during, worst"]):
        rows += [
            informative(f"{title}: its joints, growth during, mean", own["during"], "deg", base["during"]),
            informative(
                f"{title}: its joints, growth during, worst", own["during, worst"], "deg", base["during, worst"]
            ),
            informative(f"{title}: its joints, within two deviations", own["claimed"], "1", base["claimed"]),
        ]
    if rest and base_rest:
        rows.append(
            at_most(
                f"{title}: other joints, growth during", rest["during, worst"], "deg", 1.0, base_rest["during, worst"]
            )
        )
    if own and base:
        rows += [
            informative(f"{title}: growth in the 2 s after, worst", own["after, worst"], "deg", base["after, worst"]),
            informative(f"{title}: recovery, mean", own["recovery"], "s", base["recovery"]),
            at_most(f"{title}: recovery, worst", own["recovery, worst"], "s", MOST_RECOVERY_S, base["recovery, worst"]),
        ]
    return rows


def _figures(outages: Sequence[Outage]) -> dict[str, float]:
    """Means and worst cases; empty of nothing."""
    if not outages:
        return {}
    columns = {
        "during": [outage.during.growth for outage in outages],
        "after": [outage.after.growth for outage in outages],
        "recovery": [outage.recovery_s for outage in outages],
        "claimed": [outage.during.claimed for outage in outages],
    }
    figures = {name: float(np.mean(values)) for name, values in columns.items()}
    return figures | {f"{name}, worst": float(np.max(values)) for name, values in columns.items()}
