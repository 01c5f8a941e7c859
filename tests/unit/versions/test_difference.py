import pytest

from schemas.gait import CURVE_POINTS
from schemas.metrics import MeanCurve, Metric, SessionMetrics
from services.versions.difference import MEANING, ChangeKind, difference

FIELDS = {"unit": "m/s", "side": None, "spread": None, "mean_std": None, "strides": 9, "withheld_because": None}


def metric(name="walking_speed", value=1.0, **changes):
    return Metric.model_validate({"name": name, "value": value} | FIELDS | changes)


def result(*metrics, software="ambula 0.1.0+11111111", **changes):
    fields = {"captured_ns": 9, "final": True, "software": software, "metrics": list(metrics), "curves": []}
    return SessionMetrics.model_validate(fields | changes)


def changes(before, after):
    return {
        (change.metric.name, change.metric.side): change
        for change in difference(result(*before), result(*after)).metrics
    }


def test_the_same_is_identical_whoever_computed_it():
    found = difference(result(metric()), result(metric(), software="ambula 0.2.0+22222222"))
    assert (found.identical, found.metrics, found.curves) == (True, [], [])


def test_any_bit_is_a_difference():
    found = difference(result(metric(value=0.1 + 0.2)), result(metric(value=0.3)))
    assert not found.identical
    assert found.metrics[0].kind is ChangeKind.CHANGED
    assert not difference(result(metric()), result(metric(), captured_ns=10)).identical


@pytest.mark.parametrize(
    ("before", "after", "kind"),
    [
        ([metric()], [metric(value=1.1)], ChangeKind.CHANGED),
        ([], [metric()], ChangeKind.NEW),
        ([metric()], [], ChangeKind.GONE),
        ([metric()], [metric(value=None, withheld_because="too few")], ChangeKind.WITHHELD),
        ([metric(value=None, withheld_because="too few")], [metric()], ChangeKind.GIVEN),
        ([metric()], [metric(strides=8)], ChangeKind.JUDGED),
        ([metric(value=None, withheld_because="a")], [metric(value=None, withheld_because="b")], ChangeKind.JUDGED),
    ],
)
def test_what_became_of_a_metric(before, after, kind):
    (change,) = changes(before, after).values()
    assert change.kind is kind
    assert kind in MEANING
    assert (change.change is None) == (kind not in (ChangeKind.CHANGED, ChangeKind.JUDGED) or not before[0].value)


def test_another_unit_or_side_is_another_metric():
    assert [change.kind for change in difference(result(metric()), result(metric(unit="km/h"))).metrics] == [
        ChangeKind.NEW,
        ChangeKind.GONE,
    ]
    found = changes([metric(side="left"), metric(side="right")], [metric(side="left"), metric(side="right", value=2.0)])
    assert list(found) == [("walking_speed", "right")]


def test_change_in_units_of_the_older_interval():
    before, after = metric(low=0.9, high=1.1), metric(value=1.3, low=1.25, high=1.35)
    (change,) = changes([before], [after]).values()
    assert change.change == pytest.approx(0.3)
    assert change.change_in_intervals == pytest.approx(3.0)
    (change,) = changes([metric()], [after]).values()
    assert change.change_in_intervals == pytest.approx(6.0)
    (change,) = changes([metric()], [metric(value=1.3)]).values()
    assert change.change_in_intervals is None


def test_curves_by_their_largest_distance():
    def curve(name, level, peak=0.0):
        mean = [level] * CURVE_POINTS
        mean[60] += peak
        return MeanCurve(degree_of_freedom=name, strides=5, mean=mean, spread=[0.0] * CURVE_POINTS)

    before = result(curves=[curve("knee", 0.1), curve("hip", 0.2), curve("ankle", 0.0)])
    after = result(curves=[curve("knee", 0.1, peak=-0.05), curve("hip", 0.2), curve("pelvis", 0.0)])
    found = {change.degree_of_freedom: change.largest for change in difference(before, after).curves}
    assert found == {"knee": pytest.approx(0.05), "ankle": None, "pelvis": None}
