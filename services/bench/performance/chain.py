"""What one five-sensor frame costs in the plain loop: each node, and the encoding and decoding between them.

Processor time is measured, in pieces of two seconds of walking, so that a busy machine disturbs it little.
"""

import statistics
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from schemas.signals import IMU
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.cli.assembly import build_chain
from services.flow.host import HostedNode
from services.flow.message import Message, decode_payload, encode_payload
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?speed=1.2&seed=3&duration=60"
RATE_HZ = 100.0
PIECE = 200
"""Frames between two readings of the sums."""
CODING = "encode and decode"
TARGETS_US = {1: 120.0, 5: 80.0}
"""us per frame of estimation, by frames in a message."""

Result = TypeVar("Result")


class Costs:
    """Sums of processor time by what it was spent on."""

    def __init__(self) -> None:
        self.seconds: defaultdict[str, float] = defaultdict(float)

    def of(self, name: str, work: Callable[..., Result], *arguments: Any) -> Result:
        """Do the work and add its time."""
        start = time.thread_time()
        result = work(*arguments)
        self.seconds[name] += time.thread_time() - start
        return result


def _pass(hosts: list[HostedNode], message: Message, costs: Costs) -> None:
    """Feed one message of the source through all nodes; each message is encoded and decoded on its way."""
    queue = [message]
    while queue:
        sent = queue.pop(0)
        text = costs.of(CODING, encode_payload, sent.payload)
        payload = costs.of(CODING, decode_payload, sent.stream.signal, sent.envelope, text)
        received = Message(sent.stream, sent.envelope, payload)
        for host in hosts:
            if sent.stream in host.node.streams:
                queue += costs.of(host.service, host.accept, received)


def frame_costs_us(frames_per_message: int) -> dict[str, float]:
    """Median us per frame of each node and of the coding, while walking."""
    source = open_source(WALK, estimator="rhythmic_ekf")
    hosts = build_chain(source.describe()).hosts
    pieces: list[dict[str, float]] = []
    costs, frames = Costs(), 0
    for message in iter_messages(source, frames_per_message):
        if message.stream.signal is not IMU:
            continue
        _pass(hosts, message, costs)
        frames += frames_per_message
        if frames >= PIECE:
            pieces.append({name: seconds / frames * 1e6 for name, seconds in costs.seconds.items()})
            costs, frames = Costs(), 0
    # The first third is standing and calibrating, with the compilation of what is not yet on disk.
    walking = pieces[len(pieces) // 3 :]
    names = [host.service for host in hosts] + [CODING]
    return {name: statistics.median(piece.get(name, 0.0) for piece in walking) for name in names}


def run(json_path: Path | None = None) -> Scoreboard:
    """One frame in a message, as at the lowest latency, and five."""
    rows: list[Row] = []
    for frames, target_us in TARGETS_US.items():
        costs = frame_costs_us(frames)
        total = sum(costs.values())
        group = f"{frames} frame{'s' if frames > 1 else ''} in a message"
        rows.append(at_most(f"{group}: estimation", costs.pop("estimation"), "us", target_us))
        rows += [informative(f"{group}: {name}", cost, "us") for name, cost in costs.items()]
        rows += [
            informative(f"{group}: everything", total, "us"),
            at_least(f"{group}: faster than real time", 1e6 / RATE_HZ / total, "x", 20.0),
        ]
    board = Scoreboard("chain", rows, "Per frame of five sensors at 100 Hz, one processor, no network.")
    if json_path is not None:
        board.write_json(json_path)
    return board
