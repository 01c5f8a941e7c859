import io

import pytest

from services.exports.errors import ExportError
from services.exports.formats import FORMATS, Options, file_name, why_not, write
from services.exports.opensim.models import GAIT_10DOF, known_model
from services.exports.session import HeldSession


def text_of(name, session, options=None):
    file = io.BytesIO()
    size = write(name, session, file, options)
    assert size == len(file.getvalue())
    return file.getvalue()


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_can_be_written_of_a_whole_session(walk, name):
    assert why_not(name, walk.signals, walk.description.estimator) is None
    assert len(text_of(name, walk)) > 500


@pytest.mark.parametrize("name", FORMATS)
def test_the_same_session_gives_the_same_bytes(walk, name):
    assert text_of(name, walk) == text_of(name, walk)


@pytest.mark.parametrize("name", FORMATS)
def test_a_session_without_messages_says_what_it_lacks(about, name):
    with pytest.raises(ExportError, match="the session holds no") as caught:
        text_of(name, HeldSession(about, []))
    assert caught.value.field == "session"


def test_a_single_knee_has_no_joint_centres(walk):
    assert "single knees" in why_not("trc", walk.signals, "knee_axis")
    assert why_not("mot", walk.signals, "knee_axis") is None


def test_the_model_of_opensim_may_be_chosen(walk):
    planar = text_of("mot", walk, Options(known_model(GAIT_10DOF))).decode()
    assert "hip_adduction_r" not in planar.partition("endheader")[2]
    assert "hip_adduction_r" in text_of("mot", walk).decode().partition("endheader")[2]


def test_files_are_named_by_the_session_alone():
    names = {file_name("8d0c", name) for name in FORMATS}
    assert len(names) == len(FORMATS)
    assert {"ambula-8d0c.c3d", "ambula-8d0c-strides.csv", "ambula-8d0c-foxglove.mcap"} <= names


def test_an_unknown_format_names_the_known_ones(walk):
    with pytest.raises(ExportError, match=r"format: 'xls' is none of metrics.csv, curves.csv"):
        text_of("xls", walk)
