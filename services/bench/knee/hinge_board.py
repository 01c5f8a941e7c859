"""The mechanical hinge: angle, agreement, peers and cost."""

import time
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from services.bench.knee.comparison import OURS, Judged, judge, judge_peers
from services.bench.knee.comparison_tables import agreement_table, cost_table, per_trial_table, trial_charts
from services.bench.knee.recordings import KneeRecording, clock_lag, weygers
from services.bench.knee.scores import FROM_SENSORS, STD, VALID, KneeScore, run_knee, score
from services.bench.report import Section
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

TARGETS = {"01": 3.0, "02": 1.0, "05": 1.2}
"""deg, absolute."""
FIRST_S = 2.0
"""s at the start that are not scored: the libraries settle, ours has not yet moved."""
HINGE = replace(KneeAxisParameters(), sign_evidence=0.0)
"""A bare hinge has no front: its sense is taken as it comes."""
PARAGRAPHS = [
    "Hinge moved by hand, 50 Hz. Our parameters, sample_delay among them, were chosen on trial 02 (and on synthetic "
    "legs, one on landings and steps, too); 01 and 05 were not. Ours is causal from the first sample and scored where "
    "it is valid; the others see the whole recording before they say their axis. Absolute errors are in McGrath's "
    "datum (eq. 2), so each method's axis error is in it.",
    "Trial 01: the markers of one body are taken for others in 5 frames, which alone costs any estimate 3.1 deg; its "
    "optics and its sensors drift apart by a third of a sample in a minute. Rows give zero shift and the best constant "
    "shift in quarter samples, the tables the best shift where the truth is intact.",
]


def hinge_section(progress: Progress) -> Section:
    """All rows, tables and charts. Raises MissingFile without the data."""
    rows: list[Row] = []
    trials: dict[str, list[Judged]] = {}
    absent: list[str] = []
    rates_hz = {}
    for trial, target in progress.track(TARGETS.items(), description="hinge"):
        recording = weygers(trial)
        rows += _angle_rows(recording, target) + _clock_rows(recording)
        peers, absent = judge_peers(recording, _asked(recording) & recording.holds, absolute=True)
        trials[recording.name] = [_ours(recording), *peers]
        rates_hz[recording.name] = recording.rate_hz
        rows += _peer_rows(recording.name, peers)
    rows += [Row(f"weygers: {reason}", None, "", None, None, None) for reason in absent]
    rows += cost_rows(weygers("05"))
    tables = [per_trial_table(trials), agreement_table(trials), cost_table(trials)]
    return Section("Mechanical hinge", PARAGRAPHS, rows, tables, trial_charts(trials, rates_hz))


def _asked(recording: KneeRecording) -> Mask:
    return np.arange(len(recording.flexion)) >= FIRST_S * recording.rate_hz


def _ours(recording: KneeRecording) -> Judged:
    out, estimator = run_knee(recording, HINGE)
    angle = _sense(estimator.axes, recording) * out[:, FROM_SENSORS]
    return judge(OURS, angle, recording, _asked(recording) & recording.holds, out[:, VALID] > 0, absolute=True)


def _angle_rows(recording: KneeRecording, target: float) -> list[Row]:
    out, estimator = run_knee(recording, HINGE)
    sense = _sense(estimator.axes, recording)
    rows = []
    everywhere, believed = _asked(recording), _asked(recording) & recording.holds
    scored = {"": everywhere} if recording.holds.all() else {", all frames": everywhere, ", truth intact": believed}
    for title, asked in scored.items():
        s = score(sense * out[:, FROM_SENSORS], recording.flexion, asked, out[:, VALID] > 0, out[:, STD], absolute=True)
        name = f"{recording.name}{title}: flexion, absolute"
        rows.append(at_most(f"{name}, shift 0", _deg(s.unshifted.absolute_rmse), "deg", target))
        rows.append(at_most(f"{name}, best shift", _deg(s.shifted.absolute_rmse), "deg", target))
        rows += _score_details(f"{recording.name}{title}", s)
    if not recording.holds.all():
        rows.append(informative(f"{recording.name}: error of the truth itself", _truth_error(recording), "deg"))
    return rows


def _score_details(name: str, s: KneeScore) -> list[Row]:
    return [
        informative(f"{name}: offset-removed, shift 0", _deg(s.unshifted.zero_mean_rmse), "deg", detail=True),
        informative(f"{name}: best shift", s.shift, "samples", detail=True),
        informative(f"{name}: share of samples with a valid angle", s.coverage, "", detail=True),
        informative(f"{name}: errors within two claimed deviations", s.within_two_std, "", detail=True),
    ]


def _truth_error(recording: KneeRecording) -> float:
    """RMS, deg, by which the truth leaves its own interpolation where its markers were taken for others."""
    frames, holds = np.arange(len(recording.flexion)), recording.holds
    smooth = np.interp(frames, frames[holds], np.unwrap(recording.flexion[holds]))
    error = np.angle(np.exp(1j * (recording.flexion - smooth)))[_asked(recording)]
    return _deg(float(np.sqrt(np.mean(error**2))))


def _clock_rows(recording: KneeRecording) -> list[Row]:
    lags, title = clock_lag(recording, 4), f"{recording.name}: sensors later than optics"
    quarters = {"first": lags[0], "last": lags[-1]}
    return [
        informative(f"{title}, {which} quarter", float(lag), "samples", detail=True) for which, lag in quarters.items()
    ]


def _peer_rows(trial: str, peers: list[Judged]) -> list[Row]:
    rows: list[Row] = []
    for one in peers:
        name, s = f"{trial}: {one.method}: flexion, absolute", one.score
        rows.append(informative(f"{name}, shift 0", _deg(s.unshifted.absolute_rmse), "deg", detail=True))
        rows.append(informative(f"{name}, best shift", _deg(s.shifted.absolute_rmse), "deg"))
        rows.append(informative(f"{trial}: {one.method}: cost", one.cost_us, "us/sample", detail=True))
    return rows


def cost_rows(recording: KneeRecording, repeats: int = 12) -> list[Row]:
    """Processor time of a sample, whole recordings at once and sample by sample."""
    dt_s, n = 1.0 / recording.rate_hz, len(recording.rate)
    rate, force = np.ascontiguousarray(recording.rate), np.ascontiguousarray(recording.force)
    KneeAxis(HINGE).run(rate[:50], force[:50], dt_s)
    batch, single = [], []
    for _ in range(repeats):
        estimator = KneeAxis(HINGE)
        begin = time.thread_time()
        estimator.run(rate, force, dt_s)
        batch.append((time.thread_time() - begin) / n)
        begin = time.thread_time()
        for k in range(2000):
            estimator.step(rate[k], force[k], dt_s)
        single.append((time.thread_time() - begin) / 2000)
    return [
        at_most("cost of a sample in batch", 1e6 * min(batch), "us", 1.0),
        at_most("cost of a sample online", 1e6 * min(single), "us", 10.0),
    ]


def _sense(axes: Array, recording: KneeRecording) -> float:
    assert recording.axes is not None
    return float(np.sign(np.sum(axes * recording.axes)))


def _deg(angle: float) -> float:
    return float(np.degrees(angle))
