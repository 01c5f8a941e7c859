"""Recorded Kinect v2 skeletons: KIMORE for robustness and lengths, KERAAL against optical inclination of the trunk."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect.recordings import KIMORE, RATE_HZ, keraal, kimore
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.biomech.whole_body.colombel import ColombelCekf
from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings, WholeBodyEkf
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, MODEL
from services.biomech.whole_body.multibody_kinematics import fit_frame, fit_recording
from services.biomech.whole_body.observability import trunk_lean
from services.biomech.whole_body.parameters import LIMITS_DEG, per_angle
from services.biomech.whole_body.presets import CORRECTED, UNCONSTRAINED, settings_for
from services.biomech.whole_body.start import (
    Start,
    fitted_start,
    is_standing,
    measured_lengths,
    median_centres,
    standing_start,
)
from services.ingest.synthetic.whole_body.camera import Seen

Array = NDArray[np.float64]

NOTE = (
    "recorded: the calm settings of a start that is not standing were chosen with the KIMORE squat in view, "
    "nothing else. It has no reference: jumps, lengths and limits only; lengths are held after 5 s. "
    "KERAAL is seated: only the lean of the trunk is compared"
)
STEP_DEG = 20.0
SETTLED_S = 5.0
STANDING_FRAMES = 30
KNEES = [DOF["knee_flexion_right"], DOF["knee_flexion_left"]]


@dataclass(frozen=True)
class Followed:
    """What a method made of a recording."""

    angles: Array  # (n, 22) rad
    lengths: Array  # (n, 12) m

    def steps(self) -> int:
        """Frames in which a knee moves by more than 20 deg at once."""
        return int((np.abs(np.diff(np.degrees(self.angles[:, KNEES]), axis=0)) > STEP_DEG).any(axis=1).sum())

    def largest_step(self) -> float:
        """deg."""
        return float(np.abs(np.diff(np.degrees(self.angles[:, KNEES]), axis=0)).max())

    def jitter(self) -> float:
        """deg, RMS of the knees' second difference."""
        return float(np.sqrt(np.mean(np.diff(np.degrees(self.angles[:, KNEES]), 2, axis=0) ** 2)))

    def length_variation(self) -> float:
        """Largest coefficient of variation of the legs' four lengths after 5 s, %."""
        settled = self.lengths[int(SETTLED_S * RATE_HZ) :, 1:5]
        return float(100.0 * (settled.std(axis=0) / settled.mean(axis=0)).max())

    def violations(self) -> int:
        """Frames outside the limits of angles, or not finite."""
        low, high = per_angle(LIMITS_DEG).T
        inside = ((self.angles >= low) & (self.angles <= high))[:, 1:].all(axis=1)
        return int((~inside).sum())


def first_start(seen: Seen) -> Start:
    """The rest posture with biases where someone stands still for a second, else what fits the first frames."""
    centres, state = seen.centres[:STANDING_FRAMES], seen.state[:STANDING_FRAMES]
    if is_standing(centres, state):
        return standing_start(centres, state, None)
    few = slice(0, 5)
    fit = fit_frame(median_centres(centres[few], state[few]), np.full(len(CENTRE_NAMES), 2))
    return fitted_start(fit.q, fit.lengths)


def follow(seen: Seen, ekf: WholeBodyEkf | ColombelCekf) -> Followed:
    """A filter over a recording."""
    angles, lengths = np.full((len(seen.centres), len(DOF)), np.nan), np.full((len(seen.centres), 12), np.nan)
    with np.errstate(all="ignore"):
        for k, (centres, state) in enumerate(zip(*seen, strict=True)):
            if not np.isfinite(ekf.x).all():
                break
            ekf.advance(1.0 / RATE_HZ if k else 0.0, centres, state)
            angles[k], lengths[k] = ekf.angles, ekf.lengths
    return Followed(angles, lengths)


def geometric(seen: Seen) -> Followed:
    """Knees as the angle between thigh and shank of each frame, lengths as distances; other angles are left zero."""
    angles = np.zeros((len(seen.centres), len(DOF)))
    for knee, hip in zip(KNEES, (9, 12), strict=True):
        thigh, shank = (seen.centres[:, hip + i + 1] - seen.centres[:, hip + i] for i in (0, 1))
        cosine = (thigh * shank).sum(axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
        angles[:, knee] = np.arccos(np.clip(cosine, -1.0, 1.0))
    return Followed(angles, np.array([measured_lengths(MODEL, frame) for frame in seen.centres]))


def kimore_methods(seen: Seen) -> dict[str, Followed]:
    """Every method over one recording."""
    start = first_start(seen)
    unbiased = start._replace(bias_std=None)
    q, lengths = fit_recording(*seen, RATE_HZ)
    settings: dict[str, FilterSettings] = {"corrected, flat Q": CORRECTED, "unconstrained, flat Q": UNCONSTRAINED}
    found = {
        "raw geometry": geometric(seen),
        "multibody fit, offline": Followed(q[:, 3:], np.repeat(lengths[None], len(q), axis=0)),
        "literal eq. 5, flat Q": follow(seen, ColombelCekf(unbiased, CORRECTED.process)),
    }
    found |= {name: follow(seen, WholeBodyEkf(unbiased, one)) for name, one in settings.items()}
    return found | {"ours without limits": follow(seen, WholeBodyEkf(start, replace(OURS, constrained=False)))}


def kimore_rows() -> list[Row]:
    """KIMORE squat and arm lift. Raises MissingFile without the data."""
    rows: list[Row] = []
    for name in KIMORE:
        seen = kimore(name)
        for method, found in kimore_methods(seen).items():
            rows += _kimore_figures(f"KIMORE {name}: {method}", found, detail=method != "raw geometry")
        start = first_start(seen)
        settings = settings_for(standing=start.standing)
        ours = follow(seen, WholeBodyEkf(start, settings))
        label = f"KIMORE {name}: ours"
        rows += [
            at_most(f"{label}, frames outside limits or not finite", ours.violations(), "", 0),
            at_most(f"{label}, knee steps over 20 deg of {len(seen.centres)} frames", ours.steps(), "", 9),
            informative(f"{label}, largest knee step", ours.largest_step(), "deg"),
            informative(f"{label}, knee jitter", ours.jitter(), "deg/frame^2"),
            informative(f"{label}, started standing", float(start.standing), ""),
        ]
        plain = follow(seen, WholeBodyEkf(start._replace(bias_std=None), settings))
        rows.append(at_most(f"{label}, leg lengths after 5 s, no bias states", plain.length_variation(), "% CV", 1.0))
    return rows


def _kimore_figures(label: str, found: Followed, *, detail: bool) -> list[Row]:
    if not np.isfinite(found.angles).all():
        return [informative(f"{label}, frames before it diverged", float(np.isfinite(found.angles[:, 0]).sum()), "")]
    return [
        informative(f"{label}, knee steps over 20 deg", found.steps(), "", detail=detail),
        informative(f"{label}, largest knee step", found.largest_step(), "deg", detail=True),
        informative(f"{label}, knee jitter", found.jitter(), "deg/frame^2", detail=True),
        informative(f"{label}, leg lengths after 5 s", found.length_variation(), "% CV", detail=detail),
    ]


def keraal_rows() -> list[Row]:
    """KERAAL trunk lean straight from the centres and through the filter. Raises MissingFile without the data."""
    recording = keraal()
    direct = trunk_lean(recording.seen.centres)[:, 1]
    start = first_start(recording.seen)
    ekf = WholeBodyEkf(start, settings_for(standing=start.standing))
    filtered = np.zeros(len(direct))
    for k, (centres, state) in enumerate(zip(*recording.seen, strict=True)):
        ekf.advance(1.0 / RATE_HZ if k else 0.0, centres, state)
        filtered[k] = trunk_lean(MODEL.centres(ekf.q, ekf.lengths))[1]
    rows = []
    for name, lean in (("straight from the centres", direct), ("through the filter", filtered)):
        error = np.degrees(lean - recording.frontal)
        agreement = float(np.corrcoef(lean, recording.frontal)[0, 1])
        label = f"KERAAL frontal lean, {name}"
        if name.startswith("straight"):
            rows += [at_least(f"{label}, r", agreement, "", 0.77), at_most(f"{label}, RMSE", _rms(error), "deg", 5.1)]
        else:
            rows += [informative(f"{label}, r", agreement, ""), informative(f"{label}, RMSE", _rms(error), "deg")]
        rows.append(informative(f"{label}, offset removed", float(error.std()), "deg"))
    return rows


def _rms(error: Array) -> float:
    return float(np.sqrt(np.mean(error**2)))
