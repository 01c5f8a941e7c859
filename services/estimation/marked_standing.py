"""Standing that the operator marks while the session runs: was it standing, and what does it tell?

The last seconds are remembered as sums over short blocks, so that a mark can be judged whenever it comes. A mark in
which somebody moved or sat is refused with a reason that a therapist understands.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from schemas.imu import ImuBatch
from schemas.payload import Payload
from schemas.session import SensorDescription
from schemas.standing import StandingMark
from services.biomech.rotations import angle_between
from services.estimation.alignment import Alignment
from services.estimation.parameters import StandingParameters
from services.estimation.samples import FORCE, RATE, Tick, TickBatch, pack_batches, unpack_batches
from services.estimation.standing import THIGHS, StandingReference, Sums, refer, sits
from services.flow.node import State

SITTING = "sitting, not standing"
EVERYTHING = "the person"


@dataclass(frozen=True)
class Refused:
    """Why a mark was not taken."""

    reason: str


@dataclass(frozen=True)
class _Block:
    """Sums over one interval of the grid, or the part of the newest one that a mark covers."""

    number: int
    seconds: float
    sums: Sums


class RecentMotion:
    """What all sensors said in the last `remember_s`. Blocks lie on a fixed grid of session time."""

    def __init__(self, sensors: Sequence[SensorDescription], parameters: StandingParameters) -> None:
        self.sensors = sensors
        self.parameters = parameters
        self._block_ns = round(parameters.block_s * 1e9)
        self._most = round(parameters.remember_s / parameters.block_s)
        self._blocks: list[_Block] = []
        self._open: list[Tick] = []

    def add(self, tick: Tick) -> None:
        """Take the next tick. Called for every one, so it only keeps it until its block is full."""
        if self._open and tick.captured_ns // self._block_ns != self._open[0].captured_ns // self._block_ns:
            self._blocks.append(self._sum_up(self._open, self.parameters.block_s))
            self._open = []
            del self._blocks[: -self._most]
        self._open.append(tick)

    def judge(self, mark: StandingMark, alignment: Alignment | None) -> StandingReference | Refused:
        """What the marked span tells, or why it is no standing.

        With an alignment from before, sitting is seen however the sensors are worn; without one, only thigh sensors
        that are not worn on the side tell it.
        """
        blocks = self._inside(mark)
        duration_s = sum(block.seconds for block in blocks)
        if duration_s < self.parameters.shortest_s:
            return Refused(f"only {duration_s:.2g} s of samples, {self.parameters.shortest_s:g} s are needed")
        moved = [sensor.name for s, sensor in enumerate(self.sensors) if self._moved(s, blocks)]
        if moved:
            return Refused(f"{', '.join(moved) if len(moved) < len(self.sensors) else EVERYTHING} moved")
        total = Sums.zero(len(self.sensors))
        for block in blocks:
            total.add(block.sums)
        reference = replace(refer(total, mark.to_ns, duration_s, self.parameters), marked=True)
        if not reference.usable.any():
            return Refused("no sensor measured gravity")
        if sits(reference, self.sensors, self.parameters) or self._sits_now(reference, alignment):
            return Refused(SITTING)
        return reference

    def _inside(self, mark: StandingMark) -> list[_Block]:
        """Whole blocks within the mark, and the open one as far as it lies within."""
        inside = [
            block
            for block in self._blocks
            if block.number * self._block_ns >= mark.from_ns and (block.number + 1) * self._block_ns <= mark.to_ns
        ]
        newest = [tick for tick in self._open if mark.from_ns <= tick.captured_ns <= mark.to_ns]
        if len(newest) < 2:
            return inside
        return [*inside, self._sum_up(newest, (newest[-1].captured_ns - newest[0].captured_ns) / 1e9)]

    def _sum_up(self, ticks: Sequence[Tick], seconds: float) -> _Block:
        sums = Sums.zero(len(self.sensors))
        sums.add_ticks(np.array([tick.samples for tick in ticks]), np.array([tick.fresh for tick in ticks]))
        return _Block(ticks[0].captured_ns // self._block_ns, seconds, sums)

    def _moved(self, s: int, blocks: Sequence[_Block]) -> bool:
        limits = self.parameters
        heard = [block for block in blocks if block.sums.count[s] > 0]
        means = [block.sums.mean()[s] for block in heard]
        return any(
            np.linalg.norm(mean[RATE]) >= limits.still_rate
            or np.linalg.norm(block.sums.std()[s, FORCE]) >= limits.still_force_std
            or angle_between(mean[FORCE], means[0][FORCE]) >= limits.leaning
            for block, mean in zip(heard, means, strict=True)
        )

    def _sits_now(self, reference: StandingReference, alignment: Alignment | None) -> bool:
        """A thigh is far from where it hung in the standing before. Row 1 of the rotation is the segment's up."""
        if alignment is None:
            return False
        up = alignment.R_segment_from_sensor[:, 1]
        return any(
            sensor.segment in THIGHS
            and reference.usable[s]
            and alignment.aligned[s]
            and angle_between(reference.mean_force[s], up[s]) > self.parameters.seated_thigh
            for s, sensor in enumerate(self.sensors)
        )

    def snapshot(self) -> State:
        """Blocks and the open ticks."""
        return {
            "numbers": [block.number for block in self._blocks],
            "sums": [block.sums.pack() for block in self._blocks],
            "open": pack_batches([TickBatch(0, tuple(self._open))]),
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        sums = [Sums.unpack(packed) for packed in state["sums"]]
        block_s = self.parameters.block_s
        self._blocks = [_Block(number, block_s, each) for number, each in zip(state["numbers"], sums, strict=True)]
        self._open = list(unpack_batches(state["open"], len(self.sensors))[0].ticks)


class Marks:
    """The marks of a session from the message that brings them to what the screen says of them."""

    def __init__(self, sensors: Sequence[SensorDescription], standing: StandingParameters, notice_s: float) -> None:
        self._recent = RecentMotion(sensors, standing)
        self._notice_ns = round(notice_s * 1e9)
        self._given: list[StandingMark] = []
        self._notice, self._notice_until_ns = "", 0

    def note(self, payload: Payload | None) -> None:
        """Keep the marks of an imu message until their time has come."""
        if isinstance(payload, ImuBatch):
            self._given += payload.marks

    def runs(self, ticks: Sequence[Tick]) -> list[tuple[list[StandingMark], Sequence[Tick]]]:
        """The ticks in runs, each with the marks that count from its first tick on. The marks are handed out once."""
        if not self._given:
            return [([], ticks)] if ticks else []
        runs = parted(ticks, self._given)
        for marks, _ in runs:
            self._given = [mark for mark in self._given if mark not in marks]
        return runs

    def watch(self, ticks: Iterable[Tick]) -> None:
        """Remember what was measured, for marks to come."""
        for tick in ticks:
            self._recent.add(tick)

    def judge(self, mark: StandingMark, alignment: Alignment | None, now_ns: int) -> StandingReference | None:
        """See RecentMotion.judge; where it refuses, the screen says why."""
        verdict = self._recent.judge(mark, alignment)
        if isinstance(verdict, Refused):
            self.refuse(verdict.reason, now_ns)
            return None
        return verdict

    def refuse(self, reason: str, now_ns: int) -> None:
        """A mark is not taken."""
        self.say(f"Not taken as standing: {reason}", now_ns)

    def say(self, notice: str, now_ns: int) -> None:
        """What the screen says for the next seconds."""
        self._notice, self._notice_until_ns = notice, now_ns + self._notice_ns

    def notice_at(self, captured_ns: int) -> str:
        """What the screen says now."""
        return self._notice if captured_ns <= self._notice_until_ns else ""

    def snapshot(self) -> State:
        """What was measured, which marks wait, what the screen says."""
        return {
            "recent": self._recent.snapshot(),
            "given": [mark.model_dump() for mark in self._given],
            "notice": [self._notice, self._notice_until_ns],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._recent.restore(state["recent"])
        self._given = [StandingMark(**mark) for mark in state["given"]]
        self._notice, self._notice_until_ns = state["notice"]


def parted(ticks: Sequence[Tick], marks: Sequence[StandingMark]) -> list[tuple[list[StandingMark], Sequence[Tick]]]:
    """The ticks in runs, each with the marks that count from its first tick on: the first later than `given_ns`."""
    if not ticks:
        return []
    cuts: dict[int, list[StandingMark]] = {0: []}
    for mark in marks:
        first = next((i for i, tick in enumerate(ticks) if tick.captured_ns > mark.given_ns), None)
        if first is not None:
            cuts.setdefault(first, []).append(mark)
    starts = sorted(cuts)
    return [(cuts[start], ticks[start:end]) for start, end in zip(starts, [*starts[1:], len(ticks)], strict=True)]
