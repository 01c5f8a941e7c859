"""Strides made by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from schemas.gait import Stride, StrideCurve
from schemas.vocabulary import LOWER_BODY, Side


def made(side: Side = Side.LEFT, index: int = 0, **changes) -> Stride:
    """A stride of one second with sine curves: knee 0.5 +- 0.4 rad, every other joint 0.1 +- 0.2 rad."""
    at = 2 * np.pi * np.arange(101) / 100
    knee, other = 0.5 + 0.4 * np.sin(at), 0.1 + 0.2 * np.sin(at)
    start = index * 1_000_000_000 + (500_000_000 if side is Side.RIGHT else 0)
    fields = {
        "side": side,
        "index": index,
        "start_ns": start,
        "toe_off_ns": start + 600_000_000,
        "opposite_contact_ns": start + 500_000_000,
        "end_ns": start + 1_000_000_000,
        "stride_time_s": 1.0,
        "stance_fraction": 0.6,
        "step_time_s": 0.5,
        "step_length_m": 0.6,
        "step_length_std_m": 0.02,
        "stride_length_m": 1.2,
        "walking_speed": 1.2,
        "phase_advance": None,
        "turning": False,
        "valid": True,
        "rejected_because": None,
        "curves": {
            dof.name: StrideCurve(position=(knee if "knee_flexion" in dof.name else other).tolist(), position_std=0.03)
            for dof in LOWER_BODY
        },
    }
    return Stride(**(fields | changes))


@pytest.fixture
def stride() -> Callable[..., Stride]:
    return made


@pytest.fixture
def description():
    from services.bench.gait.joint_walks import joint_walk

    return joint_walk("duration=20").description
