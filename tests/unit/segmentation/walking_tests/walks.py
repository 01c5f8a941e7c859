"""Walking tests through the segmentation node, out of joint states that are the truth."""

import json
import random
from functools import cache

from schemas.tasks import TaskPhase
from services.bench.walking_tests.joint_corridors import joint_corridor
from services.flow.message import Message
from services.segmentation.node import SegmentationNode


@cache
def outputs(what: str) -> list:
    return through(what, joint_corridor(what).messages())


def through(what: str, messages: list[Message], **changes) -> list:
    node = SegmentationNode(joint_corridor(what).description.model_copy(update=changes))
    return [output for message in messages for output in node.step(message)] + node.finish()


def phases(found: list) -> list[TaskPhase]:
    return [output.payload for output in found if isinstance(output.payload, TaskPhase)]


def ended(found: list) -> list[TaskPhase]:
    return [phase for phase in phases(found) if phase.end_ns is not None]


def lines(found: list) -> list[tuple[int, str, str]]:
    return [(output.captured_ns, output.signal.name, output.payload.model_dump_json()) for output in found]


def resumed(what: str, times: int = 10) -> list:
    """With the node taken down and set up again between messages."""
    messages = joint_corridor(what).messages()
    node = SegmentationNode(joint_corridor(what).description)
    at = set(random.Random(3).sample(range(len(messages)), times))
    found = []
    for i, message in enumerate(messages):
        if i in at:
            state = json.loads(json.dumps(node.snapshot()))
            node = SegmentationNode(joint_corridor(what).description)
            node.restore(state)
        found += node.step(message)
    return found + node.finish()


def interleaved(one: str, other: str) -> tuple[list, list]:
    """Two sessions in one process, message by message."""
    nodes = [SegmentationNode(joint_corridor(what).description) for what in (one, other)]
    queues = [joint_corridor(what).messages() for what in (one, other)]
    found: list[list] = [[], []]
    for i in range(max(map(len, queues))):
        for k in (0, 1):
            if i < len(queues[k]):
                found[k] += nodes[k].step(queues[k][i])
    return found[0] + nodes[0].finish(), found[1] + nodes[1].finish()
