import pytest

from schemas.metrics import Doubt, DoubtKind
from services.progress.rules import RULES, RuleCode, rule
from services.report.catalogue import catalogue
from services.report.content import Language
from services.report.phrases import doubt_text, joint_name, rule_sentence, subject_name
from services.report.units import Measured

ENGLISH = catalogue(Language.ENGLISH)
SPEED = Measured(ENGLISH, "m/s", "walking_speed")
ANGLE = Measured(ENGLISH, "rad", "side_distance")


def said(code, *parameters, measured=SPEED):
    return rule_sentence(ENGLISH, rule(code, *parameters), measured).replace("\u00a0", " ")


def test_a_rule_is_said_with_its_numbers_in_shown_units():
    sentence = said(RuleCode.CHANGE_BEYOND_MDC, 0.3, 0.21, 0.39, 0.15, 0.18)
    assert "(+0.21 m/s to +0.39 m/s) is larger than 0.18 m/s: the MDC of 0.15 m/s" in sentence


def test_speed_stays_speed_and_a_length_a_length_in_a_rule_of_joints():
    assert "+0.05 m/s; −0.01 m/s to +0.11 m/s" in said(RuleCode.SPEED_NOT_UP, 0.05, -0.01, 0.11, measured=ANGLE)
    assert "circumduction grew by +2.0 cm" in said(
        RuleCode.SPEED_UP_OTHER_MOTION_GREW, 0.2, "circumduction", 0.02, measured=ANGLE
    )
    assert "hip rotation grew by +5.7°" in said(
        RuleCode.SPEED_UP_OTHER_MOTION_GREW, 0.2, "hip_rotation_range", 0.1, measured=ANGLE
    )


def test_a_difference_is_said_in_words():
    assert said(RuleCode.DIFFERENCE, "aid", "cane", "rollator") == (
        "Not done alike: walking aid was rollator at the baseline and is cane now."
    )
    assert "is not said now" in said(RuleCode.DIFFERENCE, "aid", None, "cane")


@pytest.mark.parametrize("language", Language)
@pytest.mark.parametrize("code", RuleCode)
def test_every_rule_can_be_said_with_numbers_and_with_nothing(language, code):
    words = catalogue(language)
    for value in (0.1, None):
        parameters = [value] * len(RULES[code])
        assert rule_sentence(words, rule(code, *parameters), Measured(words, "m/s", "walking_speed"))


@pytest.mark.parametrize(
    ("kind", "value", "limit", "subject", "text"),
    [
        (DoubtKind.FEW_CYCLES, 4.0, 10.0, None, "4 cycles, 10 needed"),
        (DoubtKind.COVERAGE, 0.455, 0.8, None, "observed 45.5 % of the time, 80 % needed"),
        (DoubtKind.LOSS, None, None, None, "too many samples lost"),
        (DoubtKind.NOT_OBSERVED, None, None, "shank_left", "not observed: left shank"),
        (DoubtKind.NOT_OBSERVED, None, None, "knee_flexion_left", "not observed: knee flexion (left)"),
        (DoubtKind.WEAK_MEASURE, 1.0, 2.0, None, "a weak measure in itself"),
    ],
)
def test_a_doubt_says_what_was_found_and_what_was_needed(kind, value, limit, subject, text):
    doubt = Doubt(kind=kind, value=value, limit=limit, subject=subject)
    assert doubt_text(ENGLISH, doubt).replace("\u00a0", " ") == text


@pytest.mark.parametrize("language", Language)
@pytest.mark.parametrize("kind", DoubtKind)
def test_every_doubt_can_be_said_whatever_is_known_of_it(language, kind):
    words = catalogue(language)
    for value, limit, subject in ((None, None, None), (0.5, None, None), (0.5, 0.8, "pelvis"), (None, 0.8, "x")):
        assert doubt_text(words, Doubt(kind=kind, value=value, limit=limit, subject=subject))


def test_what_has_no_name_is_shown_as_it_is_called():
    assert subject_name(ENGLISH, "imu_7") == "imu 7"
    assert joint_name(ENGLISH, "elbow_flexion_left") == "elbow flexion (left)"
