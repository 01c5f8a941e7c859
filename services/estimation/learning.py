"""What a session's rhythm learns, and what it is told: rows in, learned rhythms out, a known one to start from."""

from collections.abc import Sequence

import numpy as np

from schemas.rhythm import KnownRhythm, LearnedJoint, LearnedRhythm
from services.biomech.rhythm.learned import Learned, LearnedStrides, velocity_waveform
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.rows import MODEL, RHYTHM_CHANNELS, Row, places
from services.flow.node import State

LEAST_STRIDES = 3
"""Strides below which nothing counts as learned: as many as a mean needs in the metrics."""
OWN_KINDS = ("previous trial", "previous visit")
"""Known rhythms that the estimator starts from, the nearest first. An exemplar is somebody else: only to compare."""


class RhythmLearning:
    """Mean stride of one session. Reported when a bout of lock ends, and at the end, if strides were added.

    Only strides throughout which the same joints are valid count; the first of them says which joints those are.
    """

    def __init__(self, model: str = MODEL) -> None:
        self._joints = places(model, RHYTHM_CHANNELS)
        self._strides = LearnedStrides(len(RHYTHM_CHANNELS))
        self._valid: list[bool] = []
        """Of the joints that are learned; empty before the first sample with a lock."""
        self._last_ns = 0
        self._was_locked = False
        self._reported = 0

    def take(self, row: Row, valid: Sequence[bool]) -> LearnedRhythm | None:
        """Take one row with the validity of its coordinates; a report when it ends a bout of lock."""
        seen = [valid[joint] for joint in self._joints]
        locked, dt_s = row.rhythm.locked, (row.captured_ns - self._last_ns) / 1e9
        if seen != self._valid:
            self._strides.interrupt()
            if locked and any(seen) and self._strides.strides == 0:
                self._valid = seen
        if seen == self._valid:
            self._strides.take([row.velocity[joint] for joint in self._joints], row.rhythm, dt_s)
        self._last_ns = row.captured_ns
        ended = self._was_locked and not locked
        self._was_locked = locked
        return self.report() if ended else None

    def report(self) -> LearnedRhythm | None:
        """What has been learned, if it is enough and more than was reported before."""
        learned = self._strides.result()
        if learned.strides < LEAST_STRIDES or learned.strides == self._reported:
            return None
        self._reported = learned.strides
        return described(learned, self._valid, self._last_ns)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "strides": self._strides.snapshot(),
            "valid": list(self._valid),
            "last_ns": self._last_ns,
            "was_locked": self._was_locked,
            "reported": self._reported,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._strides.restore(state["strides"])
        self._valid = list(state["valid"])
        self._last_ns = state["last_ns"]
        self._was_locked = state["was_locked"]
        self._reported = state["reported"]


def described(learned: Learned, seen: Sequence[bool], captured_ns: int) -> LearnedRhythm:
    """What was learned of RHYTHM_CHANNELS as a message, with the joints that were seen. Needs one stride."""
    rows = zip(RHYTHM_CHANNELS, seen, learned.cosine, learned.sine, learned.spread, strict=True)
    return LearnedRhythm(
        captured_ns=captured_ns,
        frequency=learned.frequency,
        frequency_spread=learned.frequency_spread,
        strides=learned.strides,
        quality=learned.quality,
        joints=[
            LearnedJoint(degree_of_freedom=name, cosine=cosine.tolist(), sine=sine.tolist(), spread=spread.tolist())
            for name, is_seen, cosine, sine, spread in rows
            if is_seen
        ],
    )


def start_rhythm(rhythm: TrustedRhythm, known_rhythms: Sequence[KnownRhythm]) -> None:
    """Let the rhythm know the person's own nearest earlier one that has all its joints; without one it starts cold."""
    own = [known.rhythm for kind in OWN_KINDS for known in known_rhythms if known.kind == kind]
    for learned in own:
        joints = {joint.degree_of_freedom: joint for joint in learned.joints}
        if joints.keys() >= set(RHYTHM_CHANNELS):
            cosine = np.array([joints[name].cosine for name in RHYTHM_CHANNELS])
            sine = np.array([joints[name].sine for name in RHYTHM_CHANNELS])
            rhythm.start_from(velocity_waveform(cosine, sine, learned.frequency), learned.frequency)
            return
