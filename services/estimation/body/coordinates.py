"""Postures as rows of the body model `whole_body`, with the rhythm of hips and knees."""

import numpy as np

from schemas.vocabulary import ANKLES
from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.whole_body.foot_on_floor import Dorsiflexion, FlatFeet
from services.estimation.body.tracker import Posture
from services.estimation.rows import RHYTHM_CHANNELS, Row, places
from services.flow.node import State

MODEL = "whole_body"
CHANNELS = places(MODEL, RHYTHM_CHANNELS)


class Coordinates:
    """Of one session. `floor_m`: height of the floor where the camera knows it."""

    def __init__(self, rhythm: TrustedRhythm, floor_m: float | None, unknown_std: float) -> None:
        self._rhythm, self._unknown_std = rhythm, unknown_std
        self._feet = FlatFeet(floor_m)
        self._start = 0
        self._ankles = [0.0] * len(ANKLES)
        self._were_flat = [False] * len(ANKLES)
        self._last_ns: int | None = None

    def row(self, posture: Posture) -> tuple[Row, list[bool]]:
        """The row of a posture, and which of its coordinates may be shown."""
        dt_s = 0.0 if self._last_ns is None else (posture.captured_ns - self._last_ns) / 1e9
        self._last_ns = posture.captured_ns
        ankles, ankle_rates = self._dorsiflexion(posture, dt_s)
        told, nothing = posture.told, [0.0] * len(ANKLES)
        # Joints that are not seen are at rest, for the rhythm: what the filter predicts is no stride.
        velocity = np.array([told.rates[i] if posture.valid[i] else 0.0 for i in CHANNELS])
        reading = self._rhythm.step(velocity, dt_s)
        unknown = [self._unknown_std] * len(ANKLES)
        ankle_std = [s if v else self._unknown_std for s, v in zip(ankles.std.tolist(), ankles.valid, strict=True)]
        row = Row(
            posture.captured_ns, told.q[3:].tolist() + ankles.angle.tolist(), told.rates.tolist() + ankle_rates,
            told.accelerations.tolist() + nothing, told.deviations[0].tolist() + ankle_std,
            told.deviations[1].tolist() + unknown, reading,
        )  # fmt: skip
        return row, posture.valid + ankles.valid.tolist()

    def _dorsiflexion(self, posture: Posture, dt_s: float) -> tuple[Dorsiflexion, list[float]]:
        """Of both ankles, with their rates; at rest and not shown where the foot is not flat."""
        if posture.start != self._start:
            self._start, self._ankles, self._were_flat = posture.start, [0.0] * len(ANKLES), [False] * len(ANKLES)
            self._feet.begin(standing=posture.absolute)
            dt_s = 0.0
        found = self._feet.step(dt_s, posture.centres, posture.rotations, np.array(posture.seen))
        angles = np.where(found.valid, found.angle, self._ankles)
        moved = np.where(found.valid & self._were_flat, angles - self._ankles, 0.0)
        rates = moved / dt_s if dt_s > 0.0 else moved
        self._ankles, self._were_flat = angles.tolist(), found.valid.tolist()
        return found._replace(angle=angles), rates.tolist()

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "rhythm": self._rhythm.snapshot(),
            "feet": self._feet.snapshot(),
            "start": self._start,
            "ankles": list(self._ankles),
            "were_flat": list(self._were_flat),
            "last_ns": self._last_ns,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._rhythm.restore(state["rhythm"])
        self._feet.restore(state["feet"])
        self._start, self._last_ns = state["start"], state["last_ns"]
        self._ankles, self._were_flat = list(state["ankles"]), list(state["were_flat"])
