"""Recordings as the filter meets them: calibrated once by the node's own calibrator, then run as often as it takes."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription, SessionDescription
from schemas.signals import IMU
from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.lower_body_ekf import LowerBodyEkf, NoiseModel
from services.biomech.rhythm.joukov import JoukovOscillator
from services.estimation.intake import Intake, used_by_lower_body
from services.estimation.lower_body.calibrator import Calibrator
from services.estimation.lower_body.lower_body_filter import Calibrated, LowerBodyFilter
from services.estimation.parameters import EstimationParameters, FilterParameters
from services.estimation.samples import Tick, TickBatch
from services.ingest.source import iter_messages, open_source

FloatArray = NDArray[np.float64]

JOINTS = ("hip_flexion_right", "hip_flexion_left", "knee_flexion_right", "knee_flexion_left")
"""What is scored: both hips, then both knees."""
COLUMNS = np.array([next(i for i, dof in enumerate(LOWER_BODY) if dof.name == name) for name in JOINTS])
SAMPLE_S = 0.01
"""s. S is stated for samples at 100 Hz, whatever the rate of the recording."""
DEFAULT_S = NoiseModel().jerk_density / SAMPLE_S
"""(rad/s^3)^2."""


@dataclass(frozen=True)
class Recording:
    """A session, its calibration, and the samples that the node would estimate from."""

    description: SessionDescription
    sensors: list[SensorDescription]
    calibrated: Calibrated
    ticks: list[Tick]


@dataclass(frozen=True)
class FilterRun:
    """What a filter made of a recording with n samples and S sensors."""

    time_s: FloatArray
    """s, (n,)."""
    state: FloatArray
    """rad, rad/s, rad/s^2 of JOINTS, (3, n, 4)."""
    surprise: FloatArray
    """Sample minus prediction, rad/s three times and m/s^2 three times, (n, S, 6); NaN where there was no sample."""
    phase: FloatArray
    """rad, (n,), of the rhythm that drives the filter; of the plain filter, of the rhythm that runs beside it."""
    frequency: FloatArray
    """rad/s, (n,)."""
    locked: NDArray[np.bool_]
    """(n,) whether the rhythm claims to be right. The published one always does."""


def calibrate(spec: str) -> Recording:
    """Open a source and calibrate it.

    Raises:
        SourceError: it cannot be opened.
        ValueError: the calibrator finds nothing.
    """
    source = open_source(spec, session="joukov", estimator="ekf")
    description, parameters = source.describe(), EstimationParameters()
    intake = Intake(description, parameters, used_by_lower_body(description))
    calibrator = Calibrator(description, intake.sensors, parameters)
    calibrated: Calibrated | None = None
    ticks: list[Tick] = []
    for message in iter_messages(source):
        if message.stream.signal is not IMU or message.payload is None:
            continue
        for tick in (tick for batch in intake.accept(message) for tick in batch.ticks):
            if calibrated is not None:
                ticks.append(tick)
                continue
            calibrated = calibrator.add(TickBatch(tick.captured_ns, (tick,)), intake.checks)
            if calibrated is not None:
                ticks += [kept for batch in calibrator.batches for kept in batch.ticks]
    if calibrated is None:
        raise ValueError(f"{spec} cannot be calibrated; give it standing and some strides")
    return Recording(description, intake.sensors, calibrated, ticks)


def run_filter(recording: Recording, estimator: str, parameters: FilterParameters) -> FilterRun:
    """One estimator over a recording."""
    description = recording.description.model_copy(update={"estimator": estimator})
    running = LowerBodyFilter(description, recording.sensors, recording.calibrated, parameters)
    knee = running.model.names.index("knee_flexion_right")
    published = JoukovOscillator(1) if estimator == "rhythmic_ekf_joukov" else None
    states, surprises, rhythms = [], [], []
    last_ns = recording.ticks[0].captured_ns
    for tick in recording.ticks:
        weights = running.ekf.companions.weight.copy()
        row = running.fuse(tick)
        surprise = _surprise(running.ekf, weights)
        surprise[~(tick.fresh & recording.calibrated.alignment.aligned)] = np.nan
        reading = row.rhythm
        if published is not None:
            # The oscillator within the filter takes phase and frequency from this velocity alone.
            reading = published.step(running.ekf.x[1, knee : knee + 1], (tick.captured_ns - last_ns) / 1e9)
        last_ns = tick.captured_ns
        states.append([row.position, row.velocity, row.acceleration])
        surprises.append(surprise)
        rhythms.append((reading.phase, reading.frequency, float(reading.locked)))
    rhythm = np.array(rhythms)
    return FilterRun(
        np.array([tick.captured_ns for tick in recording.ticks]) / 1e9,
        np.array(states)[:, :, COLUMNS].transpose(1, 0, 2),
        np.array(surprises),
        rhythm[:, 0],
        rhythm[:, 1],
        rhythm[:, 2] > 0.5,
    )


def _surprise(ekf: LowerBodyEkf, weights: FloatArray) -> FloatArray:
    """Innovations (S, 6) of what was believed before the sample: each companion's as far as it had its `weights`."""
    companions = ekf.companions
    levels = ekf.innovations()
    surprise: FloatArray = levels[0].copy()
    believed = np.ones(levels.shape[1])
    for c in range(len(levels) - 1):
        believed = believed * (weights[c] @ companions.member)
        surprise += believed[:, None] * (levels[c + 1] - levels[c])
    return surprise


def with_noise(parameters: FilterParameters, S: float) -> FilterParameters:
    """The same filter with jerk variance S per sample of 10 ms, (rad/s^3)^2."""
    return replace(parameters, noise=replace(parameters.noise, jerk_density=S * SAMPLE_S))


def sensors_on(recording: Recording, segments: tuple[Segment, ...]) -> list[int]:
    """Indices of the aligned sensors on some segments."""
    aligned = recording.calibrated.alignment.aligned
    return [i for i, sensor in enumerate(recording.sensors) if sensor.segment in segments and aligned[i]]
