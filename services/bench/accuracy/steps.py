"""Knee angle of single treadmill steps against markers: known mounting, no standing, estimated offline."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.conditions import UNSAID
from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.vocabulary import Task
from services.bench.accuracy.joint_scores import Score, best_score, column_of, score
from services.bench.accuracy.kam_steps import NAMES, RATE_HZ, Step, read_steps
from services.bench.accuracy.offline_steps import NOISE, both_ways, quietest
from services.bench.scoreboard import Row, Scoreboard, at_most, informative
from services.biomech.lower_body_ekf import NoiseModel
from services.biomech.rotations import frame_from_up_and_right
from services.estimation.alignment import Alignment
from services.estimation.lower_body.lower_body_filter import Calibrated

Array = NDArray[np.float64]

SUBJECT = "kam"
NOTE = """Ten right steps of one person on a treadmill, 1 s each, estimated offline from their quietest instant to both
ends; the live node needs standing or whole strides. Mounting as documented: y up along the segment, z out of the skin;
flexion about -x. Zero = the sensors' own y axes, truth = lines between joint centres (hip after
Bell 1990). accel_std was chosen by the error of steps 0-2, the mounting with all in view
(axes from the gyroscopes: 2.65). No baseline: VQF has no start
within a step."""
CHOSEN_ON, OTHERS = range(3), range(3, 10)
UP = np.array([0.0, 1.0, 0.0])
LEFT = np.array([1.0, 0.0, 0.0])
"""Of a sensor on the front with y up and z out."""
SHIFTED = 3


class StepScore(NamedTuple):
    """Agreement of one step, at its best shift and at none."""

    best: Score
    unshifted: Score


def describe() -> SessionDescription:
    """Pelvis, right thigh and right shank, worn in front."""
    sensors = [
        SensorDescription(
            name=segment.value, segment=segment, rate_hz=RATE_HZ, outward_axis=[0.0, 0.0, 1.0], upward_axis=None,
            placement=Placement.ANTERIOR, position_in_segment=None,
        )
        for segment in NAMES
    ]  # fmt: skip
    body = Anthropometry(
        height_m=1.83, mass_kg=71.4, thigh_length_m=0.45, shank_length_m=0.44, hip_width_m=0.18, source="default"
    )
    return SessionDescription(
        session="kam", title="Single treadmill steps", started_unix_ns=0, origin="recording", protocol="walking",
        task=Task.WALK, walkway_m=None, conditions=UNSAID, estimator="ekf", walk_path="turning",
        hubs=[HubDescription(name="imu", sensors=sensors)], cameras=[], anthropometry=body,
        standing=[], reference=[], duration_s=None, known_rhythms=[],
    )  # fmt: skip


def mounting() -> Alignment:
    """As documented: worn in front, y up along the segment, z out of the skin."""
    frames = np.tile(frame_from_up_and_right(UP, -LEFT), (len(NAMES), 1, 1))
    return Alignment(frames, np.full(len(NAMES), 0.5), np.ones(len(NAMES), dtype=np.bool_))


def step_scores(steps: list[Step], noise: NoiseModel = NOISE) -> list[StepScore]:
    """Scores of every step, away from its ends by the shift's room."""
    description = describe()
    calibrated = Calibrated(mounting(), np.zeros((len(NAMES), 3)))
    column = column_of("knee_flexion_right")
    scores = []
    for step in steps:
        start = quietest(step.samples[:, 1:])
        angles = both_ways(description, description.hubs[0].sensors, calibrated, step.samples, start, noise)
        knee, frames = np.degrees(angles[:, column]), np.arange(SHIFTED, len(step.knee_deg) - SHIFTED)
        scores.append(StepScore(best_score(knee, step.knee_deg, frames), score(knee, step.knee_deg, frames, 0)))
    return scores


def run(json_path: Path | None = None) -> Scoreboard:
    """Score the steps. Raises MissingFile without the data."""
    scores = step_scores(read_steps())
    rows: list[Row] = []
    for name, chosen in (("chosen on", CHOSEN_ON), ("others", OTHERS), ("all", range(len(scores)))):
        best = [scores[k].best for k in chosen]
        title = f"knee right, steps {name}"
        mean = float(np.mean([s.offset_removed_deg for s in best]))
        rows.append(at_most(f"{title}: offset-removed, mean of steps", mean, "deg", 2.4))
        rows.append(informative(f"{title}: worst step", max(s.offset_removed_deg for s in best), "deg"))
        rows.append(informative(f"{title}: absolute", float(np.mean([s.absolute_deg for s in best])), "deg"))
        unshifted = float(np.mean([scores[k].unshifted.offset_removed_deg for k in chosen]))
        rows.append(informative(f"{title}: offset-removed, shift 0", unshifted, "deg"))
        rows.append(informative(f"{title}: shift, mean", float(np.mean([s.shift for s in best])), "samples"))
        rows.append(informative(f"{title}: r, lowest", min(s.correlation for s in best), ""))
    board = Scoreboard("accuracy on KAM subject_01", rows, NOTE)
    if json_path is not None:
        board.write_json(json_path)
    return board
