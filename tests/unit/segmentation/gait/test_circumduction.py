"""The outward swing of legs posed by hand, and of a synthetic walker whose ankles are known."""

import numpy as np
import pytest

from schemas.session import Anthropometry
from schemas.vocabulary import LOWER_BODY, Side
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.walk import SyntheticWalk
from services.segmentation.batch import DOFS, INDEX
from services.segmentation.gait.circumduction import circumduction
from services.segmentation.gait.history import Span

BODY = Anthropometry(
    height_m=None, mass_kg=None, thigh_length_m=0.41, shank_length_m=0.4, hip_width_m=0.18, source="measured"
)
LEG_M = 0.81
SAMPLES = 101
TIME = np.linspace(0.0, 1.0, SAMPLES)
BUMP = np.sin(np.pi * TIME) ** 2


def span(invalid: str | None = None, **angles) -> Span:
    position, valid = np.zeros((SAMPLES, DOFS)), np.ones(DOFS, dtype=bool)
    for name, course in angles.items():
        position[:, INDEX[name]] = course
    if invalid:
        valid[INDEX[invalid]] = False
    times = (TIME * 1e9).astype(np.int64)
    return Span(0, 10**9, times, position, np.full(SAMPLES, np.nan), np.zeros(DOFS), valid)


def swung(side: Side, outward: float, heading: float | np.ndarray = 0.0, invalid: str | None = None) -> float | None:
    """A stiff leg from behind to the front, abducted by up to `outward` rad when it passes the other one."""
    angles = {f"hip_flexion_{side}": 0.3 * -np.cos(np.pi * TIME), f"hip_adduction_{side}": -outward * BUMP}
    return circumduction(side, span(invalid, pelvis_rotation=heading, **angles), BODY)


@pytest.mark.parametrize("side", list(Side))
@pytest.mark.parametrize("heading", [0.0, 2.5])
def test_an_abducted_leg_swings_outward(side, heading):
    assert swung(side, 0.1, heading) == pytest.approx(LEG_M * np.sin(0.1), abs=1e-6)


@pytest.mark.parametrize("side", list(Side))
def test_a_straight_or_inward_swing_is_none(side):
    assert swung(side, 0.0) == pytest.approx(0.0, abs=1e-9)
    assert swung(side, -0.1) == pytest.approx(0.0, abs=1e-9)


def test_what_cannot_be_seen_is_null():
    assert swung(Side.LEFT, 0.1, invalid="hip_adduction_left") is None
    assert circumduction(Side.LEFT, span(), BODY) is None


@pytest.mark.parametrize("side", list(Side))
def test_a_walker_whose_ankles_are_known(side):
    """From true angles, against the largest outward distance of the true ankle in the room."""
    walk = SyntheticWalk(WalkParameters(speed=1.0, wander=0.0))
    time_s = np.arange(8.0, 12.0, 0.01)
    body, phase = walk.body(time_s), walk.strides(time_s).phase.value
    own = phase if side is Side.RIGHT else phase - walk.gait.opposite_contact
    first, last = (int(np.argmax(own > np.ceil(own[0]) + k)) for k in (0.0, 1.0))
    half = int(np.argmax(own > np.ceil(own[0]) + 0.5))
    angles = np.column_stack([body.angles[dof.name].value for dof in LOWER_BODY])[half : last + 1]
    times = np.round(time_s[half : last + 1] * 1e9).astype(np.int64)
    standing = Span(
        int(times[0]), int(times[-1]), times, angles, np.zeros(len(times)), np.zeros(DOFS), np.ones(DOFS, dtype=bool)
    )
    ankle = body.ankle(side).position[first : last + 1][:, [0, 2]]
    along = (ankle[-1] - ankle[0]) / np.linalg.norm(ankle[-1] - ankle[0])
    to_the_right = (ankle - ankle[0]) @ np.array([-along[1], along[0]])
    truth = (to_the_right if side is Side.RIGHT else -to_the_right).max()
    assert truth > 0.01
    assert circumduction(side, standing, BODY) == pytest.approx(truth, abs=0.004)
