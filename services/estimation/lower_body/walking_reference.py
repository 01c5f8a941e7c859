"""Verticals and gyroscope biases from walking alone, where nobody stood still.

Over whole strides of straight walking a sensor comes back to where it was, so its mean specific force points up and
its mean angular velocity is its bias. The mean posture of walking is not upright: thigh and shank lean by angles that
are known for a population only. They stand in for the zero, which is then right to some degrees, not to one.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from schemas.session import SensorDescription
from schemas.vocabulary import Segment
from services.biomech.rotations import angle_between, normalised, rotation_about
from services.estimation.alignment import Alignment
from services.estimation.lower_body.axis_search import low_pass
from services.estimation.parameters import StandingParameters, WalkingParameters
from services.estimation.samples import FORCE, RATE, Tick
from services.estimation.standing import StandingReference

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

SHANKS = (Segment.SHANK_RIGHT, Segment.SHANK_LEFT)
THIGHS = (Segment.THIGH_RIGHT, Segment.THIGH_LEFT)
FEET = (Segment.FOOT_RIGHT, Segment.FOOT_LEFT)
RIGHT = np.array([0.0, 0.0, 1.0])


class WalkingReference(NamedTuple):
    """What straight walking told, and when its first stride began."""

    from_ns: int
    reference: StandingReference


class Span(NamedTuple):
    """Ticks first..last-1 of one stride."""

    first: int
    last: int


def refer_to_walking(
    sensors: Sequence[SensorDescription],
    ticks: Sequence[Tick],
    walking: WalkingParameters,
    standing: StandingParameters,
) -> WalkingReference | None:
    """Verticals and biases of all sensors from the straight strides in `ticks`; None when there are too few."""
    if len(ticks) < 2:
        return None
    samples, fresh = np.array([tick.samples for tick in ticks]), np.array([tick.fresh for tick in ticks])
    times_s = np.array([tick.captured_ns for tick in ticks]) / 1e9
    strides = _regular(_strides(sensors, samples, fresh, walking), times_s, walking.longest_stride_s)
    strides = [span for span in strides if _is_straight(samples, fresh, times_s, span, walking)]
    if len(strides) < walking.fewest_strides:
        return None
    rows = np.concatenate([np.arange(*span) for span in strides])
    mean = _mean(samples[rows], fresh[rows])
    telling = _telling_verticals(sensors, samples, fresh, walking)
    mean[:, FORCE] = _mean(samples[rows], telling[rows])[:, FORCE]
    seen = np.any(telling[rows], axis=0)
    if not _is_alike(samples, telling, strides, mean, seen, standing):
        return None
    gravity = np.linalg.norm(mean[:, FORCE], axis=1)
    wrong = seen & (np.abs(gravity - standing.gravity) > walking.gravity_tolerance)
    duration_s = float(sum(times_s[span.last - 1] - times_s[span.first] for span in strides))
    bias = np.zeros((len(sensors), 3))
    for s in np.flatnonzero(seen & ~wrong):
        bias[s] = _bias(mean[s], duration_s, walking, standing)
    reference = StandingReference(ticks[rows[-1]].captured_ns, duration_s, mean[:, FORCE], bias, seen & ~wrong, wrong)
    return WalkingReference(ticks[rows[0]].captured_ns, reference)


def lean(alignment: Alignment, sensors: Sequence[SensorDescription], walking: WalkingParameters) -> Alignment:
    """The alignment whose verticals were those of walking, turned so that zero is upright in the population's mean.

    A segment that leans by a about +right in the mean has R_segment_from_sensor = Rz(-a) R_mean_from_sensor.
    """
    frames = alignment.R_segment_from_sensor.copy()
    for s, sensor in enumerate(sensors):
        if sensor.segment in THIGHS:
            frames[s] = rotation_about(RIGHT, -walking.thigh_lean) @ frames[s]
        if sensor.segment in SHANKS:
            frames[s] = rotation_about(RIGHT, -walking.shank_lean) @ frames[s]
    return Alignment(frames, np.minimum(alignment.quality, walking.best_quality), alignment.aligned)


def _telling_verticals(
    sensors: Sequence[SensorDescription], samples: Array, fresh: Flags, walking: WalkingParameters
) -> Flags:
    """(n, S) samples whose mean specific force points up: those of whole strides, but of a foot only while it is flat.

    A foot turns so fast in swing that its mean specific force is 14 m/s^2 long.
    """
    telling = fresh.copy()
    for s, sensor in enumerate(sensors):
        if sensor.segment in FEET:
            telling[:, s] &= np.linalg.norm(samples[:, s, RATE], axis=1) < walking.flat_rate
    return telling


def _strides(
    sensors: Sequence[SensorDescription], samples: Array, fresh: Flags, walking: WalkingParameters
) -> list[Span]:
    """From swing to swing of the leg sensor that shows most of them; shanks before thighs before feet."""
    for segments in (SHANKS, THIGHS, FEET):
        found = [
            _swings(samples[:, s], fresh[:, s], sensor.rate_hz, walking)
            for s, sensor in enumerate(sensors)
            if sensor.segment in segments
        ]
        best = max(found, key=len, default=[])
        if len(best) > walking.fewest_strides:
            return [Span(first, last) for first, last in pairwise(best)]
    if all(sensor.segment is Segment.PELVIS for sensor in sensors):
        # Two steps are a stride.
        steps = max(
            (_steps(samples[:, s], fresh[:, s], each.rate_hz, walking) for s, each in enumerate(sensors)), key=len
        )
        return [Span(first, last) for first, last in pairwise(steps[::2])]
    return []


def _steps(samples: Array, fresh: Flags, rate_hz: float, walking: WalkingParameters) -> list[int]:
    """Ticks at which the trunk is caught, once a step: the specific force is largest, however the sensor lies."""
    rows = np.flatnonzero(fresh)
    if len(rows) < rate_hz * walking.shortest_stride_s:
        return []
    force = low_pass(np.linalg.norm(samples[rows, FORCE], axis=1), walking.step_cutoff_hz, rate_hz)
    distance = max(1, round(0.5 * walking.shortest_stride_s * rate_hz))
    peaks, _ = find_peaks(force, prominence=walking.smallest_catch, distance=distance)
    return [int(rows[peak]) for peak in peaks]


def _swings(samples: Array, fresh: Flags, rate_hz: float, walking: WalkingParameters) -> list[int]:
    """Ticks at which a leg sensor turns fastest, once a stride. That turn is brief: third moment > 0.

    It is the forward swing of a shank and of a thigh, and the lifting of a foot's heel.
    """
    rows = np.flatnonzero(fresh)
    if len(rows) < rate_hz * walking.shortest_stride_s:
        return []
    rates = low_pass(samples[rows, RATE], walking.cutoff_hz, rate_hz)
    axis = np.linalg.eigh(rates.T @ rates)[1][:, -1]
    rate = rates @ axis
    rate = rate if np.mean(rate**3) >= 0.0 else -rate
    height = max(walking.slowest_swing, 0.5 * float(np.quantile(rate, 0.98)))
    peaks, _ = find_peaks(rate, height=height, distance=max(1, round(walking.shortest_stride_s * rate_hz)))
    return [int(rows[peak]) for peak in peaks]


def _regular(strides: list[Span], times_s: Array, longest_s: float) -> list[Span]:
    """Strides whose duration is within a quarter of the usual one; the others hold a pause or a stumble."""
    durations = np.array([times_s[span.last] - times_s[span.first] for span in strides])
    usual = float(np.median(durations)) if strides else 0.0
    return [
        span
        for span, duration_s in zip(strides, durations, strict=True)
        if abs(duration_s - usual) <= 0.25 * usual and duration_s <= longest_s
    ]


def _is_straight(samples: Array, fresh: Flags, times_s: Array, span: Span, walking: WalkingParameters) -> bool:
    """No sensor has turned: the sum of its rate over the stride is small."""
    rows = slice(span.first, span.last)
    mean = _mean(samples[rows], fresh[rows])
    turned = np.linalg.norm(mean[:, RATE], axis=1) * (times_s[span.last] - times_s[span.first])
    return bool(np.all(turned <= walking.straightest))


def _is_alike(
    samples: Array, fresh: Flags, strides: list[Span], mean: Array, seen: Flags, standing: StandingParameters
) -> bool:
    """Every stride tells the same verticals: it is walking, not the strapping on of sensors."""
    for span in strides:
        each = _mean(samples[span.first : span.last], fresh[span.first : span.last])
        for s in np.flatnonzero(seen & np.any(fresh[span.first : span.last], axis=0)):
            if angle_between(each[s, FORCE], mean[s, FORCE]) > standing.same_vertical:
                return False
    return True


def _mean(samples: Array, fresh: Flags) -> Array:
    """(S, 6) means of the fresh samples (n, S, 6); zero where there are none."""
    total = np.sum(samples * fresh[:, :, None], axis=0)
    return np.asarray(total / np.maximum(np.sum(fresh, axis=0), 1)[:, None])


def _bias(mean: Array, duration_s: float, walking: WalkingParameters, standing: StandingParameters) -> Array:
    """(3,) the horizontal part of the mean rate, weighed against the prior. About the vertical a walker may turn."""
    up = normalised(mean[FORCE])
    level = mean[RATE] - (mean[RATE] @ up) * up
    return np.asarray(level / (1.0 + (walking.return_error / (duration_s * standing.likely_bias)) ** 2))
