"""Synthetic trials with sensors that slide on the leg: McGrath's explanatory variables (section 3.4) with truth.

The paper measured them after the event on people; here placement and sliding are drawn, which it names as future work.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from services.bench.knee import peers
from services.bench.knee.hinge_peer import heading_between
from services.bench.knee.legs import FLEXION_AXIS, Motion, Sensors, orientation, record, segment_from_sensor, walking
from services.bench.knee.recordings import KneeRecording
from services.bench.knee.scores import FLEXION, VALID, score
from services.bench.knee.seel_axis import seel_axis
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.biomech.two_sensor_knee.mcgrath import flexion_angle, knee_flexion
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters

Array = NDArray[np.float64]

FIRST_SEED = 80000
SUBJECTS, TRIALS = 15, 10
RATE_HZ, DURATION_S = 100.0, 24.0
SCORED_FROM_S = 9.0
"""s; until then the leg stands, starts to walk, and our axis is being found."""
EVERY = 50
"""Samples between two looks at our axis."""
OURS, LITERAL, ON_VQF = "ours", "McGrath, true orientations", "McGrath on VQF"
SEEL = "Seel axis, true orientations"
SEEL_SAMPLES = 300
"""Of a trial that the axis without orientations is fitted to."""
LATERAL, FORWARD = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


class Outcome(NamedTuple):
    """What one method made of a trial, rad."""

    zero_mean_rmse: float
    axis_error: Array  # (2,) thigh, shank: median over time of the angle to the axis of the bones


class Trial(NamedTuple):
    """Explanatory variables (2,) of thigh and shank, rad, and the outcome of each method."""

    subject: int
    placement: Array  # mean circumferential angle
    sliding: Array  # its standard deviation
    outcomes: dict[str, Outcome]


def run_trial(subject: int, trial: int) -> Trial:
    """Trial `trial` of subject `subject`; everything follows from both numbers."""
    sensors, normals = _worn(subject, trial)
    draw = np.random.default_rng([FIRST_SEED, subject, trial])
    motion = _walk_and_turn(draw.uniform(0.75, 1.05))
    leg = record(motion, DURATION_S, RATE_HZ, sensors, seed=int(draw.integers(1 << 30)))
    t = np.arange(1, len(leg.flexion) + 1) / RATE_HZ
    on_bone = [segment_from_sensor(motion, sensors, s, t) for s in range(2)]
    true_axes = np.stack([turn.inv().apply(FLEXION_AXIS) for turn in on_bone], axis=1)
    scored = t >= SCORED_FROM_S
    angles = np.stack([circumferential_angle(on_bone[s].apply(normals[s])) for s in range(2)], axis=1)[scored]
    every = np.ones(len(t), dtype=np.bool_)
    recording = KneeRecording(f"leg {subject}.{trial}", RATE_HZ, leg.rate, leg.force, leg.flexion, every, None)
    worlds = [orientation(motion, sensors, s, t).as_matrix() for s in range(2)]
    outcomes = {OURS: _ours(recording, true_axes, scored), LITERAL: _literal(recording, worlds, true_axes, scored)}
    outcomes[SEEL] = _seel(recording, worlds, true_axes, scored)
    if peers.missing("vqf") is None:
        outcomes[ON_VQF] = _literal(recording, _levelled_by_vqf(recording, worlds), true_axes, scored)
    return Trial(subject, angles.mean(axis=0), angles.std(axis=0), outcomes)


def circumferential_angle(normal_in_segment: Array) -> Array:
    """Angle (n,), rad, between the lateral direction and the sensor's normal (n, 3) seen along the bone (eq. 5)."""
    across = normal_in_segment * [1.0, 0.0, 1.0]
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(across, LATERAL), axis=1), across @ LATERAL))


def _worn(subject: int, trial: int) -> tuple[Sensors, Array]:
    """Sensors as a subject wears them, and their normals (2, 3) in the segments: placed and sliding as in figure 4."""
    person, day = np.random.default_rng([FIRST_SEED, subject]), np.random.default_rng([FIRST_SEED, subject, trial, 1])
    around = np.radians(person.uniform([20.0, 0.0], [100.0, 60.0]))
    normals = np.cos(around)[:, None] * LATERAL + np.sin(around)[:, None] * FORWARD
    mounted = Rotation.random(2, rng=person).as_matrix()
    amplitudes = np.radians(person.uniform([[0.0, 2.0, 0.0]] * 2, [[4.0, 16.0, 3.0], [2.0, 12.0, 2.0]]))
    senses = person.choice([-1.0, 1.0], size=(2, 3))
    sensors = Sensors(
        mounted, np.radians(day.normal(0.0, 0.3, (2, 3))), rate_noise=0.003, force_noise=0.1,
        sliding=amplitudes * senses * day.uniform(0.4, 1.6),
    )  # fmt: skip
    return sensors, np.einsum("sij,sj->si", mounted, normals)


def _walk_and_turn(cadence_hz: float) -> Motion:
    """Standing for 3 s, walking, half a turn within 2 s, walking back."""
    motion = walking(cadence_hz)

    def heading(t: Array) -> Array:
        share = np.clip((t - 13.0) / 2.0, 0.0, 1.0)
        return np.asarray(motion.heading(t) + np.pi * share**3 * (10.0 - 15.0 * share + 6.0 * share**2))

    return motion._replace(heading=heading)


def _ours(recording: KneeRecording, true_axes: Array, scored: NDArray[np.bool_]) -> Outcome:
    """Causal, from the first sample on."""
    estimator, outs, errors = KneeAxis(KneeAxisParameters()), [], []
    for begin in range(0, len(recording.rate), EVERY):
        part = slice(begin, begin + EVERY)
        outs.append(estimator.run(recording.rate[part], recording.force[part], 1.0 / RATE_HZ))
        if scored[begin]:
            errors.append(_line_angles(estimator.axes, true_axes[part][-1]))
    out = np.concatenate(outs)
    valid = out[:, VALID] > 0
    if not (valid & scored).any():
        return Outcome(np.nan, np.median(errors, axis=0))
    rmse = score(out[:, FLEXION], recording.flexion, scored, valid).unshifted.zero_mean_rmse
    return Outcome(rmse, np.median(errors, axis=0))


def _literal(recording: KneeRecording, worlds: list[Array], true_axes: Array, scored: NDArray[np.bool_]) -> Outcome:
    """As published, the whole trial seen before the axis is told."""
    angle, axes = knee_flexion(worlds[0], worlds[1], recording.rate[:, 0], recording.rate[:, 1])
    errors = np.median(_line_angles(axes, true_axes[scored]), axis=0)
    both = [score(sense * angle, recording.flexion, scored, recording.holds) for sense in (-1.0, 1.0)]
    return Outcome(min(one.unshifted.zero_mean_rmse for one in both), errors)


def _seel(recording: KneeRecording, worlds: list[Array], true_axes: Array, scored: NDArray[np.bool_]) -> Outcome:
    """The paper's comparison: the axis from the rates alone, the angle as published, the senses that agree best."""
    axes = seel_axis(recording.rate[:: len(recording.rate) // SEEL_SAMPLES])
    relative = np.swapaxes(worlds[1], 1, 2) @ worlds[0]
    found = []
    for sense in (-1.0, 1.0):
        angle = flexion_angle(relative, axes[0], sense * axes[1])
        found += [score(up * angle, recording.flexion, scored, recording.holds) for up in (-1.0, 1.0)]
    errors = np.median(_line_angles(axes, true_axes[scored]), axis=0)
    return Outcome(min(one.unshifted.zero_mean_rmse for one in found), errors)


def _levelled_by_vqf(recording: KneeRecording, worlds: list[Array]) -> list[Array]:
    """VQF, its headings made equal once, at the end of standing: the common frame that the paper asks for."""
    thigh, shank = peers.orientations(recording)
    k = int(RATE_HZ)
    heading = heading_between(thigh[k], shank[k], worlds[0][k], worlds[1][k])
    return [thigh, Rotation.from_rotvec([0.0, 0.0, heading]).as_matrix() @ shank]


def _line_angles(found: Array, true: Array) -> Array:
    """Angle, rad, between lines (..., 3)."""
    return np.asarray(np.arccos(np.clip(np.abs(np.sum(found * true, axis=-1)), 0.0, 1.0)))
