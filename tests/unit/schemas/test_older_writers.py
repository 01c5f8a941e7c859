"""Archives keep what older writers said; readers fill in what was not said then."""

from schemas.imu import ImuBatch
from schemas.kinematics import Calibration


def test_samples_from_before_marks_existed_carry_none():
    text = '{"sensors": [{"captured_ns": [1], "angular_velocity": [[0, 0, 0]], "specific_force": [[0, 9.81, 0]]}]}'
    assert ImuBatch.model_validate_json(text).marks == []


def test_a_calibration_that_does_not_name_its_event_sources_is_read():
    text = (
        '{"model": "lower_body", "estimator": "ekf", "method": "standing+walking", "datum": "standing",'
        ' "quality": 0.8, "sensors": []}'
    )
    calibration = Calibration.model_validate_json(text)
    assert (calibration.events_from, calibration.unused) == ({}, {})


def test_what_a_writer_does_say_is_kept():
    mark = {"from_ns": 1, "to_ns": 2, "given_ns": 3}
    assert ImuBatch.model_validate({"sensors": [], "marks": [mark]}).marks[0].given_ns == 3
