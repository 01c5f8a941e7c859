"""A synthetic patient through the whole chain, each stride beside the footfalls that were planned."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from schemas.gait import Stride
from schemas.vocabulary import Side
from services.bench.gait.strides import through_chain
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.footfalls import LATERAL, Footfall
from services.ingest.synthetic.patients.walk import PatientWalk

WITHIN_S = 0.25
"""s by which the contact that ends a stride may be off for the stride to be a true one."""
SAMPLED_S = 0.01
"""s between the instants of a true ankle's path."""


class TrueStride(NamedTuple):
    """What one stride truly was."""

    side: Side
    start_s: float
    end_s: float
    stance_fraction: float
    step_length_m: float  # of the step that ends it
    stride_length_m: float
    first_double_support: float  # share of the stride
    circumduction_m: float

    @property
    def time_s(self) -> float:
        """From contact to contact."""
        return self.end_s - self.start_s

    @property
    def speed(self) -> float:
        """m/s."""
        return self.stride_length_m / self.time_s


@dataclass(frozen=True)
class Walked:
    """One walk: every stride that counts, with its truth."""

    kind: str
    speed: float
    affected: Side
    pairs: Sequence[tuple[Stride, TrueStride]]
    true: int  # strides walked between the first and the last step of each bout
    invented: int  # strides that count but begin or end where no foot came down


def true_strides(walk: PatientWalk) -> list[TrueStride]:
    """Of every bout but its first and last stride, which begin or end in standing."""
    found = []
    for bout in walk.footfalls.bouts:
        for number in range(1, len(bout) - 3):
            found.append(_true_stride(walk, bout[number : number + 3]))
    return found


def _true_stride(walk: PatientWalk, falls: list[Footfall]) -> TrueStride:
    start, opposite, end = falls
    before = max(
        (one for one in walk.footfalls.by_side[start.side.other] if one.contact_s < start.contact_s),
        key=lambda one: one.contact_s,
    )
    time_s = end.contact_s - start.contact_s
    return TrueStride(
        start.side,
        start.contact_s,
        end.contact_s,
        (start.toe_off_s - start.contact_s) / time_s,
        end.forward - opposite.forward,
        end.forward - start.forward,
        (before.toe_off_s - start.contact_s) / time_s,
        _circumduction(walk, start, end),
    )


def _circumduction(walk: PatientWalk, start: Footfall, end: Footfall) -> float:
    """m, largest outward distance of the true ankle from the line between its two places."""
    ankle = walk.body(np.arange(start.contact_s, end.contact_s, SAMPLED_S)).ankle(start.side).position[:, [0, 2]]
    along = np.array([end.forward - start.forward, end.aside - start.aside])
    to_the_right = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    return max(0.0, float((LATERAL[start.side] * (ankle - ankle[0]) @ to_the_right).max()))


def walked(query: str, estimator: str) -> Walked:
    """The walk of `patient=hemiparetic&speed=0.4&seed=3`."""
    parameters = WalkParameters.parse(query)
    walk = PatientWalk(parameters)
    found = through_chain(f"synthetic:walk?{query}", estimator).found
    strides = [stride for stride in found.strides if stride.valid]
    true = true_strides(walk)
    return Walked(
        walk.kind, parameters.speed, walk.affected, _paired(strides, true), len(true), _invented(strides, walk)
    )


def _paired(strides: Iterable[Stride], true: Sequence[TrueStride]) -> list[tuple[Stride, TrueStride]]:
    pairs = []
    for stride in strides:
        same = [one for one in true if one.side is stride.side]
        nearest = min(same, key=lambda one: abs(one.end_s - stride.end_ns / 1e9), default=None)
        if nearest is not None and _is(stride, nearest):
            pairs.append((stride, nearest))
    return pairs


def _invented(strides: Iterable[Stride], walk: PatientWalk) -> int:
    contacts = {side: np.array(walk.footfalls.contacts_s(side)) for side in Side}
    ends = [(contacts[stride.side], at / 1e9) for stride in strides for at in (stride.start_ns, stride.end_ns)]
    return sum(bool(np.abs(true - at).min() > WITHIN_S) for true, at in ends)


def _is(stride: Stride, true: TrueStride) -> bool:
    ends = abs(true.end_s - stride.end_ns / 1e9), abs(true.start_s - stride.start_ns / 1e9)
    return max(ends) < WITHIN_S
