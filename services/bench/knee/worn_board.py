"""Sensors on people: drop landings, sit-to-stand, walking."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress

from schemas.vocabulary import Side
from services.bench.knee.comparison import OURS, Judged, judge, judge_peers
from services.bench.knee.comparison_tables import agreement_table, cost_table, per_trial_table, trial_charts
from services.bench.knee.recordings import KneeRecording, from_manifest
from services.bench.knee.scores import FLEXION, STD, VALID, KneeScore, Pass, run_knee, score
from services.bench.report import Section
from services.bench.scoreboard import Row, at_most, informative
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

PARAMETERS = KneeAxisParameters()
END_S = 20.0
"""s at either end whose mean errors are compared for drift."""
FAN, ALBORNO = "fan_knee_drop_landing_left", "alborno_sub03_sts1"
NEURA = {"neura": "neura_s02_walk", "neura mid-shank": "neura_s02_walk_midshank"}
NEURA_TARGETS = {"straight": 3.0, "with turn": 3.5}
SCORED_ALBORNO = (616, 1550)
STRAIGHT, WITH_TURN = np.r_[1119:1454, 1651:2073], np.r_[1119:2073]
"""Frames of the walk's two straight passes, and of the whole walk with its turn of half a circle."""
SEEN = (
    "Cold: this is the first motion seen; the axis is believed after some of it and only that share is scored. Second "
    "pass: the same samples taken once more with what was found in them (axis, arms, biases, sense). Warm: the same "
    "sensors were seen in the same motion before."
)
PEERS = (
    "The table compares methods at the best constant shift, offset and all: 'McGrath' has the orientations of the "
    "sensors' maker, magnetometer included, as published; '+ hinge' is an orientation filter with the axis by "
    "principal components and the heading by the hinge, begun with the maker's. They have the whole "
    "recording for their axis, and all get the sense that agrees with the truth."
)
PARAGRAPHS = {
    "fan": [
        "Drop landings, 100 Hz, 67 s. First and last 20 s of valid angle are compared for drift. The laboratory's knee "
        "is 10 deg while standing. How much the force of the instant levels (0.1 to 0.2 per second are alike) was "
        "chosen with these errors, weygers 02 and single steps; gates of tie, sign and slip were set with it in view. "
        f"{SEEN}", PEERS,
    ],
    "alborno": [
        "Sit-to-stand, 40 Hz, thigh and shank of the left leg; repetitions from 15.4 s on. Nothing was chosen by these "
        f"errors; the gates of the first tie were set with it in view. {SEEN}", PEERS,
    ],
    "neura": [
        "Thigh and lower shank, 100 Hz, one walk of 9.5 s; truth Plug-in-Gait, which differs by 4.2 deg on the left "
        "from the knee of joint centres. Nothing was chosen by it, though its errors were in view; `limits` says what "
        f"they are made of. {SEEN}", PEERS,
    ],
}  # fmt: skip


class Window(NamedTuple):
    """Samples that are scored."""

    name: str
    frames: NDArray[np.int64]


def fan_section(progress: Progress) -> Section:
    """Drop landings. Raises MissingFile without the data."""
    recording = from_manifest(FAN, Side.LEFT)
    window = Window("whole", np.arange(100, len(recording.flexion) - 3))
    rows = []
    for seen in progress.track(Pass, description="fan"):
        out, _ = run_knee(recording, PARAMETERS, seen)
        s = _score(recording, out, window)
        title = f"fan, {seen}"
        rows += _targets(title, s, 0.9)
        rows.append(at_most(f"{title}: last 20 s against first", _drift(recording, out), "deg", 1.0))
        rows += _details(title, s, recording, out)
    return _section("fan", "Drop landings", rows, {"fan": (recording, window)}, progress)


def alborno_section(progress: Progress) -> Section:
    """Sit-to-stand. Raises MissingFile without the data."""
    recording = from_manifest(ALBORNO, Side.LEFT)
    window = Window("repetitions", np.arange(*SCORED_ALBORNO))
    rows = []
    for seen in progress.track(Pass, description="alborno"):
        out, _ = run_knee(recording, PARAMETERS, seen)
        s = _score(recording, out, window)
        rows += _targets(f"alborno, {seen}", s, 1.5) + _details(f"alborno, {seen}", s, recording, out)
    return _section("alborno", "Sit-to-stand", rows, {"alborno": (recording, window)}, progress)


def neura_section(progress: Progress) -> Section:
    """Walking with a turn. Raises MissingFile without the data."""
    rows: list[Row] = []
    trials: dict[str, tuple[KneeRecording, Window]] = {}
    for place, spec in progress.track(NEURA.items(), description="neura"):
        knees = {side: from_manifest(spec, side) for side in Side}
        for seen in Pass:
            outs = {side: run_knee(knee, PARAMETERS, seen)[0] for side, knee in knees.items()}
            for window in (Window("straight", STRAIGHT), Window("with turn", WITH_TURN)):
                rows += list(_walk_rows(f"{place}, {seen}, {window.name}", place == "neura", window, knees, outs))
        trials |= {f"{place} {side}": (knee, Window("with turn", WITH_TURN)) for side, knee in knees.items()}
    return _section("neura", "Walking with a turn", rows, trials, progress)


def _walk_rows(
    title: str, has_target: bool, window: Window, knees: dict[Side, KneeRecording], outs: dict[Side, Array]
) -> Iterator[Row]:
    scores = {side: _score(knees[side], outs[side], window) for side in Side}
    mean = float(np.mean([_deg(s.shifted.zero_mean_rmse) for s in scores.values()]))
    figure = f"{title}: offset-removed, mean of both sides"
    yield at_most(figure, mean, "deg", NEURA_TARGETS[window.name]) if has_target else informative(figure, mean, "deg")
    for side, s in scores.items():
        yield informative(f"{title}, {side}: offset-removed", _deg(s.shifted.zero_mean_rmse), "deg")
        yield from _details(f"{title}, {side}", s, knees[side], outs[side])


def _section(
    subject: str, title: str, rows: list[Row], trials: dict[str, tuple[KneeRecording, Window]], progress: Progress
) -> Section:
    """With the comparison of all methods. Ours is the second pass, which like the others has seen all samples."""
    judged: dict[str, list[Judged]] = {}
    absent: list[str] = []
    for name, (recording, window) in progress.track(trials.items(), description=f"{subject}: other methods"):
        asked = _asked(recording, window)
        peers, absent = judge_peers(recording, asked)
        judged[name] = [*_ours(recording, asked), *peers]
        rows += [
            informative(f"{name}: {one.method}: offset-removed, best shift", one.errors.zero_mean_rmse, "deg")
            for one in peers
        ]
    rows += [Row(f"{subject}: {reason}", None, "", None, None, None) for reason in absent]
    rates_hz = {name: recording.rate_hz for name, (recording, _) in trials.items()}
    tables = [per_trial_table(judged), agreement_table(judged), cost_table(judged)]
    return Section(title, PARAGRAPHS[subject], rows, tables, trial_charts(judged, rates_hz))


def _ours(recording: KneeRecording, asked: Mask) -> list[Judged]:
    outs = {name: run_knee(recording, PARAMETERS, seen)[0]
            for name, seen in ((OURS, Pass.SECOND), (f"{OURS}, cold", Pass.COLD))}  # fmt: skip
    return [
        judge(name, out[:, FLEXION], recording, asked, out[:, VALID] > 0)
        for name, out in outs.items() if (asked & (out[:, VALID] > 0)).any()
    ]  # fmt: skip


def _targets(title: str, s: KneeScore, limit: float) -> list[Row]:
    return [
        at_most(f"{title}: offset-removed, shift 0", _deg(s.unshifted.zero_mean_rmse), "deg", limit),
        at_most(f"{title}: offset-removed, best shift", _deg(s.shifted.zero_mean_rmse), "deg", limit),
    ]


def _asked(recording: KneeRecording, window: Window) -> Mask:
    asked = np.zeros(len(recording.flexion), dtype=np.bool_)
    asked[window.frames] = recording.holds[window.frames]
    return asked


def _score(recording: KneeRecording, out: Array, window: Window) -> KneeScore:
    return score(out[:, FLEXION], recording.flexion, _asked(recording, window), out[:, VALID] > 0, out[:, STD])


def _details(title: str, s: KneeScore, recording: KneeRecording, out: Array) -> list[Row]:
    used = (out[:, VALID] > 0) & recording.holds
    agreement = judge(OURS, out[:, FLEXION], recording, recording.holds, used).agreement
    return [
        informative(f"{title}: absolute", _deg(s.shifted.absolute_rmse), "deg", detail=True),
        informative(f"{title}: share of samples with a valid angle", s.coverage, "", detail=True),
        informative(f"{title}: best shift", s.shift, "samples", detail=True),
        informative(f"{title}: errors within two claimed deviations", s.within_two_std, "", detail=True),
        informative(f"{title}: r squared, all valid samples", agreement.r_squared, "", detail=True),
        informative(f"{title}: lower limit of agreement", agreement.lower_limit, "deg", detail=True),
        informative(f"{title}: upper limit of agreement", agreement.upper_limit, "deg", detail=True),
    ]


def _drift(recording: KneeRecording, out: Array) -> float:
    """deg: mean error of the last 20 s that are valid, less that of the first."""
    used = np.flatnonzero((out[:, VALID] > 0) & recording.holds)
    error = np.degrees(out[used, FLEXION] - recording.flexion[used])
    span = int(END_S * recording.rate_hz)
    first, last = error[used < used[0] + span], error[used > used[-1] - span]
    return abs(float(np.mean(last) - np.mean(first)))


def _deg(angle: float) -> float:
    return float(np.degrees(angle))
