"""Agreement of an estimated angle with a measured one, and the estimates of a recording through the live nodes."""

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointState
from schemas.session import SessionDescription, WalkPath
from schemas.signals import JOINT_STATE
from schemas.vocabulary import LOWER_BODY
from services.estimation.node import build
from services.flow.chain import Chain
from services.flow.host import HostedNode
from services.flow.node import Node
from services.ingest.source import iter_messages, open_source

Array = NDArray[np.float64]

SHIFTS = range(-3, 4)
"""Samples that one constant shift between the clocks of sensors and reference may have."""


class Score(NamedTuple):
    """Agreement of one angle with one truth."""

    offset_removed_deg: float
    absolute_deg: float
    correlation: float
    shift: int


def score(estimate: Array, truth: Array, frames: NDArray[np.int64], shift: int) -> Score:
    """Compare estimate sample i + shift with truth sample i, both (n,) in degrees."""
    error = estimate[frames + shift] - truth[frames]
    return Score(
        float(np.std(error)),
        float(np.sqrt(np.mean(error**2))),
        float(np.corrcoef(estimate[frames + shift], truth[frames])[0, 1]),
        shift,
    )


def best_score(estimate: Array, truth: Array, frames: NDArray[np.int64]) -> Score:
    """`score` at the constant shift that agrees best."""
    return min((score(estimate, truth, frames, shift) for shift in SHIFTS), key=lambda s: s.offset_removed_deg)


def estimate_angles(
    spec: str,
    estimator: str,
    build_node: Callable[[SessionDescription], Node] = build,
    during_s: tuple[float, float] = (0.0, math.inf),
    walk_path: WalkPath | None = None,
    quantity: Literal["position", "position_std"] = "position",
) -> Array:
    """Joint angles, or their deviations, (frames, 15) in degrees through ingest and node, NaN where there is none.

    For a recording whose sensors share one rate: frame i was captured i / rate after the start. The node is shown
    what was captured `during_s`, from and before.
    """
    source = open_source(spec, session="accuracy", estimator=estimator, walk_path=walk_path)
    description = source.describe()
    chain = Chain([HostedNode("estimation", description.session, build_node(description))])
    rows: list[tuple[int, list[float]]] = []
    for message in iter_messages(source):
        is_shown = during_s[0] <= message.envelope.captured_ns / 1e9 < during_s[1]
        for produced in chain.push(message) if is_shown or message.envelope.final else ():
            if produced.stream.signal is JOINT_STATE and isinstance(produced.payload, JointState):
                rows += zip(produced.payload.captured_ns, getattr(produced.payload, quantity), strict=True)
    return _on_frames(rows, description.hubs[0].sensors[0].rate_hz)


def _on_frames(rows: list[tuple[int, list[float]]], rate_hz: float) -> Array:
    frames = [round(captured_ns * rate_hz / 1e9) for captured_ns, _ in rows]
    angles = np.full((max(frames, default=0) + 1, len(LOWER_BODY)), np.nan)
    angles[frames] = np.degrees(np.array([position for _, position in rows]).reshape(-1, len(LOWER_BODY)))
    return angles


def column_of(name: str) -> int:
    """Index of a degree of freedom in LOWER_BODY."""
    return next(i for i, dof in enumerate(LOWER_BODY) if dof.name == name)
