"""Depth and lean against the body's own geometry, rates and deviations against finite differences and samples."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.vocabulary import MOVEMENTS, Side, Task
from services.biomech.whole_body.directions import TRUNK_JOINT
from services.biomech.whole_body.model import DOF, WholeBodyModel
from services.biomech.whole_body.observability import trunk_lean as lean_of_centres
from services.biomech.whole_body.parameters import lengths_of
from services.segmentation.batch import COLUMNS, INDEX, Batch
from services.segmentation.exercises import movements
from services.segmentation.exercises.movements import FOLLOWED, LEAN_FORWARD, LEAN_RIGHT, SQUAT_DEPTH, trunk_lean

angle = st.floats(-1.0, 1.0)


def batch_of(valid=True, std=0.0, velocity=None, **angles):
    n = len(next(iter(angles.values())))
    position = np.zeros((n, len(COLUMNS)))
    for name, values in angles.items():
        position[:, INDEX[name]] = values
    speed = np.zeros_like(position) if velocity is None else velocity
    flags = np.full(len(COLUMNS), valid)
    return Batch(np.arange(n), position, speed, np.full(n, np.nan), np.full_like(position, std), flags, frozenset())


def test_every_task_follows_movements_of_the_vocabulary():
    assert set(FOLLOWED) == {Task.SQUAT, Task.STEPPING, Task.TRUNK_TILT_SAGITTAL, Task.TRUNK_TILT_FRONTAL}
    assert {movement.name for rows in FOLLOWED.values() for movement, _ in rows} == set(MOVEMENTS)


def test_the_trunk_bends_where_the_body_model_does():
    assert movements.TRUNK_JOINT == TRUNK_JOINT


@settings(deadline=None)
@given(angle, angle, angle)
def test_the_lean_is_that_of_the_centres(tilt, obliquity, flexion):
    model = WholeBodyModel()
    q = np.zeros(3 + len(DOF))
    for name, value in (("pelvis_tilt", tilt), ("pelvis_obliquity", obliquity), ("trunk_flexion", flexion)):
        q[3 + DOF[name]] = value
    centres = model.pose(q, lengths_of(1.7)).centre
    np.testing.assert_allclose(trunk_lean(tilt, obliquity, flexion), lean_of_centres(centres), atol=1e-9)


def test_signs_are_those_of_the_vocabulary():
    forward, right = trunk_lean(0.3, 0.0, 0.1)
    assert 0.3 < forward < 0.4
    assert right == 0.0
    _, right = trunk_lean(0.0, 0.2, 0.0)
    assert right == pytest.approx(-0.2), "the right side up is a lean to the left"


def test_depth_is_the_mean_of_both_knees_and_needs_both():
    batch = batch_of(knee_flexion_right=np.array([1.0, 0.4]), knee_flexion_left=np.array([0.5, 0.2]))
    np.testing.assert_allclose(SQUAT_DEPTH.course(batch).angle, [0.75, 0.3])
    assert SQUAT_DEPTH.course(batch).is_valid
    batch.valid[INDEX["knee_flexion_left"]] = False
    assert not SQUAT_DEPTH.course(batch).is_valid


def test_a_lower_body_has_no_trunk():
    batch = batch_of(pelvis_tilt=np.zeros(1))
    lower = Batch(*(getattr(batch, name) for name in ("captured_ns",)), *[np.zeros((1, 15))] * 2, np.zeros(1),
                  np.zeros((1, 15)), np.ones(15, dtype=bool), frozenset())  # fmt: skip
    assert LEAN_FORWARD.course(lower) is None
    assert SQUAT_DEPTH.course(lower).is_valid


@pytest.mark.parametrize("movement", [SQUAT_DEPTH, LEAN_FORWARD, LEAN_RIGHT, movements.HIP_FLEXION[Side.LEFT]])
def test_rate_and_deviation_follow_from_those_of_the_angles(movement):
    rng = np.random.default_rng(1)
    rates = rng.normal(0.0, 1.0, len(COLUMNS))
    start = rng.uniform(-0.5, 0.5, len(COLUMNS))

    def at(time_s, std=0.0):
        values = start + rates * time_s
        return batch_of(std=std, velocity=rates[None, :], **{n: values[[i]] for n, i in INDEX.items()})

    slope = (movement.course(at(1e-5)).angle - movement.course(at(-1e-5)).angle) / 2e-5
    assert movement.course(at(0.0)).rate == pytest.approx(slope, rel=1e-5)
    tried = np.array([
        movement.course(batch_of(**{n: start[[i]] + 0.01 * rng.normal(size=1) for n, i in INDEX.items()})).angle[0]
        for _ in range(1500)
    ])  # fmt: skip
    assert movement.course(at(0.0, std=0.01)).std[0] == pytest.approx(tried.std(), rel=0.1)
