"""Where the filter starts: from a standing, still second, or from a posture fitted to the first frames.

Constant biases of the centres are told from the posture, which is known while standing. A start that is not standing
has bias states, too: that people move within limits and about a rest posture tells a good part of them, but absolute
angles still carry the camera's offsets.
"""

from dataclasses import asdict
from itertools import combinations
from math import radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import JointCentre
from services.biomech.whole_body.kernels.tables import COORDINATES
from services.biomech.whole_body.model import CENTRE_NAMES, MODEL, WholeBodyModel
from services.biomech.whole_body.parameters import (
    MEAN_STATURE,
    REST_DEG,
    START_NOISE,
    StartNoise,
    length_covariance,
    lengths_of,
    per_angle,
)
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
States = NDArray[np.int64]

PLACE = {centre: i for i, centre in enumerate(CENTRE_NAMES)}

STILL_STD = 0.03
"""m. Largest robust deviation of a tracked centre, arms apart, in a still second: noise 0.01, wander of a bone."""
STILL_DRIFT = 0.025
"""m per axis, RMS over the centres, between thirds of a still second. The slow turning point of a movement is still by
the measure above; of seconds within this the posture was at most 8 deg from rest, of standing ones 95 % are within it
(tuning people)."""
UPRIGHT = radians(25.0)
"""Largest angle of trunk, thigh and shank against the vertical while standing, camera offsets included."""
ARM, FOREARM = radians(35.0), radians(50.0)
"""The same of upper arm and forearm. Arms held otherwise are no rest posture: they would be taken for offsets."""
TURNED = radians(30.0)
"""A heading beyond this is told by the camera; below, facing it is likelier than what 0.17 m of pelvis show."""
UNKNOWN_STATURE_SPREAD = 0.05


class Start(NamedTuple):
    """Posture and lengths to start from, and how sure they are."""

    q: Array  # (25,) m and rad
    q_std: Array  # (25,)
    lengths: Array  # (12,) m
    length_covariance: Array  # (12, 12) m^2
    bias_std: tuple[float, float, float] | None  # m; None: no bias states
    noise: StartNoise
    standing: bool = False  # whether the posture was known, so that absolute angles are free of the camera's offsets

    def packed(self) -> State:
        """As JSON values, to the bit."""
        arrays = self.q, self.q_std, self.lengths, self.length_covariance
        return {
            "arrays": [pack_array(array) for array in arrays],
            "bias_std": None if self.bias_std is None else list(self.bias_std),
            "noise": asdict(self.noise) | {"bias_std": list(self.noise.bias_std)},
            "standing": self.standing,
        }

    @classmethod
    def unpacked(cls, state: State) -> "Start":
        """Inverse of `packed`."""
        noise = dict(state["noise"])
        noise["bias_std"] = _triple(noise["bias_std"])
        bias_std = None if state["bias_std"] is None else _triple(state["bias_std"])
        q, q_std, lengths, covariance = (unpack_array(packed) for packed in state["arrays"])
        return cls(q, q_std, lengths, covariance, bias_std, StartNoise(**noise), bool(state["standing"]))


def _triple(values: list[float]) -> tuple[float, float, float]:
    depth, height, sideways = values
    return depth, height, sideways


def median_centres(centres: Array, state: States) -> Array:
    """(15, 3) median over frames (t, 15, 3) of what was tracked, or inferred where nothing was; NaN if never seen."""
    result = np.full(centres.shape[1:], np.nan)
    for m in range(centres.shape[1]):
        for wanted in (2, 1):
            rows = centres[(state[:, m] >= wanted) & np.isfinite(centres[:, m]).all(axis=1), m]
            if len(rows):
                result[m] = np.median(rows, axis=0)
                break
    return result


def is_standing(centres: Array, state: States) -> bool:
    """Whether frames (t, 15, 3) show someone upright, legs straight below, arms hanging, and still."""
    return not_standing(centres, state) == ""


def not_standing(centres: Array, state: States) -> str:
    """Why frames (t, 15, 3) do not show a standing, still person, in words for a therapist; empty if they do."""
    middle = median_centres(centres, state)
    if not np.isfinite(middle).all():
        return "not all of the body was in view"
    body = [PLACE[c] for c in CENTRE_NAMES if not c.startswith(("elbow", "wrist", "ankle"))]
    tracked = state[:, body] == 2
    if not tracked.any(axis=0).all():
        return "not all of the body was in view"
    spread = np.nanmedian(np.where(tracked[:, :, None], np.abs(centres[:, body] - middle[body]), np.nan), axis=0)
    if spread.max() > STILL_STD or _drift(np.where(tracked[:, :, None], centres[:, body], np.nan)) > STILL_DRIFT:
        return "the person moved"
    for upper, lower, most, words in _hanging():
        if _inclination(middle[PLACE[upper]] - middle[PLACE[lower]]) >= most:
            return words
    return ""


def _drift(centres: Array) -> float:
    """m per axis, RMS, between those two thirds of frames (t, m, 3) that differ most; NaN where not tracked."""
    thirds = np.array_split(centres, 3)
    there = np.all([np.isfinite(third).any(axis=0) for third in thirds], axis=0)
    if not there.any():
        return 0.0
    places = [np.nanmedian(np.where(there, third, 0.0), axis=0)[there] for third in thirds]
    return max(float(np.sqrt(np.mean((a - b) ** 2))) for a, b in combinations(places, 2))


def _hanging() -> list[tuple[JointCentre, JointCentre, float, str]]:
    """Bones that hang or stand upright while standing: upper end, lower end, largest inclination, what it is else."""
    bones = [(JointCentre.SPINE_SHOULDER, JointCentre.SPINE_BASE, UPRIGHT, "the trunk was not upright")]
    for side in ("right", "left"):
        hip, knee, ankle, shoulder, elbow, wrist = (
            JointCentre(f"{name}_{side}") for name in ("hip", "knee", "ankle", "shoulder", "elbow", "wrist")
        )
        bones += [(hip, knee, UPRIGHT, "the legs were bent"), (knee, ankle, UPRIGHT, "the legs were bent")]
        bones += [(shoulder, elbow, ARM, "the arms did not hang"), (elbow, wrist, FOREARM, "the arms did not hang")]
    return bones


def _inclination(bone: Array) -> float:
    return float(np.arctan2(np.hypot(bone[0], bone[2]), bone[1]))


def heading(middle: Array) -> float:
    """rad, turned to the left, from shoulders and hips (15, 3)."""
    line = np.zeros(3)
    for name in ("shoulder", "hip"):
        line += middle[PLACE[JointCentre(f"{name}_right")]] - middle[PLACE[JointCentre(f"{name}_left")]]
    return float(np.arctan2(line[0], line[2]))


def measured_lengths(model: WholeBodyModel, centres: Array) -> Array:
    """(12,) m, from one set of centres (15, 3); NaN where an end is missing."""
    tree = model.tree
    total, count = np.zeros(12), np.zeros(12)
    for m in range(len(CENTRE_NAMES)):
        length = tree.centre_length[m]
        if length >= 0 and np.isfinite(centres[[m, tree.before[m]]]).all():
            total[length] += np.linalg.norm(centres[m] - centres[tree.before[m]])
            count[length] += abs(tree.centre_share[m])
    return np.where(count > 0.0, total / np.maximum(count, 1e-9), np.nan)


def stature_told_by(lengths: Array) -> float:
    """m, from measured lengths (12,): the median over those there are; the mean person's without any."""
    ratios = lengths / lengths_of(1.0)
    return float(np.nanmedian(ratios)) if np.isfinite(ratios).any() else MEAN_STATURE


def standing_start(
    centres: Array, state: States, stature: float | None, noise: StartNoise = START_NOISE,
    model: WholeBodyModel = MODEL,
) -> Start:  # fmt: skip
    """From a standing, still second of frames (t, 15, 3): the rest posture of people, not what the camera shows."""
    middle = median_centres(centres, state)
    rest, spread = per_angle(REST_DEG).T
    q = np.concatenate([np.zeros(3), rest])
    turned = heading(middle)
    if abs(turned) > TURNED:
        q[3] = turned
    told = stature is not None
    lengths = lengths_of(stature if stature is not None else stature_told_by(measured_lengths(model, middle)))
    q[:3] = np.nanmedian(middle - model.centres(q, lengths), axis=0)
    spread_of_lengths = noise.length_spread if told else UNKNOWN_STATURE_SPREAD
    return Start(
        q, np.concatenate([np.full(3, noise.position_std), spread]), lengths,
        length_covariance(lengths, spread_of_lengths), noise.bias_std, noise, standing=True,
    )  # fmt: skip


FITTED_ANGLE_STD = radians(15.0)
"""rad. A posture fitted to biased centres: 30 mm over a bone of 0.15 to 0.4 m."""
FITTED_LENGTH_SPREAD = 0.06


def fitted_start(q: Array, lengths: Array, noise: StartNoise = START_NOISE) -> Start:
    """From a posture q (25,) and lengths (12,) that were fitted to the first frames."""
    std = np.full(COORDINATES, FITTED_ANGLE_STD)
    std[:3] = noise.position_std
    return Start(q.copy(), std, lengths.copy(), length_covariance(lengths, FITTED_LENGTH_SPREAD), noise.bias_std, noise)
