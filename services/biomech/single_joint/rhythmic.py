"""The Rhythmic EKF of one joint over a whole recording: plain, as published, and with the rhythm that is trusted.

After each sample the estimated velocity goes to the rhythm, whose jerk goes into the prediction of the next sample.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.biomech.kernels.evidence import bold_share
from services.biomech.rhythm import joukov, trusted
from services.biomech.rhythm.memory import Bench, Memory, allocate_memory, prepare_bench
from services.biomech.rhythm.parameters import JoukovParameters, TrustedParameters
from services.biomech.single_joint.adaptive_noise import AdaptiveNoise, noise_share
from services.biomech.single_joint.compiled import compiled
from services.biomech.single_joint.ekf import VELOCITY, JointSensor, JointState, advance_joint, start_joint
from services.biomech.single_joint.innovation_gate import InnovationGate

FloatArray = NDArray[np.float64]

SENSOR = JointSensor()
GATE = InnovationGate()
NO_GATE = InnovationGate(doubt=-1e9, refusal=-2e9)
CONSTANT_NOISE = AdaptiveNoise(floor=1.0)


@dataclass(frozen=True)
class Track:
    """What a filter made of a recording of n samples."""

    state: FloatArray
    """Position rad, velocity rad/s, acceleration rad/s^2, shape (n, 3)."""
    rhythm: FloatArray
    """Phase rad, frequency rad/s, quality, locked (0 or 1), shape (n, 4); zeros without rhythm."""


@compiled
def _run_plain(
    joint: JointState,
    samples: FloatArray,
    dt_s: float,
    density: float,
    variances: FloatArray,
    offset_m: float,
    state: FloatArray,
) -> None:
    for i in range(samples.shape[0]):
        advance_joint(joint, samples[i], dt_s, 0.0, density, variances, offset_m)
        state[i] = joint.x


@compiled
def _run_published(
    joint: JointState,
    oscillator: FloatArray,
    series: FloatArray,
    rates: FloatArray,
    samples: FloatArray,
    dt_s: float,
    density: float,
    variances: FloatArray,
    offset_m: float,
    state: FloatArray,
    rhythm: FloatArray,
) -> None:
    velocity, error, jerk = np.zeros(1), np.zeros(1), np.zeros(1)
    for i in range(samples.shape[0]):
        advance_joint(joint, samples[i], dt_s, jerk[0], density, variances, offset_m)
        state[i] = joint.x
        velocity[0] = joint.x[VELOCITY]
        joukov.advance(oscillator, series, error, rates, 0, velocity, dt_s, rhythm[i])
        rhythm[i, 3] = 1.0
        joukov.differentiate_twice(series, oscillator[joukov.PHASE], oscillator[joukov.FREQUENCY], jerk)


@compiled
def _run_trusted(
    filters: tuple[JointState, JointState, JointState],
    memory: Memory,
    bench: Bench,
    samples: FloatArray,
    dt_s: float,
    density: float,
    variances: FloatArray,
    offset_m: float,
    noise: tuple[float, float, float],
    gate: tuple[float, float, float],
    state: FloatArray,
    rhythm: FloatArray,
) -> None:
    """From plain over rhythmic to rhythmic with less process noise, each as far as the innovations agree."""
    plain, rhythmic, bold = filters
    loop, channel, parameters = memory.loop[0], memory.channels[0], bench.parameters[0]
    powers, evidence, evidence_bold, velocity = np.zeros(3), np.zeros(2), np.zeros(2), np.zeros(1)
    share, is_adaptive = 1.0, noise[1] < 1.0
    for i in range(samples.shape[0]):
        jerk = bench.jerk[0]
        squared, log_det = advance_joint(plain, samples[i], dt_s, 0.0, density, variances, offset_m)
        squared_r, log_det_r = advance_joint(rhythmic, samples[i], dt_s, jerk, density, variances, offset_m)
        weight = bold_share(evidence, squared + log_det - squared_r - log_det_r, dt_s, gate[0], gate[1], gate[2])
        weight_bold = 0.0
        if is_adaptive:
            squared, log_det = advance_joint(bold, samples[i], dt_s, jerk, share * density, variances, offset_m)
            weight_bold = weight * bold_share(
                evidence_bold, squared_r + log_det_r - squared - log_det, dt_s, gate[0], gate[1], gate[2]
            )
        for k in range(3):
            state[i, k] = plain.x[k] + weight * (rhythmic.x[k] - plain.x[k])
            state[i, k] += weight_bold * (bold.x[k] - rhythmic.x[k])
        velocity[0] = state[i, VELOCITY]
        trusted.advance(memory, bench, velocity, dt_s)
        trusted.read(loop, rhythm[i])
        share = noise_share(powers, loop, channel, dt_s, noise[0], noise[1], noise[2], parameters)


def track_plain(samples: FloatArray, dt_s: float, jerk_density: float, sensor: JointSensor = SENSOR) -> Track:
    """The EKF without rhythm, eq. (10)-(12). Samples (n, 3) as for `SingleJointEkf.step`; density in rad^2/s^5."""
    state = np.empty((samples.shape[0], 3))
    _run_plain(start_joint(), samples, dt_s, jerk_density, sensor.variances, sensor.offset_m, state)
    return Track(state, np.zeros((samples.shape[0], 4)))


def track_published(
    samples: FloatArray, dt_s: float, jerk_density: float, parameters: JoukovParameters, sensor: JointSensor = SENSOR
) -> Track:
    """The Rhythmic EKF as published, eq. (10)-(21)."""
    state, rhythm = np.empty((samples.shape[0], 3)), np.zeros((samples.shape[0], 4))
    oscillator = np.array([0.0, parameters.initial_frequency, 0.0, 0.0])
    rates = np.array(
        [
            parameters.frequency_rate,
            parameters.coefficient_rate,
            parameters.largest_frequency,
            parameters.quality_time_s,
        ]
    )
    series = np.zeros((2, 1, parameters.harmonics))
    _run_published(
        start_joint(), oscillator, series, rates, samples, dt_s, jerk_density, sensor.variances, sensor.offset_m, state,
        rhythm,
    )  # fmt: skip
    return Track(state, rhythm)


def track_trusted(
    samples: FloatArray,
    dt_s: float,
    jerk_density: float,
    parameters: TrustedParameters,
    noise: AdaptiveNoise = CONSTANT_NOISE,
    gate: InnovationGate = GATE,
    sensor: JointSensor = SENSOR,
) -> Track:
    """The EKF with the jerk of `TrustedRhythm`; `noise` is an option that is off by default."""
    state, rhythm = np.empty((samples.shape[0], 3)), np.zeros((samples.shape[0], 4))
    _run_trusted(
        (start_joint(), start_joint(), start_joint()), allocate_memory(1, parameters), prepare_bench(1, parameters),
        samples, dt_s, jerk_density, sensor.variances, sensor.offset_m, (noise.factor, noise.floor, noise.periods),
        (gate.memory_s, gate.doubt, gate.refusal), state, rhythm,
    )  # fmt: skip
    return Track(state, rhythm)
