"""Skeletons of a depth camera become joint angles of the whole body, its joint centres, a rhythm, a calibration and a
picture for the screen."""

from collections.abc import Iterable

from schemas.health import Rejection
from schemas.rhythm import LearnedRhythm
from schemas.session import SessionDescription
from schemas.signals import CALIBRATION, LEARNED_RHYTHM, LIVE_POSE, SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.standing import StandingMark
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.body.coordinates import MODEL, Coordinates
from services.estimation.body.fitted_body import FittedBody
from services.estimation.body.frames import Frame, FrameIntake, missing_centres
from services.estimation.body.marks import StandingMarks
from services.estimation.body.messages import Run
from services.estimation.body.screen import Screen
from services.estimation.body.tracker import BodyTracker, Posture
from services.estimation.estimates import OUTPUTS
from services.estimation.learning import RhythmLearning, start_rhythm
from services.estimation.parameters import EstimationParameters
from services.estimation.quality import QualityWatch, Source
from services.estimation.quality_data import SEEN_BY_A_CAMERA
from services.estimation.rows import RHYTHM_CHANNELS
from services.flow.message import Message, Output, Stream
from services.flow.node import State


class BodyNode:
    """One session: the person whom the first camera follows.

    Rows begin with the second in which the person stood, or with the first frame where nobody stood still; the numbers
    do not depend on how frames were batched into messages.
    """

    outputs = OUTPUTS

    def __init__(self, description: SessionDescription, parameters: EstimationParameters | None = None) -> None:
        """Raises ValueError where there is no camera, or it does not deliver all joint centres."""
        p = parameters or EstimationParameters()
        if not description.cameras:
            raise ValueError(f"{description.estimator} needs a depth camera: choose an estimator of worn sensors")
        camera, *others = description.cameras
        missing = missing_centres(camera)
        if missing:
            names = ", ".join(name.value.replace("_", " ") for name in missing)
            raise ValueError(f"{description.estimator} needs joints that the camera {camera.name} lacks: {names}")
        self._stream = Stream(SKELETON, camera.name)
        self._intake = FrameIntake(camera, p.body)
        self._marks = StandingMarks(description.standing, p.notice_s)
        self._tracker = BodyTracker(description.estimator, description.anthropometry.height_m, p.body)
        rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), p.filter.rhythm)
        start_rhythm(rhythm, description.known_rhythms)
        self._coordinates = Coordinates(rhythm, camera.floor_m, p.body.unknown_std)
        self._learning = RhythmLearning(MODEL)
        unused = {each.name: "the first camera is used" for each in others}
        unused |= {s.name: "this estimator uses the camera" for hub in description.hubs for s in hub.sensors}
        self._fitted = FittedBody(description, unused, p.body)
        source = Source(camera.name, camera.rate_hz, None)
        self._quality = QualityWatch([source], SEEN_BY_A_CAMERA, self._intake.refused_before, p.quality, MODEL)
        self._screen = Screen(description, self._intake, self._tracker, p.live_rate_hz, p.checks.silent_after_s)

    @property
    def streams(self) -> tuple[Stream, ...]:
        """That of the camera."""
        return (self._stream,)

    def step(self, message: Message) -> list[Output]:
        """Take one skeleton message."""
        batch, captured_ns = message.payload, message.envelope.captured_ns
        assert isinstance(batch, SkeletonBatch)
        self._marks.note(batch.marks)
        run, frame = Run(), None
        for frame in self._intake.accept(batch, captured_ns):
            self._tell_quality(frame, run)
            for mark in self._marks.due(frame.captured_ns):
                self._hear(mark, frame.captured_ns, run)
            self._publish(self._tracker.take(frame), run)
        outputs = run.finish()
        self._quality.hear(run.unheard())
        return outputs + self._picture(captured_ns, frame, run)

    def _tell_quality(self, frame: Frame, run: Run) -> None:
        """What was before this frame, when it is time; then the frame is counted."""
        if self._quality.is_due(frame.captured_ns):
            run.close()
            self._quality.hear(run.unheard())
            run.outputs += self._quality.due(frame.captured_ns)
        self._quality.count_frame(frame.captured_ns, used=frame.is_somebody)

    def finish(self) -> list[Output]:
        """Follow whoever was waited for."""
        run = Run()
        self._publish(self._tracker.finish(), run)
        outputs = run.finish()
        self._quality.hear(run.unheard())
        return outputs + _learned(self._learning.report()) + self._quality.finish()

    def rejections(self) -> list[Rejection]:
        """Counts by camera and reason."""
        return self._intake.rejections()

    def _hear(self, mark: StandingMark, now_ns: int, run: Run) -> None:
        """The operator marked a standing: angles refer to it."""
        was_following = self._tracker.is_following
        reason, postures = self._tracker.stand(mark.from_ns, mark.to_ns)
        if reason:
            self._marks.say(f"Not taken as standing: {reason}", now_ns)
            return
        self._publish(postures, run)
        after = "Angles refer to the marked standing from now on"
        self._marks.say(after if was_following else "Standing taken as marked", now_ns)

    def _publish(self, postures: Iterable[Posture], run: Run) -> None:
        for posture in postures:
            calibration = self._fitted.news(self._tracker, posture)
            if calibration is not None:
                run.close()
                run.outputs.append(Output(CALIBRATION, posture.captured_ns, calibration))
            row, valid = self._coordinates.row(posture)
            run.add(row, valid, posture)
            run.learned += _learned(self._learning.take(row, valid))

    def _picture(self, captured_ns: int, frame: Frame | None, run: Run) -> list[Output]:
        now_ns = captured_ns if frame is None else frame.captured_ns
        if not self._screen.pace.is_due(now_ns):
            return []
        notice = self._marks.notice_at(now_ns)
        if frame is None:
            pose = self._screen.silent(now_ns, notice)
        elif run.last is None or run.posture is None:
            pose = self._screen.waiting(frame, notice)
        else:
            pose = self._screen.drawn(run.last, run.valid, run.posture, frame, notice)
        return [Output(LIVE_POSE, now_ns, pose)]

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "intake": self._intake.snapshot(),
            "marks": self._marks.snapshot(),
            "tracker": self._tracker.snapshot(),
            "coordinates": self._coordinates.snapshot(),
            "learning": self._learning.snapshot(),
            "fitted": self._fitted.snapshot(),
            "next_ns": self._screen.pace.next_ns,
            "quality": self._quality.snapshot(),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`, for a node built from the same description and parameters."""
        self._intake.restore(state["intake"])
        self._marks.restore(state["marks"])
        self._tracker.restore(state["tracker"])
        self._coordinates.restore(state["coordinates"])
        self._learning.restore(state["learning"])
        self._fitted.restore(state["fitted"])
        self._screen.pace.next_ns = state["next_ns"]
        self._quality.restore(state["quality"])


def _learned(rhythm: LearnedRhythm | None) -> list[Output]:
    return [] if rhythm is None else [Output(LEARNED_RHYTHM, rhythm.captured_ns, rhythm)]
