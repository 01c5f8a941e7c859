"""Whole-body kinematics against hand-posed bodies, Pinocchio and finite differences."""

from math import radians

import numpy as np
import pytest

from schemas.vocabulary import ANKLES, BODY_MODELS, LOWER_BODY, WHOLE_BODY, JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES, DOF, LENGTH_NAMES, WholeBodyModel
from services.biomech.whole_body.pinocchio_whole_body import PinocchioWholeBody

BODY = WholeBodyModel()
LENGTHS = np.array([0.08, 0.42, 0.42, 0.42, 0.42, 0.5, 0.17, 0.17, 0.29, 0.29, 0.25, 0.25])


def random_state(seed: int) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    return generator.normal(size=25) * 0.6, generator.uniform(0.1, 0.6, 12)


def posed(**angles_deg: float) -> dict[JointCentre, np.ndarray]:
    q = np.zeros(25)
    for name, value in angles_deg.items():
        q[3 + DOF[name]] = radians(value)
    return dict(zip(CENTRE_NAMES, BODY.centres(q, LENGTHS), strict=True))


def test_22_angles_12_lengths_15_centres() -> None:
    assert len(WHOLE_BODY) == 22
    assert len(LENGTH_NAMES) == 12
    assert len(CENTRE_NAMES) == 15
    assert BODY_MODELS["whole_body"] == WHOLE_BODY + ANKLES


def test_shared_names_mean_the_same_in_both_models() -> None:
    lower = {dof.name: dof for dof in LOWER_BODY}
    for dof in WHOLE_BODY:
        assert lower.get(dof.name, dof) == dof


def test_standing_body_has_its_lengths() -> None:
    body = posed()
    assert body[JointCentre.HIP_RIGHT] == pytest.approx([0, 0, 0.08])
    assert body[JointCentre.ANKLE_LEFT] == pytest.approx([0, -0.84, -0.08])
    assert body[JointCentre.SPINE_MID] == pytest.approx([0, 0.275, 0])
    assert body[JointCentre.WRIST_RIGHT] == pytest.approx([0, 0.5 - 0.54, 0.17])


@pytest.mark.parametrize(
    ("angle", "centre", "axis", "sign"),
    [
        ("pelvis_rotation", "hip_right", 0, 1),  # turned to the left, the right hip goes forward
        ("pelvis_tilt", "spine_mid", 0, 1),
        ("pelvis_obliquity", "hip_right", 1, 1),
        ("hip_flexion_right", "knee_right", 0, 1),
        ("hip_flexion_left", "knee_left", 0, 1),
        ("hip_adduction_right", "knee_right", 2, -1),
        ("hip_adduction_left", "knee_left", 2, 1),
        ("knee_flexion_right", "ankle_right", 0, -1),
        ("knee_flexion_left", "ankle_left", 0, -1),
        ("trunk_flexion", "spine_shoulder", 0, 1),
        ("clavicle_elevation_right", "shoulder_right", 1, 1),
        ("clavicle_elevation_left", "shoulder_left", 1, 1),
        ("shoulder_flexion_right", "elbow_right", 0, 1),
        ("shoulder_adduction_right", "elbow_right", 2, -1),
        ("shoulder_adduction_left", "elbow_left", 2, 1),
        ("elbow_flexion_right", "wrist_right", 0, 1),
        ("elbow_flexion_left", "wrist_left", 0, 1),
    ],
)
def test_positive_angles_move_the_body_as_the_vocabulary_says(angle: str, centre: str, axis: int, sign: int) -> None:
    moved = posed(**{angle: 20.0})[JointCentre(centre)] - posed()[JointCentre(centre)]
    assert sign * moved[axis] > 0.02


@pytest.mark.parametrize("side", ["right", "left"])
def test_internal_rotation_brings_the_bent_limb_inwards(side: str) -> None:
    outwards = 1.0 if side == "right" else -1.0
    for joint, hinge, end, inwards in (("hip", "knee", "ankle", -1.0), ("shoulder", "elbow", "wrist", 1.0)):
        bent = {f"{hinge}_flexion_{side}": 90.0}
        moved = posed(**bent, **{f"{joint}_internal_rotation_{side}": 20.0})
        still = posed(**bent)
        step = moved[JointCentre(f"{end}_{side}")] - still[JointCentre(f"{end}_{side}")]
        # The shank of a bent knee points backward: toes inwards, it goes outwards. A forearm points forward.
        assert -inwards * outwards * step[2] > 0.05


@pytest.mark.parametrize("seed", range(4))
def test_centres_and_jacobian_equal_pinocchio(seed: int) -> None:
    q, lengths = random_state(seed)
    oracle = PinocchioWholeBody(BODY, lengths)
    assert BODY.centres(q, lengths) == pytest.approx(oracle.centres(q), abs=1e-12)
    H = BODY.jacobian(q, lengths)
    for m, centre in enumerate(CENTRE_NAMES):
        assert H[m, :, :25] == pytest.approx(oracle.jacobian(q, centre), abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_jacobian_equals_central_differences(seed: int) -> None:
    q, lengths = random_state(seed)
    both, H, step = np.concatenate([q, lengths]), BODY.jacobian(q, lengths), 1e-6
    for k in range(37):
        shift = step * np.eye(37)[k]
        up, down = both + shift, both - shift
        slope = (BODY.centres(up[:25], up[25:]) - BODY.centres(down[:25], down[25:])) / (2 * step)
        assert H[:, :, k] == pytest.approx(slope, abs=1e-8)


def test_columns_are_exactly_those_that_move_a_centre() -> None:
    table, count = BODY.body[0]["columns"], BODY.body[0]["moving"]
    q, lengths = random_state(9)
    H = BODY.jacobian(q, lengths)
    for m in range(15):
        others = np.setdiff1d(np.arange(37), table[m, : count[m]])
        assert np.abs(H[m][:, others]).max() < 1e-12
        assert np.abs(H[m][:, table[m, : count[m]]]).max(axis=0).min() > 0.0
