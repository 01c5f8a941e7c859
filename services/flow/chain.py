"""The whole chain in a plain loop: the same nodes as live, without a network."""

from collections.abc import Sequence

from services.flow.host import HostedNode
from services.flow.message import Message, Stream


class Chain:
    """Hosted nodes of one session, fed breadth first in the order given."""

    def __init__(self, hosts: Sequence[HostedNode]) -> None:
        self.hosts = list(hosts)
        self._readers: dict[Stream, list[HostedNode]] = {}
        for host in self.hosts:
            for stream in host.node.streams:
                self._readers.setdefault(stream, []).append(host)

    def push(self, message: Message) -> list[Message]:
        """Feed one message of the source; every message it leads to, in order."""
        produced: list[Message] = []
        queue = [message]
        while queue:
            current = queue.pop(0)
            for host in self._readers.get(current.stream, ()):
                new = host.accept(current)
                produced += new
                queue += new
        return produced
