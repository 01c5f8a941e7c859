"""Compile what runs per sample before the first sample comes."""

import numpy as np

from schemas.session import Anthropometry
from services.biomech.forward_kinematics import segment_poses
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.two_sensor_knee.flexion import angle_of_verticals
from services.biomech.two_sensor_knee.knee_axis import KneeAxis
from services.estimation.parameters import EstimationParameters
from services.estimation.rows import RHYTHM_CHANNELS


def warm_up() -> None:
    """Take a sample of an imagined knee, declare its zero, and draw it."""
    axis = KneeAxis()
    rest = np.tile([0.0, 9.81, 0.0], (2, 1))
    for _ in range(2):
        axis.step(np.full((2, 3), 1e-3), rest, 0.01)
    frame = np.eye(3)
    angle_of_verticals(rest, np.array(frame[:2]), np.array(frame[1:]))
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
    )
    segment_poses(LowerBodyModel(body), np.zeros(15))
    rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), EstimationParameters().filter.rhythm)
    rhythm.step(np.zeros(len(RHYTHM_CHANNELS)), 0.01)
