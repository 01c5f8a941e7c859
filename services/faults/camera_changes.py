"""How each camera fault changes a frame, or takes it away, one function per fault."""

from collections.abc import Callable, Sequence
from functools import singledispatch
from typing import NamedTuple

import numpy as np

from schemas.vocabulary import SkeletonJoint, TrackingState
from services.faults.bursts import BurstChannel
from services.faults.camera_faults import (
    BodyRenumbered,
    CameraCovered,
    CameraFault,
    CameraSilent,
    FrameLoss,
    JointJump,
    JointsInferred,
    LegsExchanged,
)


class Frame(NamedTuple):
    """One frame of one camera."""

    captured_ns: int
    body: int | None
    people: int
    position: list[list[float] | None]
    state: list[TrackingState]


FrameChange = Callable[[Frame], Frame | None]
"""The frame as it arrives; None: it does not."""

LEG = ("hip", "knee", "ankle", "foot")


@singledispatch
def frame_change(fault: CameraFault, _joints: Sequence[SkeletonJoint]) -> FrameChange:
    """A fresh change for one stream whose frames have these joints. Raises TypeError for what changes no frame."""
    raise TypeError(f"{fault!r} changes no frames")


def _within(fault: CameraCovered | CameraSilent | JointsInferred | LegsExchanged, frame: Frame) -> bool:
    return fault.from_s <= frame.captured_ns * 1e-9 < fault.to_s


@frame_change.register
def _(fault: CameraCovered, joints: Sequence[SkeletonJoint]) -> FrameChange:
    nothing: list[list[float] | None] = [None] * len(joints)
    unseen = [TrackingState.NOT_TRACKED] * len(joints)

    def cover(frame: Frame) -> Frame:
        return Frame(frame.captured_ns, None, 0, list(nothing), list(unseen)) if _within(fault, frame) else frame

    return cover


@frame_change.register
def _(fault: CameraSilent, _joints: Sequence[SkeletonJoint]) -> FrameChange:
    return lambda frame: None if _within(fault, frame) else frame


@frame_change.register
def _(fault: FrameLoss, _joints: Sequence[SkeletonJoint]) -> FrameChange:
    channel = BurstChannel(fault.model, fault.seed)
    return lambda frame: None if channel.loses() else frame


@frame_change.register
def _(fault: JointsInferred, joints: Sequence[SkeletonJoint]) -> FrameChange:
    hidden = [joints.index(joint) for joint in fault.joints]
    random = np.random.default_rng(fault.seed)
    seen: dict[int, list[float]] = {}

    def guess(frame: Frame) -> Frame:
        if not _within(fault, frame):
            seen.update({j: at for j in hidden if (at := frame.position[j]) is not None})
            return frame
        position, state = list(frame.position), list(frame.state)
        for j in hidden:
            last = seen.get(j, frame.position[j])
            if last is not None and frame.position[j] is not None:
                position[j] = [
                    value + error for value, error in zip(last, random.normal(0, fault.noise_m, 3), strict=True)
                ]
                state[j] = TrackingState.INFERRED
        return frame._replace(position=position, state=state)

    return guess


@frame_change.register
def _(fault: LegsExchanged, joints: Sequence[SkeletonJoint]) -> FrameChange:
    names = {str(joint): j for j, joint in enumerate(joints)}
    other = {names[f"{part}_{a}"]: names[f"{part}_{b}"]
             for part in LEG if f"{part}_left" in names and f"{part}_right" in names
             for a, b in (("left", "right"), ("right", "left"))}  # fmt: skip
    order = [other.get(j, j) for j in range(len(joints))]

    def exchange(frame: Frame) -> Frame:
        if not _within(fault, frame):
            return frame
        return frame._replace(position=[frame.position[j] for j in order], state=[frame.state[j] for j in order])

    return exchange


@frame_change.register
def _(fault: JointJump, joints: Sequence[SkeletonJoint]) -> FrameChange:
    place = joints.index(fault.joint)
    is_over = False

    def jump(frame: Frame) -> Frame:
        nonlocal is_over
        at = frame.position[place]
        if is_over or at is None or frame.captured_ns * 1e-9 < fault.at_s:
            return frame
        is_over = True
        position = list(frame.position)
        position[place] = [value + step for value, step in zip(at, fault.by_m, strict=True)]
        return frame._replace(position=position)

    return jump


@frame_change.register
def _(fault: BodyRenumbered, _joints: Sequence[SkeletonJoint]) -> FrameChange:
    def renumber(frame: Frame) -> Frame:
        if frame.body is None or frame.captured_ns * 1e-9 < fault.at_s:
            return frame
        return frame._replace(body=frame.body + 1)

    return renumber
