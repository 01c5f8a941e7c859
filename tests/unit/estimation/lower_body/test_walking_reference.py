import json
import math
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from schemas.vocabulary import Segment
from services.biomech.rotations import angle_between
from services.estimation.lower_body.node import LowerBodyNode
from services.estimation.lower_body.walking_reference import refer_to_walking
from services.estimation.parameters import StandingParameters, WalkingParameters
from services.estimation.samples import Tick

sys.path.insert(0, str(Path(__file__).parent))
from tests.unit.estimation import estimation_walks as walks

SENSORS = walks.describe().hubs[0].sensors
BEGIN = 320
"""First sample of steady walking."""


@cache
def walking():
    truth, samples = walks.walk(18.0)
    return truth[BEGIN:], samples[BEGIN:]


def refer(samples):
    ticks = [Tick(k * 10_000_000, row, np.ones(5, dtype=np.bool_)) for k, row in enumerate(samples)]
    return refer_to_walking(SENSORS, ticks, WalkingParameters(), StandingParameters())


@cache
def outputs():
    return tuple(walks.run(LowerBodyNode(walks.describe()), walks.messages(walks.describe(), walking()[1])))


def test_walking_tells_the_verticals_of_its_mean_posture() -> None:
    samples = walking()[1]
    walked = refer(samples)
    assert walked is not None
    assert walked.reference.usable.all()
    assert walked.reference.duration_s > 8.0
    pelvis = walks.mounting()[Segment.PELVIS].T @ [0.0, 1.0, 0.0]
    assert angle_between(walked.reference.mean_force[0], pelvis) < math.radians(5)


def test_a_standing_person_and_a_hand_are_no_walk() -> None:
    assert refer(walks.walk()[1][:250]) is None
    random = np.random.default_rng(1)
    handled = np.cumsum(random.normal(size=(1200, 5, 6)), axis=0) * 0.2
    assert refer(handled) is None
    assert refer([]) is None


def test_a_sensor_in_other_units_is_not_used() -> None:
    samples = walking()[1].copy()
    samples[:, 2, 3:] /= 9.81
    walked = refer(samples)
    assert walked is not None
    assert walked.reference.wrong_units.tolist() == [False, False, True, False, False]


def test_estimates_start_without_standing_and_say_what_zero_is() -> None:
    (calibration,) = walks.calibrations(outputs())
    assert calibration.method == "walking alone"
    assert calibration.datum.startswith("population")
    assert calibration.quality <= WalkingParameters().best_quality
    first = walks.joint_states(outputs())[0]
    assert not any(first.valid), "the filter starts in motion"
    assert all(walks.joint_states(outputs())[-1].valid)


@pytest.mark.parametrize("name", ["knee_flexion_left", "knee_flexion_right"])
def test_the_shape_is_right(name: str) -> None:
    truth = walking()[0][:, walks.NAMES.index(name)]
    estimate = walks.angles(outputs(), name)
    rows = range(min(estimate) // 10_000_000 + 200, len(truth))
    estimated, true = np.array([estimate[k * 10_000_000] for k in rows]), truth[rows.start :]
    assert np.degrees(np.std(estimated - true)) < 5.0
    assert np.corrcoef(estimated, true)[0, 1] > 0.97


def test_standing_is_waited_for() -> None:
    """Before the wait is over nothing is estimated; with standing in time, standing counts."""
    description = walks.describe()
    samples = walking()[1]
    node = LowerBodyNode(description)
    early = [o for m in walks.messages(description, samples[:950]) for o in node.step(m)]
    assert not walks.joint_states(early)
    stream = np.concatenate([samples[:600], walks.walk()[1]])
    (calibration,) = walks.calibrations(walks.run(LowerBodyNode(description), walks.messages(description, stream)))
    assert calibration.method == "standing+walking"


@pytest.mark.parametrize("split", [500, 1100])
def test_split_and_resume_is_identical(split: int) -> None:
    description = walks.describe()
    stream = walks.messages(description, walking()[1])
    first, second = LowerBodyNode(description), LowerBodyNode(description)
    begun = [output for message in stream[:split] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot())))
    assert walks.text(begun + walks.run(second, stream[split:])) == walks.text(outputs())
