"""Sit to stand without a mark: there is no standing of a second, and no walk. Nothing may be taken for either."""

import pytest

from services.estimation.lower_body.node import LowerBodyNode
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source


def test_sit_to_stand_without_a_mark_is_refused_and_says_what_to_do() -> None:
    try:
        source = open_source("alborno_sub03_sts1", session="s", estimator="ekf")
    except MissingFile as missing:
        pytest.skip(str(missing))
    node = LowerBodyNode(source.describe().model_copy(update={"standing": []}))
    stream = [m for m in iter_messages(source) if m.stream in node.streams and not m.envelope.final]
    outputs = [output for message in stream for output in node.step(message)] + node.finish()
    poses = [output.payload for output in outputs if output.signal.name == "live_pose"]
    assert {output.signal.name for output in outputs} == {"live_pose", "data_quality"}
    assert {pose.message for pose in poses} <= {
        "Stand still, upright",
        "Sitting, not standing: please stand up straight",
    }
    assert "Stand still, upright" in {pose.message for pose in poses}
