import pytest

from services.progress.baseline import freeze
from services.progress.progress import progress
from services.progress.rules import JointWord, RuleCode
from services.progress.visits import in_visits


def visit(make, session, day, speed, distance, swing, std=0.005):
    out = make.metric(swing, 0.003, name="circumduction", side="left", unit="m")
    sound = make.metric(0.02 + day / 1000, 0.003, name="circumduction", side="right", unit="m")
    return make.trial(
        session, day, metrics=make.results(make.metric(speed), out, sound, sides=[make.comparison(distance, std=std)])
    )


@pytest.mark.parametrize(
    ("speed", "distance", "swing", "word", "code"),
    [
        (0.7, 0.15, 0.030, JointWord.RECOVERY, RuleCode.SPEED_UP_SIDES_CLOSER),
        (0.7, 0.25, 0.045, JointWord.COMPENSATION_POSSIBLE, RuleCode.SPEED_UP_OTHER_MOTION_GREW),
        (0.7, 0.15, 0.045, JointWord.CANNOT_TELL, RuleCode.SIDES_CLOSER_AND_OTHER_MOTION_GREW),
        (0.7, 0.25, 0.030, JointWord.CANNOT_TELL, RuleCode.SIDES_NOT_CLOSER),
        (0.51, 0.15, 0.030, JointWord.CANNOT_TELL, RuleCode.SPEED_NOT_UP),
    ],
)
def test_a_joint_is_seen_beside_speed_and_what_stands_in_for_it(make, speed, distance, swing, word, code):
    visits = in_visits([visit(make, "a", 0, 0.5, 0.25, 0.03), visit(make, "b", 14, speed, distance, swing)])
    found = progress(visits, freeze(visits, None, make.person.population, {}), make.person)
    (joint,) = found.joints
    assert (joint.joint, joint.word) == ("knee_flexion", word)
    assert [rule.code for rule in joint.rules] == [code]
    assert all(value is not None for rule in joint.rules for value in rule.parameters.values())
    assert [each.speed for each in joint.visits] == [0.5, speed]


def test_scatter_of_the_strides_alone_is_no_recovery(make):
    visits = in_visits([visit(make, "a", 0, 0.5, 0.25, 0.03, std=0.05), visit(make, "b", 14, 0.7, 0.2, 0.03, std=0.05)])
    (joint,) = progress(visits, freeze(visits, None, make.person.population, {}), make.person).joints
    assert joint.word is JointWord.CANNOT_TELL


def test_one_visit_or_one_leg_says_nothing(make):
    visits = in_visits([visit(make, "a", 0, 0.5, 0.25, 0.03)])
    (joint,) = progress(visits, freeze(visits, None, make.person.population, {}), make.person).joints
    assert (joint.word, joint.change) == (JointWord.CANNOT_TELL, None)
    alone = make.speeds(0.5, 0.7)
    assert progress(alone, freeze(alone, None, make.person.population, {}), make.person).joints == []
