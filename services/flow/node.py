"""The face of every algorithm: messages in, messages out, state that can be saved and restored."""

import base64
from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from schemas.health import Rejection
from schemas.session import SessionDescription
from schemas.signals import Signal
from services.flow.message import Message, Output, Stream

State = dict[str, Any]
"""A node's state as JSON values: dicts, lists, strings, numbers, None."""


class Node(Protocol):
    """One algorithm of one session.

    No clock, socket, file or global inside; time is the messages' own. The streams arrive each in order and
    complete, but how two streams interleave is not promised: what is put out, and in which order, must not
    depend on it. Bad samples are counted and reported, exceptions are for bugs.
    """

    outputs: tuple[Signal, ...]

    @property
    def streams(self) -> tuple[Stream, ...]:
        """The streams to be fed, all of them needed."""

    def step(self, message: Message) -> list[Output]:
        """Take one message; what it leads to."""

    def finish(self) -> list[Output]:
        """All streams have ended; what was still held back."""

    def snapshot(self) -> State:
        """Everything that changes, nothing derived."""

    def restore(self, state: State) -> None:
        """Go on from a snapshot of a node that was built from the same description."""

    def rejections(self) -> list[Rejection]:
        """What was not used, by subject and reason, since the session started."""


NodeFactory = Callable[[SessionDescription], Node]


def pack_array(array: NDArray[np.float64]) -> State:
    """A float64 array as JSON values, to the bit (base64 of little-endian bytes)."""
    data = np.ascontiguousarray(array, dtype="<f8").tobytes()
    return {"shape": list(array.shape), "f8": base64.b64encode(data).decode("ascii")}


def unpack_array(packed: State) -> NDArray[np.float64]:
    """Inverse of `pack_array`. A fresh, writable array."""
    flat = np.frombuffer(base64.b64decode(packed["f8"]), dtype="<f8")
    return flat.reshape(packed["shape"]).astype(np.float64)
