"""How far the rhythm harms where the stride does not go on: standing, turning, stumbling, sitting down.

A run is one walk; its ratio is the RMSE of the rhythmic over that of the plain filter, over those parts alone.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.bench.joukov.disturbed_walks import DisturbedWalk
from services.bench.joukov.study import QUANTITIES
from services.bench.joukov.walk_curves import pair_rmse
from services.bench.joukov.walk_recordings import INSTANTANEOUS, WalkRecording, with_noise
from services.bench.scoreboard import Row, at_most, informative
from services.ingest.synthetic import WalkParameters

FloatArray = NDArray[np.float64]
Flags = NDArray[np.bool_]

KINDS = {
    "stops": "stop_every=12&pause=4",
    "turns": "turn_every=8",
    "stumbles": "turn_every=0",
    "sit to stand": "stop_every=15&pause=14",
}
SENSORS = {"quiet sensors": "", "noisy sensors": "&gyro_noise=0.05&accel_noise=0.5&soft_tissue=0.035"}
TUNINGS = {"S by default": 10.0**4.5, "S / 10": 10.0**3.5}
"""(rad/s^3)^2. With less process noise the rhythm has more to say, and to harm."""
DURATION_S = 90.0
SETTLED_S = 20.0
"""s from which undisturbed walking counts: calibration and lock are over."""
RESTART_S = 3.0
"""s after a stop that count as part of it."""
WORST_LIMIT = 1.02


@dataclass(frozen=True)
class Fall:
    """Ratios (3, 2) of one run, position, velocity and acceleration of hips and knees."""

    kind: str
    sensors: str
    tuning: str
    disturbed: FloatArray
    walking: FloatArray


def disturbed_walk(kind: str, sensors: str, seed: int) -> DisturbedWalk:
    """A walk of its own speed with the disturbances of a kind."""
    speed = np.random.default_rng([11, seed]).uniform(0.6, 1.4)
    options = f"seed={seed}&duration={DURATION_S:g}&speed={speed:.3f}&{KINDS[kind]}{SENSORS[sensors]}"
    return DisturbedWalk(WalkParameters.parse(options), stumbles=kind == "stumbles", sits=kind == "sit to stand")


def parts_of(walk: DisturbedWalk, kind: str, time_s: FloatArray) -> tuple[Flags, Flags]:
    """(n,) the disturbed samples, and those of undisturbed walking."""
    timeline = walk.timeline
    walking = timeline.walking(time_s)
    if kind == "turns":
        spans = [(start_s, start_s + timeline.turn_time + 1.0) for start_s, _ in timeline.turns]
        disturbed = np.any([(time_s >= a) & (time_s < b) for a, b in spans], axis=0)
    elif kind == "stops":
        restarts = [(time_s >= bout.start_s) & (time_s < bout.start_s + RESTART_S) for bout in timeline.bouts[1:]]
        disturbed = (~walking & (time_s > timeline.bouts[0].end_s)) | np.any(restarts, axis=0)
    else:
        disturbed = walk.disturbed(time_s)
    return disturbed, walking & ~disturbed & (time_s > SETTLED_S)


def study_falls(kind: str, sensors: str, seed: int) -> list[Fall]:
    """One walk at every tuning."""
    walk = disturbed_walk(kind, sensors, seed)
    recording = WalkRecording(walk)
    parts = parts_of(walk, kind, recording.time_s)
    falls = []
    for tuning, S in TUNINGS.items():
        plain, ours = (recording.estimate(name, with_noise(INSTANTANEOUS, S)).state for name in ("ekf", "rhythmic_ekf"))
        ratios = [pair_rmse(recording, ours, part) / pair_rmse(recording, plain, part) for part in parts]
        falls.append(Fall(kind, sensors, tuning, *ratios))
    return falls


def fall_rows(falls: list[Fall]) -> list[Row]:
    """The worst run of every kind, and what is left of the gain while walking."""
    rows = []
    for kind in KINDS:
        mine = [fall for fall in falls if fall.kind == kind]
        default, tenth = ([fall for fall in mine if fall.tuning == tuning] for tuning in TUNINGS)
        worst = float(np.max([fall.disturbed for fall in default]))
        rows.append(at_most(f"{kind}: worst run, any quantity", worst, "of plain", WORST_LIMIT))
        position, faster = (float(np.max([fall.disturbed[part] for fall in tenth])) for part in (0, slice(1, 3)))
        title = f"{kind}, S / 10: worst run"
        rows.append(at_most(f"{title}, velocity or acceleration", faster, "of plain", WORST_LIMIT))
        rows.append(informative(f"{title}, position", position, "of plain"))
        for q, quantity in enumerate(QUANTITIES):
            during = [fall.disturbed[q] for fall in mine]
            rows.append(informative(f"{kind}: {quantity}, worst run", float(np.max(during)), "of plain", detail=True))
            rows.append(informative(f"{kind}: {quantity}, median", float(np.median(during)), "of plain", detail=True))
        walking = float(np.median([fall.walking[2] for fall in default]))
        rows.append(informative(f"{kind}: acceleration while walking, median", walking, "of plain"))
        worst_walk = float(np.max([fall.walking[1:] for fall in default]))
        rows.append(
            informative(f"{kind}: velocity or acceleration while walking, worst", worst_walk, "of plain", detail=True)
        )
    return rows
