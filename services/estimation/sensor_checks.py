"""Which samples may be used, and what state that leaves a sensor in."""

import math
from collections import Counter
from dataclasses import dataclass, field
from operator import sub

import numpy as np

from schemas.health import Reason, Rejection
from schemas.vocabulary import SensorState
from services.estimation.parameters import CheckParameters
from services.estimation.samples import Values
from services.flow.node import State, pack_array, unpack_array

NOTHING_YET: Values = (math.nan,) * 6


def within(values: Values, most_rate: float, most_force: float) -> bool:
    """No magnitude of the angular velocity or the specific force is larger; not a number is never within."""
    a, b, c, d, e, f = values
    return (
        -most_rate <= a <= most_rate and -most_rate <= b <= most_rate and -most_rate <= c <= most_rate
        and -most_force <= d <= most_force and -most_force <= e <= most_force and -most_force <= f <= most_force
    )  # fmt: skip


@dataclass(slots=True)
class SensorRecord:
    """What is remembered of one sensor."""

    newest_ns: int | None = None  # of any sample whose clock was right
    usable_ns: int | None = None  # of the last sample that was used
    values: Values = NOTHING_YET  # last sample, used or not
    repeats: int = 0  # how often those values came again
    jumped: bool = False  # the last sample was refused as a jump


@dataclass
class SensorChecks:
    """Judges samples one by one and counts what it refuses, by subject and reason."""

    names: list[str]
    parameters: CheckParameters = field(default_factory=CheckParameters)
    records: list[SensorRecord] = field(default_factory=list)
    refused: Counter[tuple[str, Reason]] = field(default_factory=Counter)
    dated: list[tuple[int, int, str]] = field(default_factory=list)
    """Refused samples that nobody has counted by time yet: ns, sensor, reason."""

    def __post_init__(self) -> None:
        self.records = [SensorRecord() for _ in self.names]

    def refuse(self, subject: str, reason: Reason, count: int = 1) -> None:
        """Count something that was not used."""
        self.refused[subject, reason] += count

    def refuse_sample(self, sensor: int, captured_ns: int, reason: Reason) -> None:
        """Count a sample that was not used. A broken clock's is dated with the last one that was right."""
        self.refuse(self.names[sensor], reason)
        newest_ns = self.records[sensor].newest_ns or 0
        is_plausible = captured_ns - newest_ns <= self.parameters.farthest_from_message_s * 1e9
        self.dated.append((max(newest_ns, captured_ns) if is_plausible else newest_ns, sensor, reason.value))

    def refused_before(self, until_ns: int | None) -> list[tuple[int, int, str]]:
        """Refused samples dated before a time, or all: handed out once."""
        if not self.dated:
            return []
        taken = [each for each in self.dated if until_ns is None or each[0] < until_ns]
        self.dated = [each for each in self.dated if until_ns is not None and each[0] >= until_ns]
        return taken

    def accept(self, sensor: int, captured_ns: int, values: Values, message_ns: int) -> bool:
        """Whether a sample (6,) may be used."""
        record = self.records[sensor]
        reason = self._reason(record, captured_ns, values, message_ns)
        if reason is not None:
            self.refuse_sample(sensor, captured_ns, reason)
            return False
        record.usable_ns = captured_ns
        return True

    def _reason(self, record: SensorRecord, captured_ns: int, values: Values, message_ns: int) -> Reason | None:
        limits = self.parameters
        if abs(captured_ns - message_ns) > limits.farthest_from_message_s * 1e9:
            return Reason.OUT_OF_RANGE
        if record.newest_ns is not None and captured_ns <= record.newest_ns:
            return Reason.CLOCK_BACKWARDS
        plausible = within(values, limits.largest_rate, limits.largest_force)
        if not plausible and not all(map(math.isfinite, values)):
            return Reason.NOT_FINITE
        record.newest_ns = captured_ns
        before, record.values = record.values, values
        record.repeats = record.repeats + 1 if values == before else 0
        if not plausible:
            return Reason.OUT_OF_RANGE
        if record.repeats >= limits.stuck_after:
            return Reason.STUCK
        # A lone jump is a broken sample; when the next one stays there, it was a real change.
        jumps = not within(tuple(map(sub, values, before)), limits.rate_jump, limits.force_jump)
        record.jumped = jumps and not record.jumped and not math.isnan(before[0])
        return Reason.OUT_OF_RANGE if record.jumped else None

    def is_silent(self, sensor: int, now_ns: int) -> bool:
        """No usable sample for so long that its joints are no longer observed."""
        usable_ns = self.records[sensor].usable_ns
        return usable_ns is None or now_ns - usable_ns > self.parameters.silent_after_s * 1e9

    def state_of(self, sensor: int, now_ns: int) -> tuple[SensorState, int]:
        """State and since when, ns of session time."""
        record = self.records[sensor]
        if not self.is_silent(sensor, now_ns):
            return SensorState.OK, record.usable_ns or 0
        since_ns = record.usable_ns or 0
        if record.newest_ns is None or now_ns - record.newest_ns > self.parameters.silent_after_s * 1e9:
            return SensorState.MISSING, since_ns
        return (SensorState.STUCK if record.repeats >= self.parameters.stuck_after else SensorState.REJECTED), since_ns

    def rejections(self) -> list[Rejection]:
        """The counts, sorted."""
        return [
            Rejection(subject=subject, reason=reason, count=count)
            for (subject, reason), count in sorted(self.refused.items())
        ]

    def snapshot(self) -> State:
        """Records and counts."""
        return {
            "values": pack_array(np.array([record.values for record in self.records]).reshape(-1, 6)),
            "records": [[r.newest_ns, r.usable_ns, r.repeats, r.jumped] for r in self.records],
            "refused": [[subject, str(reason), count] for (subject, reason), count in sorted(self.refused.items())],
            "dated": [list(each) for each in self.dated],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self.records = [
            SensorRecord(newest_ns, usable_ns, tuple(values), repeats, jumped)
            for (newest_ns, usable_ns, repeats, jumped), values in zip(
                state["records"], unpack_array(state["values"]).tolist(), strict=True
            )
        ]
        self.refused = Counter({(subject, Reason(reason)): count for subject, reason, count in state["refused"]})
        self.dated = [(captured_ns, sensor, reason) for captured_ns, sensor, reason in state["dated"]]
