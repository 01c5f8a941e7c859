"""A session whose estimator cannot work with the sensors there are: the page says why, and nothing is estimated."""

from schemas.health import Rejection
from schemas.kinematics import LivePose
from schemas.session import SessionDescription
from schemas.signals import LIVE_POSE
from services.estimation.estimates import OUTPUTS
from services.estimation.live_pose import Watched, waiting_pose
from services.estimation.parameters import EstimationParameters
from services.estimation.sensor_status import unused_cameras, unused_statuses
from services.flow.message import Message, Output, Stream
from services.flow.node import State
from services.flow.raw_streams import raw_streams


class RefusingNode:
    """Says once in a while what must be changed."""

    outputs = OUTPUTS

    def __init__(self, description: SessionDescription, reason: str) -> None:
        self.reason = reason
        self._streams = tuple(raw_streams(description.model_copy(update={"reference": []})))
        self._names = [sensor.name for hub in description.hubs for sensor in hub.sensors]
        self._watched = Watched({}, unused_cameras(camera.name for camera in description.cameras))
        self._period_ns = round(1e9 / EstimationParameters().live_rate_hz)
        self._next_ns = 0

    @property
    def streams(self) -> tuple[Stream, ...]:
        """What sensors and cameras deliver."""
        return self._streams

    def step(self, message: Message) -> list[Output]:
        """The reason, when a picture is due."""
        captured_ns = message.envelope.captured_ns
        if captured_ns < self._next_ns:
            return []
        self._next_ns = (captured_ns // self._period_ns + 1) * self._period_ns
        return [Output(LIVE_POSE, captured_ns, self._pose(captured_ns))]

    def finish(self) -> list[Output]:
        """Nothing was held back."""
        return []

    def rejections(self) -> list[Rejection]:
        """No sample was looked at."""
        return []

    def _pose(self, captured_ns: int) -> LivePose:
        return waiting_pose(captured_ns, "waiting", self.reason, "", unused_statuses(self._names), self._watched)

    def snapshot(self) -> State:
        """When it speaks next."""
        return {"next_ns": self._next_ns}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._next_ns = state["next_ns"]
