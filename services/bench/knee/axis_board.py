"""The axis: how soon it is found, how soon that is said, and principal components against Seel and Olsson."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rich.progress import Progress
from scipy.spatial.transform import Rotation

from services.bench.knee import peers
from services.bench.knee.hinge_board import HINGE, TARGETS
from services.bench.knee.legs import (
    Motion,
    Sensors,
    cycling,
    orientation,
    record,
    seated_flexion,
    sit_to_stand,
    walking,
)
from services.bench.knee.recordings import KneeRecording, weygers
from services.bench.knee.scores import AXIS_STD, axis_errors, axis_history, run_knee
from services.bench.knee.seel_axis import seel_axis
from services.bench.line_chart import line_chart
from services.bench.report import Section, Table, number
from services.bench.scoreboard import Row, informative
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.ingest.errors import MissingFile

Array = NDArray[np.float64]

NEAR = np.radians(5.0)
PREFIXES_S = (5.0, 10.0, 20.0, 40.0, np.inf)
FIRST_SEED, SEEDS = 81000, 6
ACTIVITIES: dict[str, Callable[[], Motion]] = {
    "walking": walking, "sit to stand": sit_to_stand, "cycling": cycling, "seated flexion": seated_flexion,
}  # fmt: skip
PARAGRAPHS = [
    "The larger error of both sensors' axes, as lines. Ours is causal. The others are shown the same samples from the "
    "start on: Seel and Schauer 2012 (own implementation), Olsson 2020 (qmt), principal components (McGrath eq. 1) on "
    "VQF, on VQF with headings tied by the hinge, and for legs on true orientations. Nothing ties the headings of "
    "plain VQF: the sensors of the hinge are mounted alike and do not need it, the synthetic legs, mounted anyhow, do.",
    f"Hinge: trials as in its own section. Synthetic legs: {SEEDS} seeds of each activity, 40 s, 100 Hz, standing or "
    "sitting still for 3 s first, any mounting, noise, bias and 2 deg of soft tissue; no parameter was chosen on these "
    "seeds.",
]


class Found(NamedTuple):
    """The axis of one recording."""

    times_s: Array
    error: Array  # rad, (k,), NaN before there is an axis
    claimed_std: Array  # rad, (k,)
    claimed_near_s: float | None  # when a deviation below 5 deg was first claimed
    by_prefix: dict[str, list[float]]  # rad, by method, for each of PREFIXES_S that the recording has


def axis_section(progress: Progress) -> Section:
    """All rows, tables and charts."""
    rows: list[Row] = []
    tables: list[Table] = []
    charts: dict[str, str] = {}
    for trial in progress.track(TARGETS, description="axis: hinge"):
        try:
            recording = weygers(trial)
        except MissingFile as error:
            rows.append(Row(f"weygers {trial}: axis", None, "deg", str(error), None, None))
            continue
        found = study(recording)
        rows += axis_rows(recording.name, [found])
        tables.append(prefix_table(recording.name, [found]))
        charts[f"axis_{recording.name.replace(' ', '_')}"] = convergence_chart(recording.name, found)
    for activity, motion in progress.track(ACTIVITIES.items(), description="axis: synthetic legs"):
        legs = [study(leg_recording(activity, motion(), FIRST_SEED + k)) for k in range(SEEDS)]
        rows += axis_rows(f"synthetic {activity}", legs)
        tables.append(prefix_table(f"synthetic {activity}, median of {SEEDS}", legs))
        charts[f"axis_synthetic_{activity.replace(' ', '_')}"] = convergence_chart(f"synthetic {activity}", legs[0])
    return Section("Flexion axis", PARAGRAPHS, rows, tables, charts)


def leg_recording(name: str, motion: Motion, seed: int) -> KneeRecording:
    """A synthetic leg with sensors mounted anyhow."""
    draw = np.random.default_rng(seed)
    sensors = Sensors(
        Rotation.random(2, rng=draw).as_matrix(), np.radians(draw.normal(0.0, 0.3, (2, 3))), rate_noise=0.003,
        force_noise=0.1, soft_tissue=np.radians(2.0),
    )  # fmt: skip
    leg = record(motion, 40.0, 100.0, sensors, seed)
    t = np.arange(1, len(leg.flexion) + 1) / 100.0
    thigh, shank = (orientation(motion, sensors, s, t).as_matrix() for s in range(2))
    holds = np.ones(len(t), dtype=np.bool_)
    return KneeRecording(name, 100.0, leg.rate, leg.force, leg.flexion, holds, leg.axes, (thigh, shank))


def study(recording: KneeRecording) -> Found:
    """Our axis over time, and all methods on the samples from the start on."""
    times, worst = axis_history(recording, HINGE)
    out, _ = run_knee(recording, HINGE)
    claimed = out[:, AXIS_STD]
    sure = np.flatnonzero((claimed > 0.0) & (claimed <= NEAR))
    frames = np.minimum(np.rint(times * recording.rate_hz).astype(int) - 1, len(claimed) - 1)
    by_prefix = {
        method: [_worst(find(part), recording) for part in _prefixes(recording)]
        for method, find in _methods(recording).items()
    }
    soon = float(sure[0]) / recording.rate_hz if len(sure) else None
    return Found(times, worst, np.where(claimed[frames] > 0.0, claimed[frames], np.nan), soon, by_prefix)


def axis_rows(name: str, found: Sequence[Found]) -> list[Row]:
    """Median error over time, times, and every method on the whole; medians over recordings."""
    errors = [float(np.nanmedian(one.error)) for one in found]
    near = [
        float(one.times_s[np.flatnonzero(one.error <= NEAR)[0]]) if (one.error <= NEAR).any() else np.inf
        for one in found
    ]
    claimed = [np.inf if one.claimed_near_s is None else one.claimed_near_s for one in found]
    rows = [
        informative(f"{name}: axis error, ours, median over time", _deg(float(np.median(errors))), "deg"),
        informative(f"{name}: axis within 5 deg, ours, after", _finite(float(np.median(near))), "s"),
        informative(f"{name}: axis claimed within 5 deg, ours, after", _finite(float(np.median(claimed))), "s"),
    ]
    for method in found[0].by_prefix:
        whole = float(np.median([one.by_prefix[method][-1] for one in found]))
        rows.append(informative(f"{name}: axis error, {method}, all samples", _deg(whole), "deg"))
    for method, library in (("PCA on VQF", "vqf"), ("Olsson", "qmt")):
        reason = peers.missing(library)
        if reason is not None:
            rows.append(Row(f"{name}: axis error, {method}", None, "deg", reason, None, None))
    return rows


def prefix_table(name: str, found: Sequence[Found]) -> Table:
    """Axis error by method and by how much of the recording was seen."""
    seen = [f"{t:g} s" if np.isfinite(t) else "all" for t in PREFIXES_S]
    lines = [
        [
            method,
            *(number(_deg(float(np.median([one.by_prefix[method][k] for one in found])))) for k in range(len(seen))),
        ]
        for method in found[0].by_prefix
    ]
    return Table(f"{name}: axis error, deg, from the first samples", ("method", *seen), lines)


def convergence_chart(name: str, found: Found) -> str:
    """Our axis over time beside what the others make of all samples."""
    lines = {
        "ours": _points(found.times_s, found.error),
        "ours, claimed deviation": _points(found.times_s, found.claimed_std),
    }
    levels = {f"{method}, all": _deg(values[-1]) for method, values in found.by_prefix.items() if method != "ours"}
    kept = {method: level for method, level in levels.items() if level < 30.0} | {"5 deg": 5.0}
    colours = {"ours": "#1f6fb2", "ours, claimed deviation": "#8fc1e8"}
    return line_chart(f"{name}: axis error", "time, s", "axis error, deg", lines, levels=kept, colours=colours)


def _methods(recording: KneeRecording) -> dict[str, Callable[[KneeRecording], Array]]:
    methods: dict[str, Callable[[KneeRecording], Array]] = {"ours": _ours, "Seel": lambda part: seel_axis(part.rate)}
    if recording.orientations is not None:
        methods["PCA, true orientations"] = lambda part: peers.mcgrath_as_measured(part).axes
    if peers.missing("vqf") is None:
        methods["PCA on VQF"] = lambda part: peers.mcgrath(part).axes
        methods["PCA on VQF + hinge"] = lambda part: peers.with_hinge(part, is_told=False).axes
    if peers.missing("qmt") is None:
        methods["Olsson (qmt)"] = peers.olsson_axis
    return methods


def _ours(part: KneeRecording) -> Array:
    estimator = KneeAxis(HINGE)
    estimator.run(part.rate, part.force, 1.0 / part.rate_hz)
    return estimator.axes


def _prefixes(recording: KneeRecording) -> list[KneeRecording]:
    parts = []
    for seconds in PREFIXES_S:
        n = int(min(seconds * recording.rate_hz, len(recording.rate)))
        turned = recording.orientations
        kept = None if turned is None else (turned[0][:n], turned[1][:n])
        parts.append(recording._replace(rate=recording.rate[:n], force=recording.force[:n], orientations=kept))
    return parts


def _worst(axes: Array, recording: KneeRecording) -> float:
    """rad; the senses of both axes by themselves stay open for methods that do not pair them."""
    assert recording.axes is not None
    if not np.any(axes):
        return float("nan")
    paired = axes * np.sign(np.sum(axes * recording.axes, axis=1))[:, None]
    return float(axis_errors(paired, recording.axes).max())


def _points(times: Array, angle: Array) -> list[tuple[float, float]]:
    kept = slice(None, None, max(1, len(times) // 400))
    return list(zip(times[kept].tolist(), np.degrees(angle[kept]).tolist(), strict=True))


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _deg(angle: float) -> float:
    return float(np.degrees(angle))
