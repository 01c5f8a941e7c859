"""Samples of the worn sensors become joint states with their rhythm, a calibration and a picture for the screen."""

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from schemas.health import Rejection
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, LEARNED_RHYTHM, LIVE_POSE, SEGMENT_MOTION
from schemas.standing import StandingMark
from schemas.vocabulary import Segment
from services.biomech.bones import SEGMENTS
from services.biomech.event_sources import lone_segments, worn_segments
from services.biomech.figure import Pace, segment_pictures
from services.estimation.estimates import OUTPUTS, estimates
from services.estimation.intake import Intake, used_by_lower_body
from services.estimation.learning import RhythmLearning, start_rhythm
from services.estimation.live_pose import estimated_pose, waiting_pose
from services.estimation.lower_body.calibration_message import calibration_message
from services.estimation.lower_body.calibrator import Calibrator, pack_calibrated, unpack_calibrated
from services.estimation.lower_body.lower_body_filter import Calibrated, LowerBodyFilter
from services.estimation.lower_body.resting_bias import RestingBias
from services.estimation.lower_body.segment_motion import LoneSegments
from services.estimation.marked_standing import Marks
from services.estimation.parameters import EstimationParameters
from services.estimation.quality import QualityWatch, Source
from services.estimation.quality_data import seen_by_sensors
from services.estimation.rows import INDEX, Row
from services.estimation.samples import Tick, TickBatch
from services.estimation.sensor_status import sensor_statuses, sensor_troubles, unused_statuses
from services.estimation.standing import StandingReference
from services.flow.message import Message, Output, Stream
from services.flow.node import State

TILT, OBLIQUITY = INDEX["pelvis_tilt"], INDEX["pelvis_obliquity"]


class LowerBodyNode:
    """One session: waits for standing, finds the axes in the first steps, then estimates.

    Every sample from the start of the walk leads to one row of joint_state and rhythm, those before the calibration
    all at once when it stands. The numbers do not depend on how the samples were batched into messages.
    """

    outputs = OUTPUTS

    def __init__(self, description: SessionDescription, parameters: EstimationParameters | None = None) -> None:
        self._description = description
        self._parameters = parameters or EstimationParameters()
        self._intake = Intake(description, self._parameters, used_by_lower_body(description))
        self._calibrator = Calibrator(description, self._intake.sensors, self._parameters)
        self._calibrated: Calibrated | None = None
        self._filter: LowerBodyFilter | None = None
        self._lone: LoneSegments | None = None
        self._bias: RestingBias | None = None
        self._learning = RhythmLearning()
        self._marks = Marks(self._intake.sensors, self._parameters.standing, self._parameters.notice_s)
        self._pace = Pace(self._parameters.live_rate_hz)
        body = worn_segments(description.hubs)
        sources = [Source(sensor.name, sensor.rate_hz, sensor.segment) for sensor in self._intake.sensors]
        refused = self._intake.checks.refused_before
        self._quality = QualityWatch(sources, seen_by_sensors(body), refused, self._parameters.quality)

    @property
    def streams(self) -> tuple[Stream, ...]:
        """One imu stream per hub."""
        return self._intake.streams

    def step(self, message: Message) -> list[Output]:
        """Take one imu message."""
        self._marks.note(message.payload)
        return [output for batch in self._intake.accept(message) for output in self._take(batch)]

    def finish(self) -> list[Output]:
        """Take what waited, and calibrate with what there is."""
        outputs = [output for batch in self._intake.finish() for output in self._take(batch)]
        if self._filter is None:
            calibrated = self._calibrator.finish()
            if calibrated is not None:
                outputs += self._heard(self._start(calibrated))
        return outputs + _learned(self._learning.report()) + self._quality.finish()

    def rejections(self) -> list[Rejection]:
        """Counts by sensor and reason."""
        return self._intake.checks.rejections()

    def _take(self, batch: TickBatch) -> list[Output]:
        outputs: list[Output] = []
        for marks, ticks in self._marks.runs(batch.ticks):
            for mark in marks:
                outputs += self._heard(self._hear(mark, ticks[0].captured_ns))
            self._marks.watch(ticks)
            for run in self._quality.runs(ticks):
                outputs += self._quality.due(run[0].captured_ns)
                self._quality.count(run)
                outputs += self._heard(self._follow(run))
        return outputs + (self._wait(batch.captured_ns) if self._filter is None else [])

    def _heard(self, outputs: list[Output]) -> list[Output]:
        self._quality.hear(outputs)
        return outputs

    def _follow(self, run: Sequence[Tick]) -> list[Output]:
        """Until the calibration each tick is looked at by itself: how samples were batched must decide nothing."""
        outputs: list[Output] = []
        ticks = deque(run)
        while ticks and self._filter is None:
            tick = ticks.popleft()
            calibrated = self._calibrator.add(TickBatch(tick.captured_ns, (tick,)), self._intake.checks)
            if calibrated is not None:
                outputs += self._start(calibrated)
        return outputs if self._filter is None else outputs + self._estimate(self._filter, ticks)

    def _hear(self, mark: StandingMark, now_ns: int) -> list[Output]:
        """The operator marked a standing: before the calibration it is the one that counts, later a new zero."""
        alignment = None if self._calibrated is None else self._calibrated.alignment
        standing = self._marks.judge(mark, alignment, now_ns)
        if standing is None:
            return []
        if self._filter is None:
            self._marks.say("Standing taken as marked", now_ns)
            self._calibrator.take_mark(standing)
            return []
        return self._refer_anew(standing, self._filter, now_ns)

    def _refer_anew(self, standing: StandingReference, before: LowerBodyFilter, now_ns: int) -> list[Output]:
        """All angles from now on refer to this standing, and the body starts from it, facing ahead."""
        calibrated = self._calibrator.realign(standing)
        if calibrated is None:
            self._marks.refuse("no sensor could be aligned", now_ns)
            return []
        self._marks.say("Angles refer to the marked standing from now on", now_ns)
        self._adopt(calibrated).continue_from(before)
        return [Output(CALIBRATION, now_ns, calibration_message(self._description, self._intake, calibrated))]

    def _wait(self, now_ns: int) -> list[Output]:
        if not self._pace.is_due(now_ns):
            return []
        phase = "waiting" if self._calibrator.reference is None else "calibrating"
        sensors, checks = self._intake.sensors, self._intake.checks
        everyone = np.ones(len(sensors), dtype=np.bool_)
        statuses = sensor_statuses(sensors, checks, now_ns, self._calibrator.refused, everyone)
        statuses += unused_statuses(self._intake.unused)
        message, stood = self._calibrator.message(), self._calibrator.standing.stood
        pose = waiting_pose(now_ns, phase, message, self._marks.notice_at(now_ns), statuses, stood=stood)
        return [Output(LIVE_POSE, now_ns, pose)]

    def _start(self, calibrated: Calibrated) -> list[Output]:
        """Publish the calibration and catch up with the walk."""
        running = self._adopt(calibrated)
        start_rhythm(running.rhythm, self._description.known_rhythms)
        kept = self._calibrator.batches
        message = calibration_message(self._description, self._intake, calibrated)
        outputs = [Output(CALIBRATION, kept[0].captured_ns, message)]
        while kept:
            outputs += self._estimate(running, kept.pop(0).ticks)
        return outputs

    def _adopt(self, calibrated: Calibrated) -> LowerBodyFilter:
        self._calibrated, self._filter = calibrated, self._new_filter(calibrated)
        self._lone, self._bias = self._new_lone(calibrated), self._new_bias(calibrated)
        return self._filter

    def _new_filter(self, calibrated: Calibrated) -> LowerBodyFilter:
        parameters = self._parameters.filter_of(self._description)
        count = self._intake.body_sensors
        of_body = replace(
            calibrated, alignment=calibrated.alignment.first(count), gyro_bias=calibrated.gyro_bias[:count]
        )
        return LowerBodyFilter(self._description, self._intake.sensors[:count], of_body, parameters)

    def _new_bias(self, calibrated: Calibrated) -> RestingBias | None:
        parameters = self._parameters
        if not parameters.follow_bias:
            return None
        return RestingBias(calibrated.gyro_bias.copy(), parameters.standing, parameters.bias)

    def _new_lone(self, calibrated: Calibrated) -> LoneSegments | None:
        segments = lone_segments(worn_segments(self._description.hubs))
        if not segments:
            return None
        alignment, sensors = calibrated.alignment, self._intake.sensors
        return LoneSegments(
            sensors,
            segments,
            alignment.R_segment_from_sensor,
            calibrated.gyro_bias,
            alignment.aligned.tolist(),
            self._parameters.segment_motion,
        )

    def _estimate(self, running: LowerBodyFilter, ticks: Iterable[Tick]) -> list[Output]:
        """Joint states with their rhythm, a message for each run of equal validity, and the picture when it is due."""
        outputs: list[Output] = []
        rows: list[Row] = []
        valid: list[bool] = []
        observed: list[Segment] = []
        learned: list[Output] = []
        for tick in ticks:
            if self._bias is not None and self._bias.add(tick):
                self._believe(running, self._bias.bias)
            row = running.fuse(tick.first(self._intake.body_sensors))
            if rows and (running.valid != valid or running.observed != observed):
                outputs += self._estimates(rows, valid, observed)
                rows = []
            rows.append(row)
            valid, observed = running.valid, running.observed
            learned += _learned(self._learning.take(row, valid))
            if self._lone is not None:
                self._lone.take(tick, row.position[TILT], row.position[OBLIQUITY])
        if not rows:
            return []
        outputs += self._estimates(rows, valid, observed) + learned
        return outputs + self._picture(running, rows[-1])

    def _estimates(self, rows: list[Row], valid: list[bool], observed: list[Segment]) -> list[Output]:
        """The messages of some rows; where lone segments are followed, their motion beside them."""
        outputs, newest_ns = estimates(rows, valid, observed), rows[-1].captured_ns
        if self._lone is not None:
            motion = self._lone.collect([row.captured_ns for row in rows])
            outputs.append(Output(SEGMENT_MOTION, newest_ns, motion))
        return outputs

    def _believe(self, running: LowerBodyFilter, gyro_bias: NDArray[np.float64]) -> None:
        running.ekf.bias[:] = gyro_bias[: self._intake.body_sensors]
        if self._lone is not None:
            self._lone.believe(gyro_bias)

    def _picture(self, running: LowerBodyFilter, row: Row) -> list[Output]:
        """The picture of the newest row, when its time has come. None while catching up: nobody could watch it."""
        if self._calibrator.batches or not self._pace.is_due(row.captured_ns):
            return []
        assert self._calibrated is not None
        refused, waiting = self._calibrator.refused, ~self._calibrated.alignment.aligned
        statuses = sensor_statuses(self._intake.sensors, self._intake.checks, row.captured_ns, refused, waiting)
        statuses += unused_statuses(self._intake.unused)
        notice = self._marks.notice_at(row.captured_ns)
        body = self._description.anthropometry
        bones = segment_pictures(body, row.position, SEGMENTS, running.observed)
        pose = estimated_pose(row, bones, running.valid, sensor_troubles(statuses), notice, statuses)
        return [Output(LIVE_POSE, row.captured_ns, pose)]

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "intake": self._intake.snapshot(),
            "calibrator": self._calibrator.snapshot(),
            "calibrated": None if self._calibrated is None else pack_calibrated(self._calibrated),
            "filter": None if self._filter is None else self._filter.snapshot(),
            "lone": None if self._lone is None else self._lone.snapshot(),
            "bias": None if self._bias is None else self._bias.snapshot(),
            "learning": self._learning.snapshot(),
            "marks": self._marks.snapshot(),
            "next_live_ns": self._pace.next_ns,
            "quality": self._quality.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for a node built from the same description and parameters."""
        self._intake.restore(state["intake"])
        self._calibrator.restore(state["calibrator"])
        self._calibrated, self._filter, self._lone, self._bias = None, None, None, None
        if state["calibrated"] is not None:
            running = self._adopt(unpack_calibrated(state["calibrated"]))
            running.restore(state["filter"])
            if self._lone is not None:
                self._lone.restore(state["lone"])
            if self._bias is not None:
                self._bias.restore(state["bias"])
                self._believe(running, self._bias.bias)
        self._learning.restore(state["learning"])
        self._marks.restore(state["marks"])
        self._pace.next_ns = state["next_live_ns"]
        self._quality.restore(state["quality"])


def _learned(rhythm: LearnedRhythm | None) -> list[Output]:
    return [] if rhythm is None else [Output(LEARNED_RHYTHM, rhythm.captured_ns, rhythm)]
