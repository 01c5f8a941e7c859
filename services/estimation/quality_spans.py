"""Seconds of a session by what the estimates were like."""

from collections.abc import Callable, Iterable, Sequence
from operator import itemgetter
from typing import Any

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.vocabulary import BODY_MODELS
from services.estimation.parameters import QualityParameters
from services.flow.message import Output
from services.flow.node import State


class Spans:
    """Seconds of rows, by how they are: in which all that is needed was seen, the person moved, the rhythm held."""

    def __init__(self, model: str, needed: Iterable[str], parameters: QualityParameters) -> None:
        order = [dof.name for dof in BODY_MODELS[model]]
        needed = list(needed)
        flexions = [name for name in needed if "flexion" in name] or needed
        self._needed = _getter([order.index(name) for name in needed])
        self._moving = _getter([order.index(name) for name in flexions])
        self._share = 1.0 / max(2, len(flexions))
        self._longest_ns = round(parameters.longest_row_s * 1e9)
        self._per_ns = 1e-9 / parameters.pace_s
        self._moving_pace = parameters.moving_pace if model == "lower_body" else parameters.moving_pace_camera
        self._last_ns: int | None = None
        self._pace = 0.0  # rad/s, mean |rate| of the flexions, smoothed
        self.total_ns = {"spanned": 0, "estimated": 0, "moving": 0, "locked": 0}

    def take(self, joints: JointState, rhythm: Rhythm | None) -> None:
        """Rows of one message, with their rhythm where it was told."""
        last_ns, pace = self._last_ns, self._pace
        spanned = told = moving = locked = 0
        for now_ns, velocity, is_locked in zip(
            joints.captured_ns, joints.velocity, _locked(joints, rhythm), strict=True
        ):
            since_ns = 0 if last_ns is None else now_ns - last_ns
            last_ns = now_ns
            spanned += since_ns
            if since_ns > self._longest_ns:
                continue
            told += since_ns
            pace += since_ns * self._per_ns * (self._share * sum(map(abs, self._moving(velocity))) - pace)
            moving += since_ns if pace > self._moving_pace else 0
            locked += since_ns if is_locked else 0
        self._last_ns, self._pace = last_ns, pace
        estimated = told if all(self._needed(joints.valid)) else 0
        parts = {"spanned": spanned, "estimated": estimated, "moving": moving, "locked": locked}
        self.total_ns = {name: so_far + parts[name] for name, so_far in self.total_ns.items()}

    def seconds(self) -> dict[str, float]:
        """The sums so far, s, by the fields of a DataQuality."""
        return {f"{name}_s": round(ns * 1e-9, 9) for name, ns in self.total_ns.items()}

    def snapshot(self) -> State:
        """Times and sums, ns."""
        return {"last_ns": self._last_ns, "pace": self._pace, "total_ns": dict(self.total_ns)}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._last_ns, self._pace = state["last_ns"], state["pace"]
        self.total_ns = dict(state["total_ns"])


def _getter(places: list[int]) -> Callable[[Sequence[Any]], tuple[Any, ...]]:
    """Values at these places of a row, always as a tuple: a lone place is taken twice.

    Lone feet or a lone back tell no joint: there are no places.
    """
    if not places:
        return lambda _: ()
    return itemgetter(*(places if len(places) > 1 else places * 2))


def take_outputs(spans: Spans, outputs: Iterable[Output]) -> None:
    """Joint states among some outputs, each with the rhythm that follows it."""
    joints: JointState | None = None
    for output in outputs:
        payload = output.payload
        if isinstance(payload, Rhythm) and joints is not None:
            spans.take(joints, payload)
            joints = None
        elif isinstance(payload, JointState):
            if joints is not None:
                spans.take(joints, None)
            joints = payload
    if joints is not None:
        spans.take(joints, None)


def _locked(joints: JointState, rhythm: Rhythm | None) -> list[bool]:
    if rhythm is None:
        return [False] * len(joints.captured_ns)
    if rhythm.captured_ns == joints.captured_ns:
        return rhythm.locked
    known = dict(zip(rhythm.captured_ns, rhythm.locked, strict=True))
    return [known.get(captured_ns, False) for captured_ns in joints.captured_ns]
