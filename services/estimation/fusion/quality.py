"""What both sources told and what was used of it, and the seconds of the body that came out."""

from collections.abc import Iterable

from schemas.quality import DataQuality
from schemas.signals import DATA_QUALITY
from services.estimation.parameters import QualityParameters
from services.estimation.quality_data import SEEN_BY_A_CAMERA
from services.estimation.quality_spans import Spans, take_outputs
from services.flow.message import Output
from services.flow.node import State


class FusedQuality:
    """Told when both sources have told theirs anew, and at the end."""

    def __init__(self, parameters: QualityParameters) -> None:
        self._spans = Spans("whole_body", SEEN_BY_A_CAMERA, parameters)
        self._told: dict[str, DataQuality] = {}
        self._new: set[str] = set()

    def hear(self, outputs: Iterable[Output]) -> None:
        """What came out of the fusion."""
        take_outputs(self._spans, outputs)

    def take(self, source: str, quality: DataQuality) -> list[Output]:
        """What one source told."""
        self._told[source] = quality
        self._new.add(source)
        return self._tell() if len(self._new) == 2 else []

    def finish(self) -> list[Output]:
        """What has not been told yet."""
        return self._tell() if self._new else []

    def _tell(self) -> list[Output]:
        """Both together, as they were told last; of one alone where the other never spoke."""
        told = [self._told[source] for source in ("inertial", "camera") if source in self._told]
        self._new = set()
        leading = next((each for each in told if each.calibrated), told[0])
        quality = DataQuality(
            captured_ns=max(each.captured_ns for each in told),
            sources=[source for each in told for source in each.sources],
            calibrated=leading.calibrated,
            absolute=leading.absolute,
            **self._spans.seconds(),
            late=sum(each.late for each in told),
        )
        return [Output(DATA_QUALITY, quality.captured_ns, quality)]

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "spans": self._spans.snapshot(),
            "told": {source: quality.model_dump(mode="json") for source, quality in self._told.items()},
            "new": sorted(self._new),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._spans.restore(state["spans"])
        self._told = {source: DataQuality.model_validate(kept) for source, kept in state["told"].items()}
        self._new = set(state["new"])
