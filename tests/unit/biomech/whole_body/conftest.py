"""A person in front of a camera."""

import numpy as np
import pytest

from services.biomech.whole_body.model import DOF, WholeBodyModel
from services.biomech.whole_body.parameters import REST_DEG, lengths_of, per_angle
from services.biomech.whole_body.start import Start, standing_start


class Person:
    """Of mean proportions, standing as people do on average."""

    stature = 1.7
    body = WholeBodyModel()
    lengths = lengths_of(1.7)
    tracked = np.full(15, 2)
    dt = 1.0 / 30.0

    def standing(self) -> np.ndarray:
        q = np.zeros(25)
        q[3:] = per_angle(REST_DEG)[:, 0]
        return q

    def centres(self, q: np.ndarray) -> np.ndarray:
        return self.body.centres(q, self.lengths)

    def start(self, *, biased: bool = True) -> Start:
        still = np.repeat(self.centres(self.standing())[None], 30, axis=0)
        found = standing_start(still, np.full((30, 15), 2), self.stature)
        return found if biased else found._replace(bias_std=None)

    def squats(self, frames: int, depth_deg: float = 70.0) -> np.ndarray:
        """(frames, 25): down and up in 3 s."""
        down = (1.0 - np.cos(2.0 * np.pi * np.arange(frames) * self.dt / 3.0)) / 2.0
        q = np.repeat(self.standing()[None], frames, axis=0)
        for side in ("right", "left"):
            q[:, 3 + DOF[f"knee_flexion_{side}"]] += np.radians(depth_deg) * down
            q[:, 3 + DOF[f"hip_flexion_{side}"]] += np.radians(0.9 * depth_deg) * down
            q[:, 3 + DOF[f"shoulder_adduction_{side}"]] -= np.radians(0.8 * depth_deg) * down
        q[:, 3 + DOF["pelvis_tilt"]] += np.radians(0.3 * depth_deg) * down
        return q

    def seen(self, q: np.ndarray, std: float, seed: int = 0) -> np.ndarray:
        """(frames, 15, 3) with white noise."""
        generator = np.random.default_rng(seed)
        return np.array([self.centres(row) for row in q]) + generator.normal(0.0, std, (len(q), 15, 3))


@pytest.fixture
def person() -> Person:
    return Person()
