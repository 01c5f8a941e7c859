"""The memory of `TrustedRhythm`: records and arrays that compiled code works on in place."""

from dataclasses import astuple, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.rhythm.parameters import TrustedParameters
from services.flow.node import State, pack_array, unpack_array

FloatArray = NDArray[np.float64]
Record = Any
"""One element of a structured array. Compiled code reads and writes its fields as attributes."""

SEARCHING, LOCKED, STANDING = 0.0, 1.0, 2.0
"""Values of `stage`."""

PHASES = 64
"""Phases per turn at which a known waveform is compared with the motion."""


def _record_type(*names: str) -> np.dtype[np.void]:
    return np.dtype([(name, np.float64) for name in names])


LOOP = _record_type(
    "phase",  # rad, unwrapped
    "frequency",  # rad/s, lambda of the loop
    "frequency_mean",  # rad/s, as old as what the correlation knows
    "stage",
    "quality",
    "residual_power",  # of the weighted, filtered error; energies are the unit
    "signal_power",  # of the weighted, filtered velocity
    "phase_error_mean",  # rad, over half a period
    "phase_error_variance",  # rad^2, about that mean
    "since_lock_s",
    "slip_s",  # how long loop and correlation have disagreed
    "elapsed_s",  # of data in the correlator
    "candidate_period_s",  # 0 = none
    "candidate_s",  # how long the candidate has stood
    "correlation",  # NSDF at the last period found
    "grid_s",  # since the last grid point
    "grid_count",
    "resting_s",
    "unused_s",  # time of samples that could not be used
    "has_template",
    "known_frequency",  # rad/s of the known waveform; 0 = nothing is known
    "is_provisional",  # the lock comes from the known waveform and is not confirmed by the correlation
    "recall_spent",  # a recognition has failed since the search began
    "match_frequency",  # rad/s of the last believable match; 0 = none
    "match_phase",  # rad, at match_s
    "match_s",  # s on the grid
    "since_known_s",  # since the waveform was last kept as known
)

CHANNEL = _record_type(
    "smooth",  # rad/s, after the first low-pass
    "filtered",  # rad/s, after the second: u of the detection
    "filtered_before",
    "energy",  # (rad/s)^2, slow mean of u^2; its inverse weighs the channel
    "recent_energy",  # (rad/s)^2, fast mean of u^2
    "walking_energy",  # (rad/s)^2, mean of u^2 while locked; 0 otherwise
    "cell",  # rad, velocity integrated since the last grid point
    "error",  # rad/s, velocity minus waveform
    "error_smooth",
    "error_filtered",
)

PARAMETERS = _record_type(*(field.name for field in fields(TrustedParameters)))


class Memory(NamedTuple):
    """Everything that changes. C channels, N harmonics, L lags, H values of raw history.

    Histories are written twice, H (L) apart, so that the latest values are always contiguous.
    """

    loop: NDArray[np.void]  # (1,) LOOP
    channels: NDArray[np.void]  # (C,) CHANNEL
    waveform: FloatArray  # (2, C, N) rad/s: cosine and sine coefficients
    template: FloatArray  # (2, C, N) rad/s: the waveform that holds the phase reference
    known: FloatArray  # (2, C, N) rad/s: a waveform that was right, to recognise the motion by
    products: FloatArray  # (C, L) (rad/s)^2: running sum of u(t) u(t - lag)
    squares: FloatArray  # (C, L) (rad/s)^2: running sum of u(t)^2 + u(t - lag)^2
    raw_history: FloatArray  # (C, 2H) rad/s: cell means
    filtered_history: FloatArray  # (C, 2L) rad/s: u on the grid


class Bench(NamedTuple):
    """What follows from the parameters, and scratch room. Nothing here outlives a step."""

    parameters: NDArray[np.void]  # (1,) PARAMETERS
    velocity: FloatArray  # (C,) rad/s, the sample within its bounds
    forgetting: FloatArray  # (L,) factor of the running sums per grid point
    correlation: FloatArray  # (L,) scratch
    harmonic: FloatArray  # (2, N) scratch: cos k phase, sin k phase
    turns: FloatArray  # (2, PHASES, N) cos and sin of k times each phase of a turn
    jerk: FloatArray  # (C,) rad/s^3, result
    reading: FloatArray  # (4,) phase, frequency, quality, locked, result


def lag_count(parameters: TrustedParameters) -> int:
    """L: lags of the correlator, up to 1.05 of the longest period."""
    return int(1.05 / parameters.lowest_frequency_hz / parameters.grid_interval_s) + 2


def history_count(parameters: TrustedParameters) -> int:
    """H: raw values kept, enough to seed from the longest period."""
    longest_s = (parameters.seed_periods + 0.2) / parameters.lowest_frequency_hz
    return int(longest_s / parameters.grid_interval_s) + 4


def allocate_memory(channels: int, parameters: TrustedParameters) -> Memory:
    """A memory that has seen nothing."""
    lags, history = lag_count(parameters), history_count(parameters)
    return Memory(
        loop=np.zeros(1, LOOP),
        channels=np.zeros(channels, CHANNEL),
        waveform=np.zeros((2, channels, parameters.harmonics)),
        template=np.zeros((2, channels, parameters.harmonics)),
        known=np.zeros((2, channels, parameters.harmonics)),
        products=np.zeros((channels, lags)),
        squares=np.zeros((channels, lags)),
        raw_history=np.zeros((channels, 2 * history)),
        filtered_history=np.zeros((channels, 2 * lags)),
    )


def prepare_bench(channels: int, parameters: TrustedParameters) -> Bench:
    """Derive what the parameters fix."""
    lags = np.maximum(np.arange(lag_count(parameters)), 1)
    angles = np.outer(np.arange(PHASES) * (2.0 * np.pi / PHASES), np.arange(1, parameters.harmonics + 1))
    return Bench(
        parameters=np.array([astuple(parameters)], PARAMETERS),
        velocity=np.zeros(channels),
        forgetting=np.exp(-1.0 / (parameters.memory_lags * lags)),
        correlation=np.zeros(lags.size),
        harmonic=np.zeros((2, parameters.harmonics)),
        turns=np.stack([np.cos(angles), np.sin(angles)]),
        jerk=np.zeros(channels),
        reading=np.zeros(4),
    )


def pack_memory(memory: Memory) -> State:
    """The memory as JSON values; of the doubled histories only one half."""
    plain = {name: array.view(np.float64) if array.dtype.names else array for name, array in memory._asdict().items()}
    for name in ("raw_history", "filtered_history"):
        plain[name] = plain[name][:, : plain[name].shape[1] // 2]
    return {name: pack_array(array) for name, array in plain.items()}


def unpack_memory(state: State, memory: Memory) -> None:
    """Fill `memory` from what `pack_memory` gave for one of the same shapes.

    Raises:
        ValueError: the snapshot is of an estimator with other channels or parameters.
    """
    for name, array in memory._asdict().items():
        saved = unpack_array(state[name])
        if name.endswith("_history"):
            saved = np.tile(saved, (1, 2))
        target = array.view(np.float64) if array.dtype.names else array
        if saved.shape != target.shape:
            raise ValueError(f"rhythm snapshot: {name} has shape {saved.shape}, this estimator needs {target.shape}")
        target[...] = saved
