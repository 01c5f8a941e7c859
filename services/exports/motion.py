"""Angles and joint centres of a session as arrays, and the same at even times."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointCentres, JointState
from schemas.payload import Payload
from schemas.session import SessionDescription
from services.exports.errors import ExportError
from services.exports.facts import freedoms_of
from services.exports.parameters import LONGEST_STEP, MOST_SAMPLES, MOSTLY, ROWS_AT_A_TIME

Array = NDArray[np.float64]
Times = NDArray[np.int64]
Flags = NDArray[np.bool_]

_SAME_TIME_S = 1e-6
"""Sensors stamp no finer."""
_JITTER = 0.005
_NEAR_NOMINAL = 0.02
"""Shares of a period and of a rate."""


class Track(NamedTuple):
    """Quantities over time: n samples of m quantities with k components each."""

    times_ns: Times  # (n,) session time, rising
    value: Array  # (n, m, k); 0 where not valid
    valid: Flags  # (n, m)

    @property
    def mostly_valid(self) -> Flags:
        """(m,) quantities that are valid in nearly all samples in which anything is."""
        told = self.valid.any(axis=1)
        count = int(told.sum())
        return self.valid[told].mean(axis=0) >= MOSTLY if count else np.zeros(self.valid.shape[1], dtype=bool)


class Motion(NamedTuple):
    """What moves in a session. `angles` are rad, in the order of BODY_MODELS[model]; `centres` m, of JointCentre."""

    model: str
    angles: Track
    centres: Track | None

    def angle(self, name: str) -> tuple[Array, Flags]:
        """(n,) rad of one degree of freedom and whether it is valid. Raises KeyError."""
        names = [freedom.name for freedom in freedoms_of(self.model)]
        if name not in names:
            raise KeyError(name)
        at = names.index(name)
        return self.angles.value[:, at, 0], self.angles.valid[:, at]

    @property
    def told(self) -> frozenset[str]:
        """Degrees of freedom that are valid nearly all the time."""
        names = [freedom.name for freedom in freedoms_of(self.model)]
        return frozenset(name for name, mostly in zip(names, self.angles.mostly_valid, strict=True) if mostly)


def gather_motion(payloads: Iterable[Payload]) -> Motion:
    """Joint states (and centres, where a camera told them) as arrays.

    Raises ExportError: there is none, one is valid nowhere, there are too many, or two body models follow each other.
    """
    angles, centres, model = _Pieces(), _Pieces(), None
    for payload in payloads:
        if isinstance(payload, JointState):
            if model not in (None, payload.model):
                raise ExportError("joint_state.model", f"{model}, then {payload.model}", "export joint_angles.csv")
            model = payload.model
            angles.add(payload.captured_ns, payload.position, payload.valid)
        elif isinstance(payload, JointCentres):
            centres.add(payload.captured_ns, payload.position, payload.seen)
    if model is None:
        raise ExportError("joint_state", "the session holds none", "run it to its first seconds of walking")
    freedoms_of(model)
    track = angles.track()
    if not track.valid.any():
        raise ExportError("joint_state.valid", "no angle is valid at any time", "check the calibration of the session")
    return Motion(model, track, centres.track() if centres.count else None)


def even_rate_hz(times_ns: Times, nominal_hz: Iterable[float] = ()) -> float:
    """Samples a second of most of a track, to 0.001 Hz; 1 for a single sample.

    Where the times jitter, as a camera's do, a nominal rate within 2 % is taken instead.
    """
    if times_ns.size < 2:
        return 1.0
    steps = np.diff(times_ns) * 1e-9
    rate = 1.0 / float(np.median(steps))
    if float(np.median(np.abs(steps * rate - 1.0))) > _JITTER:
        rate = next((nominal for nominal in nominal_hz if abs(rate / nominal - 1.0) < _NEAR_NOMINAL), rate)
    return round(rate, 3)


def nominal_rates_hz(description: SessionDescription) -> list[float]:
    """Of everything that measures in a session, the slowest first."""
    sensors = [sensor.rate_hz for hub in description.hubs for sensor in hub.sensors]
    return sorted({*sensors, *(camera.rate_hz for camera in description.cameras)})


def even_times(times_ns: Times, rate_hz: float) -> Times:
    """From the first sample to the last, ns."""
    count = int(np.floor((times_ns[-1] - times_ns[0]) * 1e-9 * rate_hz + 0.5)) + 1
    return np.asarray(times_ns[0] + np.round(np.arange(count) * (1e9 / rate_hz)).astype(np.int64))


def resampled(track: Track, times_ns: Times, rate_hz: float) -> Track:
    """A track at other times, which rise: cubic Hermite with slopes from the neighbours, exact at the samples.

    Not valid outside the track, beside an invalid sample, and in gaps. A lone sample is valid at its own time only.
    Parts of `times_ns` give the same values as all of it.
    """
    if track.times_ns.size < 2:
        here = times_ns == track.times_ns[0]
        valid = track.valid & here[:, None]
        return Track(times_ns, np.where(valid[..., None], track.value, 0.0), valid)
    track = _around(track, times_ns)
    after = np.clip(np.searchsorted(track.times_ns, times_ns, side="left"), 1, track.times_ns.size - 1)
    before = after - 1
    step = (track.times_ns[after] - track.times_ns[before]) * 1e-9
    u = (times_ns - track.times_ns[before]) * 1e-9 / step
    u = np.where(np.abs(np.rint(u) - u) * step < _SAME_TIME_S, np.rint(u), u)
    first, last = track.valid[before], track.valid[after]
    between = (u >= 0.0) & (u <= 1.0) & (step * rate_hz <= LONGEST_STEP)
    valid = (first & (u == 0.0)[:, None]) | (last & (u == 1.0)[:, None]) | (first & last & between[:, None])
    u_step = np.stack([u, step]).astype(np.float64)[:, :, None, None]
    value = _hermite(track, before, after, u_step[0], u_step[1])
    return Track(times_ns, np.where(valid[..., None], value, 0.0), valid)


def _around(track: Track, times_ns: Times) -> Track:
    """The samples that count for some times, with a neighbour on each side for the slopes."""
    n = track.times_ns.size
    first = max(int(np.searchsorted(track.times_ns, times_ns[0], side="left")) - 2, 0)
    end = min(int(np.searchsorted(track.times_ns, times_ns[-1], side="left")) + 2, n)
    first = min(first, max(end - 2, 0))
    span = slice(first, max(end, first + 2))
    return Track(track.times_ns[span], track.value[span], track.valid[span])


def _slopes(track: Track) -> Array:
    """Derivative at each sample from both its neighbours; beside an invalid sample, and at the ends, from one."""
    steps = (np.diff(track.times_ns) * 1e-9)[:, None, None]
    secant = np.diff(track.value, axis=0) / steps
    slope = np.concatenate([secant[:1], secant])
    slope[1:-1] = (steps[1:] * secant[:-1] + steps[:-1] * secant[1:]) / (steps[:-1] + steps[1:])
    broken_before, broken_after = ~track.valid[:-2, :, None], ~track.valid[2:, :, None]
    slope[1:-1] = np.where(broken_before, secant[1:], slope[1:-1])
    slope[1:-1] = np.where(broken_after, secant[:-1], slope[1:-1])
    return np.asarray(slope)


def _hermite(track: Track, before: Times, after: Times, u: Array, step: Array) -> Array:
    slope = _slopes(track)
    h = u * u * (3.0 - 2.0 * u)
    return np.asarray(
        (1.0 - h) * track.value[before]
        + h * track.value[after]
        + step * (u * (1.0 - u) ** 2 * slope[before] - u * u * (1.0 - u) * slope[after])
    )


class _Pieces:
    """Batches of a track as they come, kept in blocks: a message may be one sample, and an hour has 360 000."""

    def __init__(self) -> None:
        self.count = 0
        self._blocks: list[Track] = []
        self._times: list[int] = []
        self._rows: list[list[Any]] = []
        self._valid: list[list[bool]] = []

    def add(self, captured_ns: list[int], rows: list[list[Any]], valid: list[bool]) -> None:
        self.count += len(captured_ns)
        if self.count > MOST_SAMPLES:
            next_step = "export joint_angles.csv or mcap, which are written as they are read"
            raise ExportError("joint_state", f"more than {MOST_SAMPLES} samples", next_step)
        self._times += captured_ns
        self._rows += rows
        self._valid += [valid] * len(captured_ns)
        if len(self._times) >= ROWS_AT_A_TIME:
            self._close_block()

    def track(self) -> Track:
        """All of it, in order of time, each time once."""
        if self._times:
            self._close_block()
        times = np.concatenate([block.times_ns for block in self._blocks])
        value = np.concatenate([block.value for block in self._blocks])
        valid = np.concatenate([block.valid for block in self._blocks])
        self._blocks.clear()
        if np.all(np.diff(times) > 0):
            return Track(times, value, valid)
        times, rising = np.unique(times, return_index=True)
        return Track(times, value[rising], valid[rising])

    def _close_block(self) -> None:
        value = np.array(self._rows, dtype=np.float64)
        value = value[..., None] if value.ndim == 2 else value
        valid = np.array(self._valid, dtype=bool)
        value[~valid] = 0.0
        self._blocks.append(Track(np.array(self._times, dtype=np.int64), value, valid))
        self._times, self._rows, self._valid = [], [], []
