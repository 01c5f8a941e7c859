"""How strides are judged: which true events were found, how far off they are, how long the strides really were."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks

from schemas.gait import GaitEvent, Stride
from schemas.imu import ReferenceBatch
from schemas.session import SessionDescription
from schemas.vocabulary import GaitEventKind, Side
from services.segmentation.parameters import SegmentationParameters

Array = NDArray[np.float64]

MATCH_S = 0.45
"""s within which a found event can be a true one; less than a step."""
EXCURSION_M = 0.1
"""m by which an ankle goes forth and back in a step that is counted in the optical truth."""


class Truth:
    """The reference channels of a session over time; NaN where the truth is not known."""

    def __init__(self, description: SessionDescription) -> None:
        self._column = {channel.name: i for i, channel in enumerate(description.reference)}
        self._captured_ns: list[int] = []
        self._rows: list[list[float | None]] = []

    def take(self, batch: ReferenceBatch) -> None:
        """Add a batch."""
        self._captured_ns += batch.captured_ns
        self._rows += batch.values

    @property
    def time_s(self) -> Array:
        """Times of the samples (n,), s."""
        return np.array(self._captured_ns) * 1e-9

    def channel(self, name: str) -> Array:
        """One channel (n,). Raises KeyError for one that the session does not have."""
        column = self._column[name]
        return np.array([np.nan if row[column] is None else row[column] for row in self._rows], dtype=np.float64)

    def point(self, name: str) -> Array:
        """A point (n, 3) in m."""
        return np.column_stack([self.channel(f"{name}_{axis}") for axis in "xyz"])

    def contact_edges_s(self, side: Side, kind: GaitEventKind) -> Array:
        """Times at which the contact channel rises (initial contact) or falls (toe-off), s."""
        sign = 1 if kind is GaitEventKind.INITIAL_CONTACT else -1
        edges: Array = self.time_s[1:][np.diff(self.channel(f"foot_contact_{side}")) * sign > 0]
        return edges

    def ankle_turns_s(self, side: Side, kind: GaitEventKind) -> Array:
        """Events by the rule of segmentation, but from optical joint centres: how much is the estimate's fault."""
        parameters = SegmentationParameters()
        left, right = self.point("hip_left"), self.point("hip_right")
        forward = np.cross([0.0, 1.0, 0.0], right - left)
        forward /= np.linalg.norm(forward, axis=1)[:, None]
        ahead = np.sum((self.point(f"ankle_{side}") - 0.5 * (left + right)) * forward, axis=1)
        contact = kind is GaitEventKind.INITIAL_CONTACT
        turns, _ = find_peaks(ahead if contact else -ahead, prominence=EXCURSION_M)
        delay = parameters.contact_after_foremost_s if contact else parameters.toe_off_after_hindmost_s
        times: Array = self.time_s[turns] + delay
        return times

    def distance(self, side: Side, start_ns: int, end_ns: int) -> float:
        """Way over ground of an ankle between two times, m."""
        ankle, time_s = self.point(f"ankle_{side}"), self.time_s
        ends_s = np.array([start_ns, end_ns]) * 1e-9
        ways = [np.diff(np.interp(ends_s, time_s, ankle[:, axis]))[0] for axis in (0, 2)]
        return float(np.hypot(*ways))


@dataclass
class Found:
    """What segmentation found."""

    events: list[GaitEvent] = field(default_factory=list)
    strides: list[Stride] = field(default_factory=list)

    def times_s(self, side: Side, kind: GaitEventKind) -> Array:
        """Times of one kind of event, s."""
        return np.array([e.captured_ns * 1e-9 for e in self.events if (e.side, e.kind) == (side, kind)])

    def claimed_ms(self, kind: GaitEventKind) -> float | None:
        """Mean standard deviation that the events of one kind claim for themselves, ms; None without an event."""
        claimed = [event.time_std_s for event in self.events if event.kind is kind]
        return round(float(np.mean(claimed)) * 1e3, 1) if claimed else None

    def straight(self) -> Iterable[Stride]:
        """Strides that count."""
        return [stride for stride in self.strides if stride.valid and not stride.turning]


@dataclass(frozen=True)
class Matched:
    """Pairs of true and found events."""

    errors_s: Array  # found - true
    missed: int
    extra: int

    @property
    def bias_ms(self) -> float | None:
        """Mean error, ms; None without a pair."""
        return round(float(np.mean(self.errors_s)) * 1e3, 1) if len(self.errors_s) else None

    @property
    def spread_ms(self) -> float | None:
        """Standard deviation of the error, ms; None below two pairs."""
        return round(float(np.std(self.errors_s, ddof=1)) * 1e3, 1) if len(self.errors_s) > 1 else None


def pairs(true_s: Array, found_s: Array) -> list[tuple[int, int]]:
    """Indices of each true event and the nearest found one not taken yet, within MATCH_S; nearest pairs first."""
    gaps = sorted((abs(f - t), i, j) for i, t in enumerate(true_s) for j, f in enumerate(found_s))
    taken: list[tuple[int, int]] = []
    taken_true: set[int] = set()
    taken_found: set[int] = set()
    for gap, i, j in gaps:
        if gap <= MATCH_S and i not in taken_true and j not in taken_found:
            taken_true.add(i)
            taken_found.add(j)
            taken.append((i, j))
    return taken


def match(true_s: Array, found_s: Array) -> Matched:
    """The errors of the pairs, and how many events have no partner."""
    errors = [found_s[j] - true_s[i] for i, j in pairs(true_s, found_s)]
    return Matched(np.array(errors), len(true_s) - len(errors), len(found_s) - len(errors))


def stride_time_errors_s(true_s: Array, found_s: Array) -> Array:
    """Errors (k,) s of the times between neighbouring events of one foot, where both were found."""
    partner = dict(pairs(true_s, found_s))
    errors = [
        (found_s[partner[i + 1]] - found_s[partner[i]]) - (true_s[i + 1] - true_s[i])
        for i in range(len(true_s) - 1)
        if i in partner and i + 1 in partner
    ]
    return np.array(errors)


def together(parts: Iterable[Matched]) -> Matched:
    """Several lists of pairs as one."""
    listed = list(parts)
    errors = np.concatenate([np.zeros(0), *(part.errors_s for part in listed)])
    return Matched(errors, sum(part.missed for part in listed), sum(part.extra for part in listed))


def length_errors(found: Found, truth: Truth) -> tuple[Array, Array]:
    """Errors (m) of stride length and (m/s) of walking speed over the strides that count and have a length."""
    errors = []
    for stride in found.straight():
        if stride.stride_length_m is not None:
            error = stride.stride_length_m - truth.distance(stride.side, stride.start_ns, stride.end_ns)
            errors.append((error, error / stride.stride_time_s))
    table = np.array(errors).reshape(-1, 2)
    return table[:, 0], table[:, 1]
