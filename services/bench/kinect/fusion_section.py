"""Walkers with both inertial sensors and a camera: each source alone, both in one estimate, and what a loss costs.

Offsets: the simulated sensors are strapped to a body whose standing is exactly the zero of the truth, so the inertial
estimator has none of the offset that people's posture gives it; what is told apart from an offset is told by both.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.kinematics import JointState
from schemas.session import SessionDescription
from schemas.vocabulary import BODY_MODELS
from services.bench.scoreboard import Row, at_most, informative
from services.estimation.node import build
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]

SEEDS = tuple(range(101, 109))
"""Walkers that are scored; settings were chosen on seeds below 100."""
SPEC = "synthetic:walk?camera=1&duration=75&seed={seed}&speed={speed}"
SPEEDS = (0.7, 0.9, 1.1, 1.3)
"""m/s, one walker after the other."""
SETTLED_S = 30.0
"""s from which on is scored: all estimators run, and have compared for some strides."""
LOST_S, LOSS_S = 60.0, 5.0
"""s at which a source goes in the trials of loss, and for how long."""
BEFORE_S = 15.0
"""s before the loss against which its cost is told."""
JOINTS = ("hip_flexion", "hip_adduction", "knee_flexion")
NAMES = tuple(f"{joint}_{side}" for joint in JOINTS for side in ("right", "left"))
ESTIMATORS = {"sensors alone": "rhythmic_ekf", "camera alone": "body_cekf", "both": "fusion"}
NOTE = (
    f"Fusion: seeds {SEEDS[0]} to {SEEDS[-1]} on a treadmill at {SPEEDS[0]} to {SPEEDS[-1]} m/s, the camera's noise\n"
    f"that of the other sections; from {SETTLED_S:g} s on, root mean square over walkers. Growth: error in a loss\n"
    f"of {LOSS_S:g} s less that of the {BEFORE_S:g} s before it, both fused. These sensors have no posture offset."
)


class Track(NamedTuple):
    """Angles over time."""

    time_s: Array  # (n,)
    angles: Array  # (n, len(NAMES)) rad; NaN where not valid


def description_for(description: SessionDescription, estimator: str) -> SessionDescription:
    """The same session for one estimator, without the sensors it does not use."""
    used: dict[str, dict[str, Any]] = {"rhythmic_ekf": {"cameras": []}, "body_cekf": {"hubs": []}, "fusion": {}}
    return description.model_copy(update={"estimator": estimator, **used[estimator]})


def follow(description: SessionDescription, messages: Sequence[Message], estimator: str) -> Track:
    """What an estimator makes of the messages."""
    node = build(description_for(description, estimator))
    outputs = [out for message in messages if message.stream in node.streams and message.payload is not None
               for out in node.step(message)]  # fmt: skip
    states = [out.payload for out in [*outputs, *node.finish()] if isinstance(out.payload, JointState)]
    times, angles = [], []
    for state in states:
        columns = [[dof.name for dof in BODY_MODELS[state.model]].index(name) for name in NAMES]
        rows = np.array(state.position)[:, columns]
        rows[:, ~np.array(state.valid)[columns]] = np.nan
        times.append(np.array(state.captured_ns) / 1e9)
        angles.append(rows)
    return Track(np.concatenate(times), np.concatenate(angles))


def truth_of(description: SessionDescription, messages: Sequence[Message]) -> Track:
    """The angles that came with the simulation."""
    columns = [[channel.name for channel in description.reference].index(name) for name in NAMES]
    batches = [m.payload for m in messages if isinstance(m.payload, ReferenceBatch)]
    times = np.concatenate([batch.captured_ns for batch in batches]) / 1e9
    return Track(times, np.concatenate([np.array(batch.values, dtype=np.float64) for batch in batches])[:, columns])


def errors(track: Track, truth: Track, from_s: float, to_s: float) -> Array:
    """(m, len(NAMES)) deg within a span; NaN where nothing valid was told."""
    part = (track.time_s >= from_s) & (track.time_s < to_s)
    at = track.time_s[part]
    expected = np.stack([np.interp(at, truth.time_s, column) for column in truth.angles.T], axis=1)
    found: Array = np.degrees(track.angles[part] - expected)
    return found


def rms(found: Sequence[Array], joint: str) -> float:
    """deg over walkers and both sides."""
    columns = [i for i, name in enumerate(NAMES) if name.startswith(joint)]
    return float(np.sqrt(np.nanmean(np.square(np.concatenate([each[:, columns] for each in found])))))


def _played(spec: str) -> tuple[SessionDescription, list[Message]]:
    source = open_source(spec, estimator="fusion")
    return source.describe(), list(iter_messages(source))


def fusion_rows(advance: Callable[[], None]) -> list[Row]:
    """Each source alone, both, and the cost of losing either for a while."""
    whole: dict[str, list[Array]] = {name: [] for name in ESTIMATORS}
    lost: dict[str, list[tuple[Array, Array]]] = {"camera": [], "imu": []}
    for seed in SEEDS:
        spec = SPEC.format(seed=seed, speed=SPEEDS[seed % len(SPEEDS)])
        description, messages = _played(spec)
        truth = truth_of(description, messages)
        for name, estimator in ESTIMATORS.items():
            whole[name].append(errors(follow(description, messages, estimator), truth, SETTLED_S, np.inf))
        for source, pairs in lost.items():
            cut = _played(f"{spec}&{source}_away_at={LOST_S:g}&{source}_away_for={LOSS_S:g}")
            track = follow(*cut, "fusion")
            pairs.append(
                (errors(track, truth, LOST_S - BEFORE_S, LOST_S), errors(track, truth, LOST_S, LOST_S + LOSS_S))
            )
        advance()
    return [row for joint in JOINTS for row in _joint_rows(joint, whole, lost)]


def _joint_rows(joint: str, whole: dict[str, list[Array]], lost: dict[str, list[tuple[Array, Array]]]) -> list[Row]:
    alone = {name: rms(whole[name], joint) for name in ("sensors alone", "camera alone")}
    label, targeted = joint.replace("_", " "), joint != "hip_adduction"
    rows = [informative(f"fusion, {label}: {name}", value, "deg") for name, value in alone.items()]
    both, better = rms(whole["both"], joint), min(alone.values())
    name = f"fusion, {label}: both"
    rows.append(at_most(name, both, "deg", round(better, 2), better) if targeted else informative(name, both, "deg"))
    for source, pairs in lost.items():
        before, within = (rms([pair[i] for pair in pairs], joint) for i in (0, 1))
        name = f"fusion, {label}: growth without {'the camera' if source == 'camera' else 'sensors'}"
        grown = within - before
        rows.append(at_most(name, grown, "deg", 2.0, before) if targeted else informative(name, grown, "deg", before))
    return rows
