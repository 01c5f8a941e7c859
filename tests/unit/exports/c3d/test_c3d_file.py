"""Files are read back with ezc3d, which knows nothing of us."""

import math

import numpy as np
import pytest

from schemas.vocabulary import BODY_MODELS
from services.exports.c3d.c3d_file import c3d_file
from services.exports.facts import Facts
from services.exports.motion import Motion, Track, gather_motion
from services.exports.session import facts_of

ezc3d = pytest.importorskip("ezc3d")


@pytest.fixture
def read(tmp_path, about, made):
    """Write and read back."""

    def run(states, events=(), metrics=None, facts=None):
        path = tmp_path / "session.c3d"
        path.write_bytes(b"".join(c3d_file(facts or Facts(about), gather_motion(states), events, metrics)))
        return ezc3d.c3d(str(path))

    return run


def values(found, group):
    return {name: parameter["value"] for name, parameter in found["parameters"][group].items() if name[0] != "_"}


def component(found, label, axis):
    return found["data"]["points"][axis, values(found, "POINT")["LABELS"].index(label)]


def test_angles_come_back_within_a_ten_thousandth_of_a_radian(read, made):
    found = read(made.joint_states())
    names = [freedom.name for freedom in BODY_MODELS["lower_body"]]
    truth = made.angles_at("lower_body", made.start_ns * 1e-9 + np.arange(1000) / 100)
    for label, axis, name in [
        ("LKneeAngles", 0, "knee_flexion_left"), ("RHipAngles", 0, "hip_flexion_right"),
        ("RHipAngles", 1, "hip_adduction_right"), ("LHipAngles", 2, "hip_internal_rotation_left"),
        ("PelvisAngles", 0, "pelvis_tilt"), ("PelvisAngles", 1, "pelvis_obliquity"),
        ("PelvisAngles", 2, "pelvis_rotation"),
    ]:  # fmt: skip
        error = np.radians(component(found, label, axis)) - truth[:, names.index(name)]
        assert np.abs(error).max() < 1e-4, label


def test_angles_are_a_group_of_their_own_with_unit_and_direction(read, made):
    point = values(read(made.joint_states(count=20)), "POINT")
    assert point["TYPE_GROUPS"] == ["ANGLES", "ANGLE"]
    assert point["ANGLE_UNITS"] == ["deg"]
    assert point["UNITS"] == ["mm"]
    assert set(point["ANGLES"]) <= set(point["LABELS"])
    said = dict(zip(point["LABELS"], point["DESCRIPTIONS"], strict=True))
    assert said["LKneeAngles"].startswith("X knee_flexion_left deg, + shank backward; Y knee_adduction_left")
    assert "midpoint of the hip centres at the origin" in said["RKJC"]


def test_joint_centres_are_millimetres(read, made, about):
    found = read(made.joint_states(count=20))
    hips = component(found, "RHJC", slice(0, 3)) - component(found, "LHJC", slice(0, 3))
    assert np.linalg.norm(hips, axis=0) == pytest.approx(np.full(20, about.anthropometry.hip_width_m * 1000), rel=1e-5)


def test_what_is_not_valid_has_no_point(read, made):
    lost = made.joint_states(count=50, valid=[f not in (6, 7, 8) for f in range(15)], start_ns=made.start_ns + 10**10)
    found = read([*made.joint_states(), *lost])
    assert np.isnan(component(found, "RKneeAngles", 0)[1000:]).all()
    assert not np.isnan(component(found, "LKneeAngles", 0)).any()
    assert not np.isnan(component(found, "RKneeAngles", 0)[:1000]).any()


def test_a_gap_is_empty_and_what_follows_stands_at_its_time(read, made):
    found = read([*made.joint_states(count=100), *made.joint_states(count=100, start_ns=made.start_ns + 3 * 10**9)])
    knee = component(found, "RKneeAngles", 0)
    assert np.isnan(knee).tolist() == [100 <= frame < 300 for frame in range(400)]
    later = made.angles_at("lower_body", np.array([made.start_ns * 1e-9 + 3.0]))[0, 6]
    assert math.radians(knee[300]) == pytest.approx(later, abs=1e-4)


@pytest.mark.parametrize("count", [0, 20, 600])
def test_events_keep_side_kind_and_time(read, made, count):
    events = made.contacts(count)
    event = values(read(made.joint_states(), events), "EVENT")
    assert event["USED"][0] == count
    endings = [ending for ending in ("", "2", "3") if f"TIMES{ending}" in event]
    assert len(endings) == math.ceil(count / 255)
    times = np.concatenate([60 * event[f"TIMES{end}"][0] + event[f"TIMES{end}"][1] for end in endings] or [np.empty(0)])
    assert times == pytest.approx([(each.captured_ns - made.start_ns) * 1e-9 for each in events], abs=1e-5)
    labels = [label for ending in endings for label in event[f"LABELS{ending}"]]
    contexts = [context for ending in endings for context in event[f"CONTEXTS{ending}"]]
    kinds = {"initial_contact": "Foot Strike", "toe_off": "Foot Off"}
    assert labels == [kinds[each.kind] for each in events]
    assert contexts == [each.side.capitalize() for each in events]


def test_figures_have_the_names_and_units_that_readers_know(read, made):
    analysis = values(read(made.joint_states(count=20), (), made.some_metrics()), "ANALYSIS")
    rows = zip(analysis["NAMES"], analysis["CONTEXTS"], analysis["UNITS"], analysis["VALUES"], strict=True)
    assert {name: (context, unit, round(float(value), 3)) for name, context, unit, value in rows} == {
        "Cadence": ("General", "steps/min", 108.0),
        "Foot Off": ("Left", "%", 61.0),
        "knee_flexion_range": ("Right", "deg", 57.296),
    }


def test_the_file_says_what_its_angles_mean(read, walk, made):
    ambula = values(read(made.joint_states(count=20), facts=facts_of(walk)), "AMBULA")
    assert ambula["DATUM"] == ["quiet standing"]
    assert ambula["CONDITIONS"] == ["aid cane, footwear shoes"]
    assert ambula["COMPUTED_BY"] == ["ambula 0.0.1+abc"]
    assert ambula["START_TIME"][0] == pytest.approx(2.24)


def test_more_frames_than_a_word_holds_are_all_there(tmp_path, about):
    """An hour at 100 Hz has 360 000; the format's words end at 65 535."""
    times = np.arange(66_000) * 10_000_000
    value, valid = np.zeros((66_000, 15, 1)), np.zeros((66_000, 15), dtype=bool)
    value[:, 6, 0], valid[:, 6] = np.sin(times * 1e-9), True
    path = tmp_path / "long.c3d"
    motion = Motion("lower_body", Track(times, value, valid), None)
    path.write_bytes(b"".join(c3d_file(Facts(about), motion, (), None)))
    knee = component(ezc3d.c3d(str(path)), "RKneeAngles", 0)
    assert np.abs(np.radians(knee) - value[:, 6, 0]).max() < 1e-4
