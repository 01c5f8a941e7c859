"""Recorded walks of which only feet or only the lower back are known. Nobody of these was tuned on."""

import numpy as np
import pytest

from schemas.vocabulary import GaitEventKind, Segment, Side
from services.bench.gait.detections import detection_rows
from services.bench.gait.lower_back_walks import found_contacts_s, recorded_walks, within
from services.bench.gait.shoe_walk import SPEC, labelled_strides
from services.bench.gait.strides import through_chain
from services.bench.gait.voisard import BACK, FEET, detections
from services.ingest.errors import SourceError

IC, TO = GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF


def figures(walks) -> dict[str, float]:
    return {row.name.removeprefix("x: "): row.value for row in detection_rows("x", walks)}


def reviewed(trial: str, worn: frozenset[Segment]):
    try:
        return detections(trial, worn)
    except SourceError as missing:
        pytest.skip(str(missing))


def test_contacts_by_the_lower_back_against_reviewed_ones():
    found = figures([reviewed("3-1", BACK)[IC]])
    assert found["sensitivity"] >= 0.88
    assert found["predictive value"] >= 0.97
    assert found["right side"] >= 0.97
    assert abs(found["bias"]) < 60.0
    assert found["SD"] < 60.0


def test_contacts_and_toe_offs_by_the_feet_against_reviewed_ones():
    walk = reviewed("2-1", FEET)
    for kind in (IC, TO):
        found = figures([walk[kind]])
        assert found["sensitivity"] >= 0.92
        assert found["predictive value"] == 1.0
        assert abs(found["bias"]) < 40.0
        assert found["SD"] < 40.0


def test_a_sensor_on_the_back_marks_the_turning_strides_of_feet():
    try:
        found = through_chain("voisard_1_1", "ekf").found
    except SourceError as missing:
        pytest.skip(str(missing))
    turning = [stride for stride in found.strides if stride.turning]
    # The turn is known to last from 13.16 to 14.74 s.
    assert 2 <= len(turning) <= 5
    assert all(stride.start_ns < 14.74e9 and stride.end_ns > 13.16e9 for stride in turning)


def test_the_lower_back_alone_without_standing_against_insoles():
    try:
        walks = list(recorded_walks("Test5"))
    except SourceError as missing:
        pytest.skip(str(missing))
    found = figures([within(walk.bouts["INDIP"], found_contacts_s(walk)) for walk in walks])
    assert found["sensitivity"] >= 0.9
    assert found["predictive value"] >= 0.95
    assert found["right side"] >= 0.95
    assert found["SD"] < 60.0


def test_shoes_without_standing_against_labelled_strides():
    try:
        labels = labelled_strides()
        found = through_chain(SPEC, "ekf").found
    except SourceError as missing:
        pytest.skip(str(missing))
    for side in Side:
        contacts = np.sort(found.times_s(side, IC))
        within_one = [np.sum((contacts >= a) & (contacts < b)) for a, b in zip(*labels[side], strict=True)]
        assert set(within_one) == {1}
