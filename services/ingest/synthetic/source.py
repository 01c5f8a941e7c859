"""Synthetic people as a source."""

from collections.abc import Iterator
from itertools import chain

from schemas.health import Rejection
from schemas.session import SessionDescription
from schemas.signals import IMU, SKELETON
from services.flow.message import Stream
from services.ingest.driver import SourceMessage
from services.ingest.identity import Identity
from services.ingest.synthetic.block import Block, SimulatedSession
from services.ingest.synthetic.motions import parse_motion
from services.ingest.tracks import hub_messages, in_order, reference_messages, skeleton_messages


class SyntheticSource:
    """Samples of a synthetic session with its truth beside them."""

    def __init__(self, session: SimulatedSession, identity: Identity) -> None:
        self._session = session
        self._identity = identity
        self._described = session.description()

    def describe(self) -> SessionDescription:
        """The session, with what the operator chose."""
        identity = self._identity
        return identity.choices.applied(self._session.description(identity.session, identity.started_unix_ns))

    def messages(self) -> Iterator[SourceMessage]:
        """One message per tick, truth beside it."""
        return chain.from_iterable(self._block_messages(block) for block in self._session.samples())

    def rejections(self) -> list[Rejection]:
        """None: whatever is made is delivered."""
        return []

    def _block_messages(self, block: Block) -> Iterator[SourceMessage]:
        description = self._described
        tick_ns = round(1e9 / self._session.reference_hz)
        streams = [hub_messages(Stream(IMU, hub.name), block.sensors, tick_ns) for hub in description.hubs]
        if block.skeleton is not None:
            streams += [
                skeleton_messages(Stream(SKELETON, camera.name), block.skeleton.track(camera.joints))
                for camera in description.cameras
            ]
        if description.reference:
            streams.append(reference_messages(block.reference, tick_ns))
        return in_order(streams)


def open_synthetic(what: str, identity: Identity) -> SyntheticSource:
    """From what follows `synthetic:`, e.g. `walk?speed=1.1&seed=3`. Raises SourceError."""
    name, _, options = what.partition("?")
    return SyntheticSource(parse_motion(name, options), identity)
