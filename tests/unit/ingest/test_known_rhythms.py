"""Known rhythms reach the description of every source, and bad ones are refused with a reason."""

import json

import pytest

from schemas.rhythm import KnownRhythm, LearnedJoint, LearnedRhythm
from schemas.session import SessionDescription
from services.ingest.errors import InvalidOption
from services.ingest.orders import InvalidOrder, StartOrder, parse_order
from services.ingest.source import iter_messages, open_source
from tests.unit.ingest.test_mcap_file import archive

WALK = "synthetic:walk?duration=12"


def known(kind: str = "previous trial", name: str = "before") -> KnownRhythm:
    joint = LearnedJoint(degree_of_freedom="knee_flexion_left", cosine=[0.3], sine=[0.1], spread=[0.01])
    rhythm = LearnedRhythm(captured_ns=9, frequency=6.0, frequency_spread=0.1, strides=5, quality=0.9, joints=[joint])
    return KnownRhythm(name=name, kind=kind, rhythm=rhythm)


def test_a_source_knows_none_unless_told():
    assert open_source(WALK).describe().known_rhythms == []
    given = [known("previous visit"), known("exemplar")]
    assert open_source(WALK, known_rhythms=given).describe().known_rhythms == given


def test_two_of_a_kind_are_refused():
    with pytest.raises(InvalidOption, match="at most one"):
        open_source(WALK, known_rhythms=[known(), known(name="other")])
    description = open_source(WALK).describe().model_dump(mode="json")
    with pytest.raises(ValueError, match="at most one"):
        SessionDescription.model_validate(description | {"known_rhythms": [known().model_dump()] * 2})


def test_a_description_of_an_older_writer_is_read():
    description = open_source(WALK).describe()
    fields = description.model_dump(mode="json")
    del fields["known_rhythms"], fields["walk_path"]
    assert SessionDescription.model_validate_json(json.dumps(fields)) == description


def test_a_start_carries_them():
    order = parse_order(
        StartOrder, json.dumps({"source": WALK, "speed": 1, "known_rhythms": [known().model_dump()]}).encode()
    )
    assert order.known_rhythms == [known()]
    assert parse_order(StartOrder, json.dumps({"source": WALK, "speed": 1}).encode()).known_rhythms is None


@pytest.mark.parametrize(
    "change",
    [
        {"frequency": 0.0},
        {"frequency": "NaN"},
        {"strides": 0},
        {"joints": []},
        {"joints": [{"degree_of_freedom": "knee", "cosine": [0.1], "sine": [0.1, 0.2], "spread": [0.1]}]},
        {"joints": [{"degree_of_freedom": "knee", "cosine": [0.1] * 99, "sine": [0.1] * 99, "spread": [0.1] * 99}]},
    ],
)
def test_a_rhythm_that_cannot_be_is_refused_with_the_field(change):
    body = known().model_dump(mode="json")
    body["rhythm"] |= change
    with pytest.raises(InvalidOrder, match="known_rhythms"):
        parse_order(StartOrder, json.dumps({"source": WALK, "speed": 1, "known_rhythms": [body]}).encode())


def test_a_replay_knows_what_the_recording_knew_unless_told_otherwise(tmp_path):
    source = open_source("synthetic:walk?duration=5", known_rhythms=[known()])
    archive(tmp_path / "recorded", list(iter_messages(source)), source.describe())
    folder = str(tmp_path / "recorded")
    assert open_source(folder).describe().known_rhythms == [known()]
    assert open_source(folder, known_rhythms=[]).describe().known_rhythms == []
    assert open_source(folder, known_rhythms=[known("exemplar")]).describe().known_rhythms == [known("exemplar")]
