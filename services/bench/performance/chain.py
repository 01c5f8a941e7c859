"""What one frame of five sensors or of a camera costs in the plain loop: each node, and the coding between them.

Processor time is measured, in pieces of a few seconds of movement, so that a busy machine disturbs it little.
"""

import statistics
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from schemas.signals import IMU, SKELETON, Signal
from services.bench.scoreboard import Row, Scoreboard, at_least, at_most, informative
from services.cli.assembly import build_chain
from services.flow.host import HostedNode
from services.flow.message import Message, decode_payload, encode_payload
from services.ingest.source import iter_messages, open_source

WALK = "synthetic:walk?speed=1.2&seed=3&duration=60"
SQUATS = "synthetic:squat?person=3&repetitions=12"
RATE_HZ, CAMERA_RATE_HZ = 100.0, 30.0
PIECE_S = 2.0
"""s of frames between two readings of the sums."""
PATIENTS = 30
"""Before cameras, on one core with the rest of the chain."""
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


def frame_costs_us(spec: str, signal: Signal, rate_hz: float, frames_per_message: int) -> dict[str, float]:
    """Median us per frame of each node and of the coding, while the person moves."""
    source = open_source(spec)
    hosts = build_chain(source.describe()).hosts
    pieces: list[dict[str, float]] = []
    costs, frames = Costs(), 0
    for message in iter_messages(source, frames_per_message):
        if message.stream.signal is not signal:
            continue
        _pass(hosts, message, costs)
        frames += frames_per_message
        if frames >= PIECE_S * rate_hz:
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
        costs = frame_costs_us(WALK, IMU, RATE_HZ, frames)
        total = sum(costs.values())
        group = f"{frames} frame{'s' if frames > 1 else ''} in a message"
        rows.append(at_most(f"{group}: estimation", costs.pop("estimation"), "us", target_us))
        rows += [informative(f"{group}: {name}", cost, "us") for name, cost in costs.items()]
        rows += [
            informative(f"{group}: everything", total, "us"),
            at_least(f"{group}: faster than real time", 1e6 / RATE_HZ / total, "x", 20.0),
        ]
    note = "Per frame of five sensors at 100 Hz or of a camera at 30 Hz, one processor, no network."
    board = Scoreboard("chain", [*rows, *_camera_rows()], note)
    if json_path is not None:
        board.write_json(json_path)
    return board


def _camera_rows() -> list[Row]:
    costs = frame_costs_us(SQUATS, SKELETON, CAMERA_RATE_HZ, 1)
    total = sum(costs.values())
    return [
        *(informative(f"camera: {name}", cost, "us") for name, cost in costs.items()),
        informative("camera: everything", total, "us"),
        at_least("camera: patients at 30 Hz on one core", 1e6 / CAMERA_RATE_HZ / total, "", PATIENTS),
    ]
