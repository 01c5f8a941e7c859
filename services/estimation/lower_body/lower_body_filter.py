"""The filter of one session beside its rhythm: ticks in, one row of joint coordinates and rhythm out."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from schemas.session import SensorDescription, SessionDescription
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import LowerBodyModel, SensorMount
from services.biomech.lower_body_ekf import LowerBodyEkf
from services.biomech.rhythm.reading import RhythmReading
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.alignment import Alignment
from services.estimation.lower_body.coasting import Coasting
from services.estimation.lower_body.drivers import companions_of, driver_of
from services.estimation.lower_body.gap_filling import GapFilling, Step
from services.estimation.lower_body.resting_joints import rest_variances, valid_without
from services.estimation.lower_body.unmodelled import unmodelled_deviations
from services.estimation.parameters import FilterParameters
from services.estimation.rows import RHYTHM_CHANNELS, Row
from services.estimation.samples import Tick
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]


@dataclass
class Calibrated:
    """Standing and alignment, as the filter needs them."""

    alignment: Alignment
    gyro_bias: Array  # (S, 3) rad/s
    from_walking: bool = False  # nobody stood: the filter starts in motion, and zero is a population's
    marked: bool = False  # the operator marked the standing while the session ran


class LowerBodyFilter:
    """Extended Kalman filter with an optional rhythm that feeds it the jerk it expects."""

    def __init__(
        self,
        description: SessionDescription,
        sensors: list[SensorDescription],
        calibrated: Calibrated,
        parameters: FilterParameters,
    ) -> None:
        self.parameters = parameters
        self.model = LowerBodyModel(
            description.anthropometry, parameters.measurement.accel_sees_motion, parameters.soft_knees
        )
        self._segments = [sensor.segment for sensor in sensors]
        self._aligned = calibrated.alignment.aligned
        self._worn = {segment for segment, aligned in zip(self._segments, self._aligned, strict=True) if aligned}
        self._is_aligned: list[bool] = self._aligned.tolist()
        frames = calibrated.alignment.R_segment_from_sensor
        rate_hz = max((sensor.rate_hz for sensor in sensors), default=100.0)
        mounts = [_mount(sensor, R) for sensor, R in zip(sensors, frames, strict=True)]
        self.ekf = LowerBodyEkf(
            self.model,
            mounts,
            calibrated.gyro_bias,
            parameters.measurement,
            parameters.noise,
            companions_of(description.estimator, parameters, RHYTHM_CHANNELS, rate_hz),
        )
        longest_s = parameters.silent_after_s if parameters.closes_gaps else 0.0
        self._gaps = GapFilling(self.ekf, [sensor.rate_hz for sensor in sensors], longest_s)
        self._rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), parameters.rhythm)
        self._rhythm_joints = np.array([self.model.names.index(name) for name in RHYTHM_CHANNELS])
        self._driver, self._driver_joints = driver_of(description.estimator, self.model, self._rhythm, RHYTHM_CHANNELS)
        self._jerk = np.zeros(len(self.model.dofs))
        coasts = parameters.coasts and description.estimator == "rhythmic_ekf"
        self._coasting = Coasting(self.model, self._segments, parameters.coasting) if coasts else None
        self._followed: frozenset[Segment] = frozenset()
        self._starts_moving = calibrated.from_walking
        self._ahead = _ahead(parameters.sample_delay / rate_hz)
        self._unmodelled = unmodelled_deviations(self.model, parameters.unmodelled)
        self._last_ns: int | None = None
        self._heard_ns: list[int] = []
        self.unseen: frozenset[Segment] = frozenset(SEGMENTS)
        """Segments without an aligned sensor that spoke of late."""
        self._returned_ns: dict[Segment, int] = {}
        self._missing = self.unseen
        self.valid = self._valid_without(self._missing)
        """Per LOWER_BODY dof, after the newest tick."""
        self.observed = self._observed_without(self._missing)
        """Segments whose own sensor speaks and is not in doubt."""
        self._rest = self._rest_without(self.unseen)

    def continue_from(self, before: "LowerBodyFilter") -> None:
        """Take the place of a filter with another zero: the rhythm goes on, joints are in doubt as after a gap."""
        self._rhythm.restore(before._rhythm.snapshot())
        if self._driver is not None and before._driver is not None:
            self._driver.restore(before._driver.snapshot())
        self._heard_ns = list(before._heard_ns)
        self._starts_moving = True

    def _listen(self, tick: Tick) -> frozenset[Segment]:
        """Note who speaks; the segments that nobody speaks for. Everyone is given the start's benefit of the doubt."""
        if not self._heard_ns:
            self._heard_ns = [tick.captured_ns] * len(self._segments)
        oldest_ns = tick.captured_ns - round(self.parameters.silent_after_s * 1e9)
        unseen = set(SEGMENTS)
        for s, is_fresh in enumerate(tick.fresh.tolist()):
            if is_fresh:
                self._heard_ns[s] = tick.captured_ns
            if self._is_aligned[s] and self._heard_ns[s] >= oldest_ns:
                unseen.discard(self._segments[s])
        return frozenset(unseen)

    def _see(self, unseen: frozenset[Segment], now_ns: int) -> None:
        """What changes when a sensor falls silent or comes back."""
        for segment in sorted(self.unseen - unseen):
            if segment not in self._followed:
                self._loosen(segment)
            if self._last_ns is not None:
                self._returned_ns[segment] = now_ns
        self.unseen = unseen
        self._rest = self._rest_without(unseen - self._followed)

    def _judge(self, now_ns: int) -> None:
        """Which degrees of freedom are valid: seen, and not just come back."""
        doubt_ns = round(self.parameters.doubt_s * 1e9)
        self._returned_ns = {s: ns for s, ns in self._returned_ns.items() if now_ns - ns < doubt_ns}
        missing = self.unseen | frozenset(self._returned_ns)
        if missing != self._missing:
            self._missing = missing
            self.valid = self._valid_without(missing)
            self.observed = self._observed_without(missing)

    def _valid_without(self, missing: frozenset[Segment]) -> list[bool]:
        return valid_without(self.model, missing)

    @staticmethod
    def _observed_without(missing: frozenset[Segment]) -> list[Segment]:
        return [segment for segment in SEGMENTS if segment not in missing]

    def fuse(self, tick: Tick) -> Row:
        """Advance to the tick and take its samples in; through a gap of everyone in steps, where strides tell how."""
        if self._coasting is not None and self._last_ns is not None:
            first_ns, steps = self._last_ns, self._coasting.steps(self._last_ns, tick)
            for step in steps:
                self._advance(step, self._coasting)
            if steps:
                self._gaps.clear()
            if steps and not self._coasting.realign(self.ekf, tick, (tick.captured_ns - first_ns) * 1e-9):
                self.ekf.settle()
        return self._row(tick.captured_ns, self._advance(tick, self._coasting))

    def _advance(self, tick: Tick, coasting: Coasting | None) -> RhythmReading:
        dt_s = 0.0 if self._last_ns is None else (tick.captured_ns - self._last_ns) / 1e9
        if dt_s > self.parameters.longest_step_s:
            self.ekf.settle()
            self._gaps.clear()
            self._jerk[:] = 0.0
            self._returned_ns = dict.fromkeys(SEGMENTS, tick.captured_ns)
        if self._last_ns is None and self._starts_moving:
            self._returned_ns = dict.fromkeys(SEGMENTS, tick.captured_ns)
        unseen = self._listen(tick)
        if unseen != self.unseen:
            self._see(unseen, tick.captured_ns)
        self._judge(tick.captured_ns)
        step_s = dt_s if dt_s <= self.parameters.longest_step_s else 0.0
        filled = tick if coasting is None else self._follow(coasting, tick, step_s)
        self._fuse(filled, tick.fresh, step_s)
        if not self.ekf.is_sound():
            self._start_over(tick.captured_ns)
        if coasting is not None:
            self._gaps.lead(coasting.lead(self.ekf, step_s))
        reading = self._follow_rhythm(dt_s)
        if coasting is not None:
            for segment in coasting.learn(reading, dt_s, tick, self.ekf.estimate, self._missing):
                self._loosen(segment)
        self._last_ns = tick.captured_ns
        return reading

    def _fuse(self, tick: Tick, measured: NDArray[np.bool_], dt_s: float) -> None:
        """Advance the filter, and close gaps from both ends."""
        fresh = tick.fresh & self._aligned
        driven, unled = self.ekf.companions.jerk, np.zeros_like(self._jerk)
        step = Step(tick.captured_ns, dt_s, tick.samples, fresh, self._jerk, driven, unled)
        self._gaps.advance(step, measured & self._aligned, self._rest)

    def _loosen(self, segment: Segment) -> None:
        self.ekf.loosen(self.model.joints_of(segment))
        self._gaps.clear()

    def _follow(self, coasting: Coasting, tick: Tick, dt_s: float) -> Tick:
        """The tick with stand-ins for silent sensors; their joints are not drawn to zero."""
        filled = coasting.stand_in(tick, self._heard_ns, self._aligned, dt_s)
        if coasting.followed != self._followed:
            self._followed = coasting.followed
            self._rest = self._rest_without(self.unseen - self._followed)
        return filled

    def _start_over(self, now_ns: int) -> None:
        """The estimate is lost: begin again from upright, in doubt like after a gap."""
        self.ekf.start_over()
        self._gaps.clear()
        self._jerk[:] = 0.0
        self._returned_ns = dict.fromkeys(SEGMENTS, now_ns)
        self._judge(now_ns)

    def _rest_without(self, unseen: frozenset[Segment]) -> Array:
        return rest_variances(self.model, self.parameters, self._worn, unseen)

    @property
    def rhythm(self) -> TrustedRhythm:
        """The rhythm that the joints share."""
        return self._rhythm

    def _follow_rhythm(self, dt_s: float) -> RhythmReading:
        velocity, bound = self.ekf.estimate[1], self.parameters.longest_jerk
        reading = self._rhythm.step(velocity.take(self._rhythm_joints), dt_s)
        if self._driver is self._rhythm:
            self.ekf.companions.jerk[:, self._driver_joints] = np.minimum(np.maximum(reading.jerk, -bound), bound)
        elif self._driver is not None:
            jerk = self._driver.step(velocity[self._driver_joints], dt_s).jerk
            self._jerk[self._driver_joints] = np.minimum(np.maximum(jerk, -bound), bound)
        return reading

    def _row(self, captured_ns: int, reading: RhythmReading) -> Row:
        deviations = np.hypot(self.ekf.deviations(), self._unmodelled)
        if self._coasting is not None:
            deviations[0] = np.hypot(deviations[0], self._coasting.deviation)
        values = np.concatenate([self._ahead @ self.ekf.estimate, deviations])
        if len(self.model.soft) == 0 or self.model.first_rotation > 0:
            pick = self.model.reported
            values = np.where(pick >= 0, values[:, pick], 0.0)
        position, velocity, acceleration, position_std, velocity_std = values.tolist()
        return Row(captured_ns, position, velocity, acceleration, position_std, velocity_std, reading)

    def snapshot(self) -> State:
        """State of filter and rhythm."""
        driven = self._driver is not None and self._driver is not self._rhythm
        return {
            "x": pack_array(self.ekf.x),
            "P": pack_array(self.ekf.P),
            "companions": self.ekf.pack_companions(),
            "jerk": pack_array(self._jerk),
            "last_ns": self._last_ns,
            "heard_ns": list(self._heard_ns),
            "unseen": sorted(self.unseen),
            "returned_ns": {segment.value: ns for segment, ns in sorted(self._returned_ns.items())},
            "rhythm": self._rhythm.snapshot(),
            "coasting": None if self._coasting is None else self._coasting.snapshot(),
            "gaps": self._gaps.snapshot(),
            "driver": self._driver.snapshot() if self._driver is not None and driven else None,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.ekf.x[:] = unpack_array(state["x"])
        self.ekf.P[:] = unpack_array(state["P"])
        self.ekf.unpack_companions(state["companions"])
        self._jerk[:] = unpack_array(state["jerk"])
        self._last_ns = state["last_ns"]
        self._heard_ns = list(state["heard_ns"])
        self.unseen = frozenset(Segment(name) for name in state["unseen"])
        self._returned_ns = {Segment(name): ns for name, ns in state["returned_ns"].items()}
        self._missing = self.unseen | frozenset(self._returned_ns)
        if self._coasting is not None:
            self._coasting.restore(state["coasting"])
            self._followed = self._coasting.followed
        self.valid = self._valid_without(self._missing)
        self._rest = self._rest_without(self.unseen - self._followed)
        self.observed = self._observed_without(self._missing)
        self._gaps.restore(state["gaps"])
        self._rhythm.restore(state["rhythm"])
        if self._driver is not None and state["driver"] is not None:
            self._driver.restore(state["driver"])


def _ahead(delay_s: float) -> Array:
    """(3, 3) that carries position, velocity and acceleration on by the delay of the samples."""
    return np.array([[1.0, delay_s, 0.5 * delay_s**2], [0.0, 1.0, delay_s], [0.0, 0.0, 1.0]])


def _mount(sensor: SensorDescription, R_segment_from_sensor: Array) -> SensorMount:
    at = sensor.position_in_segment
    return SensorMount(sensor.segment, R_segment_from_sensor, None if at is None else (at[0], at[1], at[2]))
