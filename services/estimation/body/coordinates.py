"""Postures as rows of the body model `whole_body`, with the rhythm of hips and knees."""

import numpy as np

from schemas.vocabulary import ANKLES
from services.biomech.rhythm.trusted import TrustedRhythm
from services.estimation.body.tracker import Posture
from services.estimation.rows import RHYTHM_CHANNELS, Row, places
from services.flow.node import State

MODEL = "whole_body"
CHANNELS = places(MODEL, RHYTHM_CHANNELS)


class Coordinates:
    """Of one session."""

    def __init__(self, rhythm: TrustedRhythm, unknown_std: float) -> None:
        self._rhythm, self._unknown_std = rhythm, unknown_std
        self._last_ns: int | None = None

    def row(self, posture: Posture) -> tuple[Row, list[bool]]:
        """The row of a posture, and which of its coordinates may be shown."""
        dt_s = 0.0 if self._last_ns is None else (posture.captured_ns - self._last_ns) / 1e9
        self._last_ns = posture.captured_ns
        told, unknown = posture.told, [self._unknown_std] * len(ANKLES)
        nothing = [0.0] * len(ANKLES)
        # Joints that are not seen are at rest, for the rhythm: what the filter predicts is no stride.
        velocity = np.array([told.rates[i] if posture.valid[i] else 0.0 for i in CHANNELS])
        reading = self._rhythm.step(velocity, dt_s)
        row = Row(
            posture.captured_ns, told.q[3:].tolist() + nothing, told.rates.tolist() + nothing,
            told.accelerations.tolist() + nothing, told.deviations[0].tolist() + unknown,
            told.deviations[1].tolist() + unknown, reading,
        )  # fmt: skip
        return row, posture.valid + [False] * len(ANKLES)

    def snapshot(self) -> State:
        """Everything that changes."""
        return {"rhythm": self._rhythm.snapshot(), "last_ns": self._last_ns}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._rhythm.restore(state["rhythm"])
        self._last_ns = state["last_ns"]
