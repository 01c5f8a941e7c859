from schemas.signals import GAIT_EVENT, JOINT_STATE, METRICS
from services.exports.facts import UNKNOWN_DATUM
from services.exports.session import HeldSession, contents_of, facts_of


def test_one_reading_gives_angles_events_in_order_and_the_newest_metrics(about, made):
    events = made.contacts(6)
    early = made.some_metrics().model_copy(update={"final": False})
    messages = [(GAIT_EVENT, event) for event in reversed(events)] + [(METRICS, early), (METRICS, made.some_metrics())]
    session = HeldSession(about, [*messages, *((JOINT_STATE, state) for state in made.joint_states(count=20))])
    contents = contents_of(session)
    assert contents.events == events
    assert contents.metrics.final
    assert contents.motion.angles.times_ns.size == 20


def test_facts_name_who_computed_and_what_zero_means(walk, about):
    assert facts_of(walk).computed_by == "ambula 0.0.1+abc"
    assert facts_of(walk).datum == "quiet standing"
    assert facts_of(HeldSession(about, [])).datum == UNKNOWN_DATUM


def test_an_unknown_constant_is_said(walk, calibration):
    facts = facts_of(walk)._replace(calibration=calibration.model_copy(update={"absolute": False}))
    assert facts.datum == "quiet standing; each angle carries an unknown constant"
