"""The order and number in which a bad network delivers messages."""

from collections.abc import Sequence

import numpy as np

from services.faults.faults import Duplicated, Reordered, TransportFault
from services.flow.message import Message


def disturb(messages: Sequence[Message], faults: Sequence[TransportFault], seed: int) -> list[Message]:
    """Messages as they arrive; envelopes and payloads stay as they are."""
    random = np.random.default_rng(seed)
    delivered = list(messages)
    for fault in faults:
        if isinstance(fault, Duplicated):
            delivered = _with_copies(fault, delivered, random)
        else:
            delivered = _shuffled(fault, delivered, random)
    return delivered


def _with_copies(fault: Duplicated, messages: list[Message], random: np.random.Generator) -> list[Message]:
    again = [
        (place + int(random.integers(1, 20)), message)
        for place, message in enumerate(messages)
        if random.random() < fault.share
    ]
    return [message for _, message in sorted([*enumerate(messages), *again], key=lambda pair: pair[0])]


def _shuffled(fault: Reordered, messages: list[Message], random: np.random.Generator) -> list[Message]:
    places = np.arange(len(messages)) + random.uniform(0, fault.window, len(messages))
    return [messages[i] for i in np.argsort(places, kind="stable")]
