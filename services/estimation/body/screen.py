"""What the page shows of a session with a camera, 25 times a second of data time."""

from collections.abc import Sequence

from schemas.kinematics import CameraStatus, LivePose
from schemas.session import SessionDescription
from services.biomech.figure import Pace, with_directions
from services.biomech.whole_body.model import CENTRE_NAMES
from services.estimation.body.coordinates import MODEL
from services.estimation.body.frames import Frame, FrameIntake
from services.estimation.body.tracker import BodyTracker, Posture
from services.estimation.live_pose import Watched, estimated_pose, waiting_pose
from services.estimation.rows import Row
from services.estimation.sensor_status import unused_cameras, unused_statuses

NOBODY = "Nobody in view"
SEVERAL = "{people} people in view: only one of them is followed"
STAND = "Stand still and upright for a second, facing the camera, arms hanging"
RELATIVE = "Angles are not absolute yet: stand still and upright for a second, arms hanging"
UNUSABLE = "The camera sends what cannot be used"
DIVERGED = "The published filter has diverged and began anew, {times} times so far"


class Screen:
    """Of one session; draws when a picture is due."""

    def __init__(
        self, description: SessionDescription, intake: FrameIntake, tracker: BodyTracker, rate_hz: float,
        silent_after_s: float,
    ) -> None:  # fmt: skip
        self._intake, self._tracker, self._silent_s = intake, tracker, silent_after_s
        self._others = [camera.name for camera in description.cameras if camera.name != intake.camera.name]
        self._unused = unused_statuses([sensor.name for hub in description.hubs for sensor in hub.sensors])
        self.pace = Pace(rate_hz)

    def waiting(self, frame: Frame, notice: str) -> LivePose:
        """Before there is an estimate: centres as the camera has them."""
        centres = {
            name: frame.centres[m].tolist()
            for m, name in enumerate(CENTRE_NAMES)
            if frame.is_somebody and frame.state[m]
        }
        message, cameras = self._said(frame, frame.captured_ns)
        phase = "calibrating" if frame.is_somebody else "waiting"
        watched = Watched(centres, cameras)
        return waiting_pose(frame.captured_ns, phase, message, notice, self._unused, watched)

    def silent(self, captured_ns: int, notice: str) -> LivePose:
        """No frame of the message could be used."""
        cameras = self._cameras(captured_ns, 0)
        return waiting_pose(captured_ns, "waiting", UNUSABLE, notice, self._unused, Watched({}, cameras))

    def drawn(self, row: Row, valid: Sequence[bool], posture: Posture, frame: Frame, notice: str) -> LivePose:
        """Of the newest row."""
        is_there = any(posture.seen)
        centres = dict(zip(CENTRE_NAMES, posture.centres.tolist(), strict=True)) if is_there else {}
        message, cameras = self._said(frame, row.captured_ns)
        watched = Watched(centres, cameras)
        pose = estimated_pose(row, [], valid, message, notice, self._unused, watched, MODEL)
        return with_directions(pose, row.position, row.position_std, posture.seen)

    def _said(self, frame: Frame, now_ns: int) -> tuple[str, list[CameraStatus]]:
        """What matters most, and the cameras' states."""
        if not frame.is_somebody:
            return NOBODY, self._cameras(now_ns, frame.people)
        tracker, words = self._tracker, []
        if frame.people > 1:
            words.append(SEVERAL.format(people=frame.people))
        if tracker.diverged:
            words.append(DIVERGED.format(times=tracker.diverged))
        elif tracker.can_be_absolute and not tracker.absolute:
            words.append(RELATIVE if tracker.is_following else STAND)
        return ". ".join(words), self._cameras(now_ns, frame.people)

    def _cameras(self, now_ns: int, people: int) -> list[CameraStatus]:
        state, since_ns = self._intake.state_at(now_ns, self._silent_s)
        used = CameraStatus(camera=self._intake.camera.name, state=state, people=people, since_ns=since_ns)
        return [used, *unused_cameras(self._others)]
