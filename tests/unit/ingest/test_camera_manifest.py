"""What a manifest says of a camera is refused with what to write; so is an estimator whose camera is not there."""

import pytest

from services.ingest.errors import InvalidManifest, InvalidOption, MissingColumn, MissingFile, UnknownUnit, WrongAxes
from services.ingest.source import open_source
from tests.unit.ingest.camera_scene import AZURE, HEAD_TOML, HUB, KINECT, Scene


@pytest.fixture
def scene(tmp_path):
    return Scene(tmp_path / "scene")


@pytest.mark.parametrize(
    ("old", "new", "error", "words"),
    [
        ("kinect_v2", "kinect_v3", InvalidManifest, "camera.0.kind"),
        ('"kinect.csv"', '"nothing.csv"', MissingFile, "nothing.csv"),
        ("{ each = 4, state = 4 }", "{ each = 3, state = 4 }", InvalidManifest, "count from 1 within one joint"),
        ("{ each = 4, state = 4 }", "{ each = 5, state = 4 }", MissingColumn, "no column '102'"),
        ("numbers = { each = 4, state = 4 }", "", InvalidManifest, "either numbers .* or columns"),
        ("header = false", "header = true", InvalidManifest, "format = { header = false, skip_lines = 1 }"),
        ("[[camera]]", "[imu]", InvalidManifest, "imu.name"),
        (
            'file = "kinect.csv"',
            'file = "kinect.csv"\nup = [0, -1, 0]',
            WrongAxes,
            "camera kinect: up .* check its sign",
        ),
        ('file = "kinect.csv"', 'file = "kinect.csv"\nunit = "ft"', UnknownUnit, "camera kinect: unit 'ft'"),
        ('file = "kinect.csv"', 'file = "kinect.csv"\nfloor_plane = [0, 0, 0, 0]', WrongAxes, "floor plane"),
        (
            'file = "kinect.csv"',
            'file = "kinect.csv"\nfloor_plane = [0, 1, 0, 1]\nup = [0, 1, 0]',
            InvalidManifest,
            "leave out up",
        ),
        (
            'file = "kinect.csv"',
            'file = "kinect.csv"\njoints = ["head", "head"]',
            InvalidManifest,
            "head appears twice",
        ),
        ('file = "kinect.csv"', 'file = "kinect.csv"\njoints = ["tail"]', InvalidManifest, "camera.0.joints.0"),
        ("kinect_v2", "other", WrongAxes, "give its joints in order, and its axes"),
        ('title = "a person"', 'title = "a person"\nestimator = "ekf"', InvalidManifest, "needs sensors on the body"),
        ('title = "a person"', 'title = "a person"\nestimator = "fusion"', InvalidManifest, "sensors and a camera"),
    ],
)
def test_a_manifest_that_cannot_be_read_says_why(scene, old, new, error, words):
    assert old in scene.toml
    scene.toml = scene.toml.replace(old, new, 1)
    with pytest.raises(error, match=words):
        scene.opened()


def test_names_of_hub_and_camera_differ(scene):
    scene.toml = HEAD_TOML + HUB + KINECT.replace('name = "kinect"', 'name = "hub"')
    with pytest.raises(InvalidManifest, match="hub or camera 'hub' appears twice"):
        scene.opened()


def test_nothing_recorded_is_no_recording(scene):
    scene.toml = HEAD_TOML
    with pytest.raises(InvalidManifest, match=r"add a \[\[hub\]\] with sensors or a \[\[camera\]\]"):
        scene.opened()


def test_sensors_need_the_lengths_of_the_leg(scene):
    scene.toml = HEAD_TOML + HUB[HUB.index("[[hub]]") :] + KINECT
    with pytest.raises(InvalidManifest, match="anthropometry: missing"):
        scene.opened()


def test_as_many_names_as_joints(scene):
    scene.toml = HEAD_TOML + AZURE.replace('"J0", ', "")
    with pytest.raises(InvalidManifest, match="31 names for 32 joints"):
        scene.opened()
    scene.toml = HEAD_TOML + AZURE.replace('"J7"', '"J99"')
    with pytest.raises(MissingColumn, match=r"azure\.csv: no column 'J99_X'"):
        scene.opened()


@pytest.mark.parametrize(
    ("estimator", "words"),
    [
        ("rhythmic_ekf", "needs sensors on the body and this session has a camera only; choose one of body_cekf"),
        ("knee_axis", "needs sensors on the body"),
        ("fusion", "needs sensors and a camera and this session has a camera only; choose one of body_cekf"),
    ],
)
def test_an_estimator_without_its_sensors_is_refused(scene, estimator, words):
    with pytest.raises(InvalidOption, match=words):
        scene.opened(estimator=estimator).describe()
    assert scene.opened(estimator="body_cekf_colombel").describe().estimator == "body_cekf_colombel"


@pytest.mark.parametrize(("estimator", "needed"), [("body_cekf", "a camera"), ("fusion", "sensors and a camera")])
def test_an_estimator_without_its_camera_is_refused(estimator, needed):
    with pytest.raises(InvalidOption, match=f"needs {needed} and this session has sensors only; choose one of ekf"):
        open_source("synthetic:walk?duration=5", estimator=estimator).describe()
