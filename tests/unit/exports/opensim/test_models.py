import pytest

from services.exports.errors import ExportError
from services.exports.opensim.models import GAIT_10DOF, RAJAGOPAL, known_model, model_from_file, sign_in

OSIM = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000"><Model name="m"><JointSet><objects>
<CustomJoint name="knee_r"><coordinates>
<Coordinate name="knee_angle_r"><range>{low} {high}</range></Coordinate>
<Coordinate name="hip_flexion_r"><range>-0.52 2.09</range></Coordinate>
<Coordinate name="pelvis_tilt"><range>-1.57 1.57</range></Coordinate>
<Coordinate name="lumbar_extension"><range>-1.57 1.57</range></Coordinate>
</coordinates></CustomJoint></objects></JointSet></Model></OpenSimDocument>"""


def sign_of(model, coordinate):
    return next(each.sign for each in model.coordinates if each.name == coordinate)


def test_one_name_has_two_signs():
    """The trap: knee_angle is flexion in one published model and extension in the other."""
    assert sign_of(known_model(RAJAGOPAL), "knee_angle_r") == 1
    assert sign_of(known_model(GAIT_10DOF), "knee_angle_r") == -1
    for model in (RAJAGOPAL, GAIT_10DOF):
        assert sign_of(known_model(model), "hip_flexion_l") == 1
        assert sign_of(known_model(model), "ankle_angle_l") == 1


def test_each_side_has_its_own_degree_of_freedom():
    of = {each.name: each.freedom for each in known_model(RAJAGOPAL).coordinates}
    assert of["knee_angle_r"] == "knee_flexion_right"
    assert of["hip_rotation_l"] == "hip_internal_rotation_left"


@pytest.mark.parametrize(("limits", "sign"), [((0.0, 2.094), 1), ((-2.094, 0.175), -1), ((-0.2, 2.6), 1)])
def test_a_models_file_tells_the_sign_by_its_range(limits, sign):
    model = model_from_file("mine.osim", OSIM.format(low=limits[0], high=limits[1]))
    assert sign_of(model, "knee_angle_r") == sign
    assert model.pelvis == ("pelvis_tilt",)
    assert {each.name for each in model.coordinates} == {"knee_angle_r", "hip_flexion_r"}


def test_a_range_that_does_not_tell_is_refused():
    with pytest.raises(ExportError, match=r"model.knee_angle_r: its range -2 to 2 rad does not tell"):
        model_from_file("mine.osim", OSIM.format(low=-2, high=2))


def test_a_range_that_is_no_range_is_refused():
    with pytest.raises(ExportError, match=r"model.knee_angle_r: its range is 'wide 2'; give two numbers in rad"):
        model_from_file("mine.osim", OSIM.format(low="wide", high=2))


def test_a_knee_without_a_range_is_refused():
    text = OSIM.replace("<range>{low} {high}</range>", "")
    with pytest.raises(ExportError, match=r"does not tell which way is flexion"):
        model_from_file("mine.osim", text)


@pytest.mark.parametrize("limits", [(-1.0, 1.0), (-1.57, 1.57)])
def test_the_other_angles_have_one_sign_everywhere(limits):
    assert sign_in("hip_rotation_r", "hip_internal_rotation", limits) == 1


@pytest.mark.parametrize(
    ("text", "what"),
    [("not xml", "is not XML"), ("<Model/>", "has none of hip_flexion_r")],
)
def test_what_is_no_model_is_refused(text, what):
    with pytest.raises(ExportError, match=what) as caught:
        model_from_file("mine.osim", text)
    assert caught.value.field == "model"


def test_an_unknown_model_names_the_known_ones():
    with pytest.raises(ExportError, match="'gait2392' is none of rajagopal, gait10dof18musc"):
        known_model("gait2392")
