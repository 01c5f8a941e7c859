"""Going on without a sensor: while it is silent, it is taken to say what it said at this phase in the strides before.

The rhythm, which the other sensors carry on, tells the phase. The filter takes the remembered sample like a measured
one, so its covariance stays what it is when everyone speaks, and the return of the sensor is no event: within a stride
accelerometers measure far more than gravity, and a filter that had become unsure would believe them. Joints that only
the silent sensor could tell are led to where they were at this phase, since a sum of remembered rates drifts. How
far strides have differed is added to the deviation of these joints.

Nobody is stood in for while what the others say is not what they said at this phase: a stop, a turn, a stumble.
"""

from collections.abc import Sequence
from math import exp, pi

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import PARENT_SEGMENT, LowerBodyModel
from services.biomech.lower_body_ekf import LowerBodyEkf
from services.biomech.rhythm.reading import RhythmReading
from services.biomech.rhythm.stride_shape import Expected, StrideShape
from services.estimation.lower_body.stride_buffer import StrideBuffer
from services.estimation.parameters import CoastingParameters
from services.estimation.samples import FORCE, RATE, Tick
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

PHASES = 61
"""Phases that are tried after a gap of everyone, within three standard deviations."""


class Coasting:
    """Stands in for silent sensors. Channels of its memory: three per sensor (force and rate), then the joints."""

    def __init__(self, model: LowerBodyModel, segments: Sequence[Segment], parameters: CoastingParameters) -> None:
        self.parameters = parameters
        self._model = model
        self._segments = list(segments)
        self._sensed = 3 * len(segments)
        channels = self._sensed + len(model.dofs)
        floor = np.ones((2, channels))
        floor[0, : self._sensed], floor[1, : self._sensed] = parameters.least_force_std, parameters.least_rate_std
        self._shape = StrideShape(floor, parameters.strides)
        self._values, self._heard = np.zeros((2, channels)), np.zeros(channels, dtype=np.bool_)
        self._recent = StrideBuffer(channels, parameters.buffer_s, parameters.buffer_every_s)
        self._phase, self._frequency, self._locked = 0.0, 0.0, False
        self._surprise = 0.0
        self._ended: frozenset[Segment] = frozenset()
        self._found = False  # this tick ended a gap of everyone, and its phase is known
        self.followed: frozenset[Segment] = frozenset()
        """Segments whose sensors are stood in for."""
        self.deviation = np.zeros(len(model.dofs))
        """(n,) rad, what coasting adds to the deviations of positions."""

    def stand_in(self, tick: Tick, heard_ns: Sequence[int], aligned: Flags, dt_s: float) -> Tick:
        """The tick, dt_s after the one before, with samples of the sensors that have been silent for a while.

        `heard_ns` (S,): when each sensor spoke last; only `aligned` (S,) ones are stood in for.
        """
        before, self.followed = self.followed, frozenset()
        filled = tick
        if not tick.fresh.all() and self._locked and self._surprise <= self.parameters.most_surprise:
            age_s = (tick.captured_ns - np.array(heard_ns)) * 1e-9
            silent = aligned & (age_s > self.parameters.after_s) & (age_s < self.parameters.longest_s)
            filled = self._fill(tick, silent, dt_s)
            self.followed = frozenset(self._segments[s] for s in np.flatnonzero(filled.fresh & ~tick.fresh))
        self._ended = before - self.followed
        return filled

    def _fill(self, tick: Tick, silent: Flags, dt_s: float) -> Tick:
        expected = self._shape.expect(self._phase + self._frequency * dt_s)
        filled = silent & expected.known[: self._sensed : 3]
        if not filled.any():
            return tick
        samples = tick.samples.copy()
        samples[filled, FORCE] = expected.value[0, : self._sensed].reshape(-1, 3)[filled]
        samples[filled, RATE] = expected.value[1, : self._sensed].reshape(-1, 3)[filled]
        return Tick(tick.captured_ns, samples, tick.fresh | filled)

    def lead(self, ekf: LowerBodyEkf, dt_s: float) -> Array:
        """After the filter took the tick: lead the joints of the followed segments, and say what they are worth.

        Returns the way (n,) by which joints were led, rad.
        """
        led = np.zeros(len(self.deviation))
        blind = self._blind(self.followed)
        self.deviation[~blind] *= exp(-dt_s / self.parameters.fade_s)
        if not self.followed:
            return led
        expected = self._shape.expect(self._phase + self._frequency * dt_s)
        joints = blind & expected.known[self._sensed :]
        joints[self._model.first_rotation] = False  # the heading of the body has no place in a stride
        share = 1.0 - exp(-dt_s / self.parameters.lead_s)
        led[joints] = share * (expected.value[0, self._sensed :] - ekf.estimate[0])[joints]
        ekf.shift(led)
        self.deviation[joints] += share * (expected.std[0, self._sensed :] - self.deviation)[joints]
        return led

    def learn(
        self, reading: RhythmReading, dt_s: float, tick: Tick, estimate: Array, doubtful: frozenset[Segment]
    ) -> list[Segment]:
        """Take a tick as it was measured and the joints (3, n) after it, but those at a `doubtful` segment.

        Returns the segments that should not have been stood in for: the others, or the sensor itself on its return,
        say that the walk went on otherwise.
        """
        was_locked, self._locked = self._locked, reading.locked
        self._phase, self._frequency = reading.phase, reading.frequency
        self._note(tick, estimate, doubtful)
        if not reading.locked:
            self._surprise, self._found = 0.0, False
            self._recent.add(dt_s, self._values, self._heard)
            return sorted(self._ended)
        turns_per_s = reading.frequency / (2.0 * pi)
        if not was_locked:
            for age_s, since_s, values, heard in self._recent.take(2.0 / turns_per_s):
                self._shape.learn(
                    reading.phase - reading.frequency * (age_s + dt_s), turns_per_s * since_s, values, heard
                )
        self._shape.learn(reading.phase, turns_per_s * dt_s, self._values, self._heard)
        return self._wrong(tick, dt_s)

    def _note(self, tick: Tick, estimate: Array, doubtful: frozenset[Segment]) -> None:
        sensed = self._sensed
        self._values[0, :sensed] = tick.samples[:, FORCE].reshape(-1)
        self._values[1, :sensed] = tick.samples[:, RATE].reshape(-1)
        self._values[:, sensed:] = estimate[:2]
        self._heard[:sensed].reshape(-1, 3)[:] = tick.fresh[:, None]
        self._heard[sensed:] = ~self._blind(doubtful | self.followed)

    def _wrong(self, tick: Tick, dt_s: float) -> list[Segment]:
        """Follow how surprising the gyroscopes are; whose stand-in ended in a surprise."""
        surprise = self._shape.surprise[1, : self._sensed].reshape(-1, 3)
        if tick.fresh.any():
            share = 1.0 - exp(-dt_s / self.parameters.surprise_s)
            self._surprise += share * (float(surprise[tick.fresh].mean()) - self._surprise)
        if self._found:
            self._found = False  # the rhythm is not there yet: its phase proves nobody wrong
            return []
        return [
            segment
            for s, segment in enumerate(self._segments)
            if segment in self._ended
            and (not tick.fresh[s] or surprise[s].mean() > self.parameters.most_surprise_on_return)
        ]

    def steps(self, last_ns: int, tick: Tick) -> list[Tick]:
        """Ticks without samples that lead through a gap of everyone; none where the strides do not tell the way."""
        p = self.parameters
        gap_s = (tick.captured_ns - last_ns) * 1e-9
        if not (self._locked and p.after_s < gap_s < p.longest_s and self._surprise <= p.most_surprise):
            return []
        if not self._shape.expect(self._phase).known[: self._sensed].all():
            return []
        count = round(gap_s / p.step_s)
        times = np.linspace(last_ns, tick.captured_ns, count + 1)[1:-1].round().astype(np.int64).tolist()
        return [Tick(ns, np.zeros_like(tick.samples), np.zeros_like(tick.fresh)) for ns in times]

    def realign(self, ekf: LowerBodyEkf, tick: Tick, gap_s: float) -> bool:
        """The first tick after a gap of everyone: nobody has watched the phase, now all sensors tell it.

        Least squares over phases near the one expected, each difference in standard deviations; the joints go along.
        Returns whether the walk went on at all.
        """
        doubt = self.parameters.frequency_change * self._frequency * gap_s
        likely = self._phase + self._frequency * self.parameters.step_s
        best, surprise, moved = np.inf, np.inf, np.zeros((2, len(self._model.dofs)))
        for shift in np.linspace(-3.0, 3.0, PHASES) * doubt:
            at = self._shape.expect(likely + shift)
            differences = self._differences(tick, at)
            cost = float(differences.sum()) + (shift / doubt) ** 2
            if cost < best:
                best, surprise, moved = cost, float(differences.mean()), at.value[:, self._sensed :].copy()
        way = moved - self._shape.expect(likely).value[:, self._sensed :]
        way[0, self._model.first_rotation] = 0.0  # the heading again
        ekf.x[:2] += way
        ekf.companions.x[:, :2] += way
        ekf.estimate[:2] += way
        self._found = surprise <= self.parameters.most_surprise_after_gap
        return self._found

    def _differences(self, tick: Tick, expected: Expected) -> Array:
        """Squared differences of those gyroscopes that speak from what is expected, in variances."""
        rate, std = (part[1, : self._sensed].reshape(-1, 3) for part in (expected.value, expected.std))
        variance = std**2 + self.parameters.least_rate_std**2
        return np.asarray(((tick.samples[:, RATE] - rate) ** 2 / variance)[tick.fresh])

    def _blind(self, silent: frozenset[Segment]) -> Flags:
        """(n,) joints that nothing measures while these segments are silent: those at either end of them."""
        joints = np.zeros(len(self._model.dofs), dtype=np.bool_)
        for segment in SEGMENTS if silent else ():
            if segment in silent or PARENT_SEGMENT.get(segment, segment) in silent:
                joints[self._model.joints_of(segment)] = True
        return joints

    def snapshot(self) -> State:
        """What was learned, and where the rhythm was."""
        return {
            "shape": self._shape.snapshot(),
            "recent": self._recent.snapshot(),
            "rhythm": [self._phase, self._frequency, self._locked],
            "surprise": self._surprise,
            "followed": sorted(self.followed),
            "deviation": pack_array(self.deviation),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._shape.restore(state["shape"])
        self._recent.restore(state["recent"])
        self._phase, self._frequency, self._locked = state["rhythm"]
        self._surprise = state["surprise"]
        self.followed = frozenset(Segment(name) for name in state["followed"])
        self.deviation[:] = unpack_array(state["deviation"])
