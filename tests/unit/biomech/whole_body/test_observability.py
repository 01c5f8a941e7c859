"""What is shown of a posture and what is not."""

import numpy as np
import pytest

from schemas.vocabulary import JointCentre
from services.biomech.whole_body.model import CENTRE_NAMES, DOF
from services.biomech.whole_body.observability import arm_elevations, observable, trunk_lean

ALL = np.ones(15, dtype=bool)
SURE = np.full(22, 0.05)


def shown(angles_deg: dict[str, float], followed: np.ndarray = ALL, deviations: np.ndarray = SURE) -> set[str]:
    angles = np.zeros(22)
    for name, value in angles_deg.items():
        angles[DOF[name]] = np.radians(value)
    flags = observable(angles, deviations, followed)
    return {name for name, i in DOF.items() if flags[i]}


def test_straight_limbs_hide_axial_rotation() -> None:
    names = shown({"knee_flexion_left": 40.0, "elbow_flexion_right": 60.0})
    assert "hip_internal_rotation_right" not in names
    assert "hip_internal_rotation_left" in names
    assert "shoulder_internal_rotation_right" in names
    assert "shoulder_internal_rotation_left" not in names


def test_clavicle_is_never_told_from_the_shoulder() -> None:
    assert not {name for name in shown({}) if name.startswith("clavicle")}


def test_an_abducted_arm_hides_flexion_and_rotation() -> None:
    names = shown({"shoulder_adduction_right": -85.0, "elbow_flexion_right": 60.0})
    assert "shoulder_flexion_right" not in names
    assert "shoulder_internal_rotation_right" not in names
    assert "shoulder_adduction_right" in names


def test_a_centre_out_of_view_hides_what_it_shows() -> None:
    followed = ALL.copy()
    followed[CENTRE_NAMES.index(JointCentre.ANKLE_RIGHT)] = False
    names = shown({}, followed)
    assert "knee_flexion_right" not in names
    assert "hip_flexion_right" in names
    assert "knee_flexion_left" in names


def test_an_uncertain_angle_is_not_shown() -> None:
    deviations = SURE.copy()
    deviations[DOF["trunk_flexion"]] = 0.5
    assert "trunk_flexion" not in shown({}, deviations=deviations)


def test_elevation_is_the_arm_against_the_trunk(person) -> None:
    q = np.zeros(25)
    q[3 + DOF["clavicle_elevation_right"]] = 0.2
    q[3 + DOF["shoulder_adduction_right"]] = -0.8
    q[3 + DOF["shoulder_flexion_left"]] = 0.7
    q[3 + DOF["trunk_flexion"]] = 0.5
    assert arm_elevations(person.body, q, person.lengths) == pytest.approx([1.0, 0.7], abs=1e-9)


def test_lean_is_forward_and_to_the_right(person) -> None:
    q = np.zeros(25)
    q[3 + DOF["pelvis_tilt"]] = 0.3
    assert trunk_lean(person.centres(q)) == pytest.approx([0.3, 0.0], abs=1e-9)
    q[3 + DOF["pelvis_tilt"]], q[3 + DOF["pelvis_obliquity"]] = 0.0, -0.2
    assert trunk_lean(person.centres(q)) == pytest.approx([0.0, 0.2], abs=1e-9)
