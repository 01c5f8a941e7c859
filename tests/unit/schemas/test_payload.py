import pytest
from pydantic import ValidationError

from schemas.imu import ImuBatch, SensorSamples
from schemas.vocabulary import LOWER_BODY


def sample(value: float) -> dict:
    return {"captured_ns": [0], "angular_velocity": [[value, 0, 0]], "specific_force": [[0, 9.8, 0]]}


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_a_number_that_is_not_finite_cannot_enter(value):
    with pytest.raises(ValidationError):
        SensorSamples(**sample(value))


def test_nan_text_cannot_enter():
    with pytest.raises(ValidationError):
        ImuBatch.model_validate_json(
            b'{"sensors":[{"captured_ns":[0],"angular_velocity":[[NaN,0,0]],"specific_force":[[0,9,0]]}]}'
        )


def test_columns_must_have_one_length():
    with pytest.raises(ValidationError, match="differ in length"):
        SensorSamples(captured_ns=[0, 1], angular_velocity=[[0, 0, 0]], specific_force=[[0, 9.8, 0]])


def test_fields_of_a_newer_writer_are_ignored():
    assert SensorSamples.model_validate(sample(1.0) | {"temperature": [20.0]}).angular_velocity == [[1.0, 0, 0]]


def test_lower_body_has_left_and_right_of_every_joint():
    names = {dof.name for dof in LOWER_BODY}
    assert len(names) == len(LOWER_BODY) == 15
    assert {name.replace("_left", "_right") for name in names if name.endswith("_left")} <= names
