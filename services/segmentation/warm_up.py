"""Compile what runs per batch before the first one comes: it takes seconds, and phases shown live would lag by them."""

import numpy as np

from schemas.session import Anthropometry
from services.segmentation.batch import DOFS
from services.segmentation.gait.leg_kinematics import leg_motion


def warm_up() -> None:
    """Place the legs of a body that stands upright."""
    body = Anthropometry(
        height_m=None, mass_kg=None, thigh_length_m=0.42, shank_length_m=0.42, hip_width_m=0.18, source="default"
    )
    leg_motion(np.zeros((1, DOFS)), np.zeros((1, DOFS)), body)
