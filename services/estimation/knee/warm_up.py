"""Compile what runs per sample before the first sample comes."""

import numpy as np

from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.two_sensor_knee.flexion import angle_of_verticals
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.estimation.parameters import EstimationParameters
from services.estimation.rows import RHYTHM_CHANNELS


def warm_up() -> None:
    """Take a sample of an imagined knee, and declare its zero."""
    axis = KneeAxis()
    rest = np.tile([0.0, 9.81, 0.0], (2, 1))
    for _ in range(2):
        axis.step(np.full((2, 3), 1e-3), rest, 0.01)
    frame = np.eye(3)
    angle_of_verticals(rest, np.array(frame[:2]), np.array(frame[1:]))
    rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), EstimationParameters().filter.rhythm)
    rhythm.step(np.zeros(len(RHYTHM_CHANNELS)), 0.01)
