import numpy as np
import pytest

from schemas.imu import ImuBatch, SensorSamples
from schemas.session import SessionDescription
from schemas.vocabulary import Segment, Side
from services.bench.gait.detections import Detection, detection_rows
from services.bench.gait.lower_back_walks import Bout, within
from services.bench.gait.shoe_walk import Labelled, stride_errors_s
from services.bench.gait.stride_scores import stride_time_errors_s
from services.bench.gait.voisard import manifest_of
from services.bench.gait.worn import wearing, worn_only
from services.ingest.source import iter_messages, open_source


def seconds(*times: float) -> np.ndarray:
    return np.array(times, dtype=float)


def test_rows_count_each_foot_for_itself():
    walk = Detection(
        {Side.LEFT: seconds(1, 2, 3), Side.RIGHT: seconds(1.5, 2.5)},
        {Side.LEFT: seconds(1.02, 2.02, 5.0), Side.RIGHT: seconds(1.52, 3.0)},
    )
    values = {row.name: row.value for row in detection_rows("x", [walk])}
    assert values["x: sensitivity"] == pytest.approx(3 / 5)
    assert values["x: predictive value"] == pytest.approx(3 / 5)
    assert values["x: F1"] == pytest.approx(3 / 5)
    assert values["x: bias"] == pytest.approx(20.0)
    # The contact at 3 s was found, for the other foot.
    assert values["x: right side"] == pytest.approx(3 / 4)
    assert values["x: stride time, mean absolute error"] == pytest.approx(0.0)


def test_nothing_found_is_no_number():
    nothing = Detection({side: seconds(1, 2) for side in Side}, {side: seconds() for side in Side})
    values = {row.name: row.value for row in detection_rows("x", [nothing])}
    assert values["x: sensitivity"] == 0.0
    assert values["x: predictive value"] is None
    assert values["x: SD"] is None


def test_a_stride_needs_both_of_its_ends():
    errors = stride_time_errors_s(seconds(1, 2, 3, 4), seconds(1.0, 2.05, 4.0))
    np.testing.assert_allclose(errors, [0.05])


def test_contacts_away_from_the_bouts_are_not_judged():
    bout = Bout(10.0, 12.0, {Side.LEFT: seconds(10, 11), Side.RIGHT: seconds(10.5)})
    judged = within([bout], {Side.LEFT: seconds(3, 9.6, 11, 13), Side.RIGHT: seconds(12.4)})
    np.testing.assert_allclose(judged.found_s[Side.LEFT], [9.6, 11])
    np.testing.assert_allclose(judged.found_s[Side.RIGHT], [12.4])


def test_labels_that_do_not_touch_make_no_stride():
    labels = Labelled(seconds(0, 1, 5), seconds(1, 2.2, 6))
    assert stride_errors_s(labels, seconds(0.6, 1.7, 5.6)) == [pytest.approx(0.0)]


def test_the_manifest_of_another_trial():
    assert "2-2_{sensor}.txt" in manifest_of("2-2")


def test_only_the_worn_sensors_are_left():
    source = open_source("synthetic:walk?duration=5&feet=1&truth=0", estimator="ekf")
    description = source.describe()
    worn = frozenset({Segment.FOOT_LEFT, Segment.PELVIS})
    kept: SessionDescription = wearing(description, worn)
    assert [sensor.segment for hub in kept.hubs for sensor in hub.sensors] == [Segment.PELVIS, Segment.FOOT_LEFT]
    before, after = list(iter_messages(source)), list(worn_only(iter_messages(source), description, worn))
    assert [m.envelope for m in before] == [m.envelope for m in after]
    batch, whole = after[0].payload, before[0].payload
    assert isinstance(batch, ImuBatch)
    segments = [sensor.segment for sensor in description.hubs[0].sensors]
    expected: list[SensorSamples] = [whole.sensors[segments.index(s)] for s in (Segment.PELVIS, Segment.FOOT_LEFT)]
    assert batch.sensors == expected
