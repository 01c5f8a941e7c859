"""A session of which only some sensors are worn."""

from collections.abc import Iterable, Iterator, Set

from schemas.imu import ImuBatch
from schemas.session import SessionDescription
from schemas.vocabulary import Segment
from services.flow.message import Message


def wearing(description: SessionDescription, segments: Set[Segment]) -> SessionDescription:
    """The same session with the sensors on these segments alone; hubs that have none are kept, empty."""
    hubs = [
        hub.model_copy(update={"sensors": [sensor for sensor in hub.sensors if sensor.segment in segments]})
        for hub in description.hubs
    ]
    return description.model_copy(update={"hubs": hubs})


def worn_only(
    messages: Iterable[Message], description: SessionDescription, segments: Set[Segment]
) -> Iterator[Message]:
    """Messages of the whole session, `description`, without the samples of the sensors that are not worn."""
    kept = {
        hub.name: [i for i, sensor in enumerate(hub.sensors) if sensor.segment in segments] for hub in description.hubs
    }
    for message in messages:
        if isinstance(message.payload, ImuBatch):
            sensors = [message.payload.sensors[i] for i in kept[message.stream.source]]
            message = Message(message.stream, message.envelope, ImuBatch(sensors=sensors, marks=message.payload.marks))
        yield message
