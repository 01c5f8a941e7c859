"""A recorded walk and recorded sit-to-stand, marked as an operator would: standing is taken, sitting never."""

import numpy as np
import pytest

from schemas.imu import ImuBatch
from schemas.kinematics import Calibration, JointState, LivePose
from schemas.standing import StandingMark
from schemas.vocabulary import LOWER_BODY
from services.estimation.lower_body.node import LowerBodyNode
from services.flow.message import Message, Output
from services.ingest.errors import MissingFile
from services.ingest.source import iter_messages, open_source

KNEE = [dof.name for dof in LOWER_BODY].index("knee_flexion_left")


def replay(spec: str, marks: list[tuple[float, float]], *, described: bool = True) -> list[Output]:
    """All outputs when the operator marks these spans, s, each as soon as it is over."""
    try:
        source = open_source(spec, session="s", estimator="ekf")
    except MissingFile as missing:
        pytest.skip(str(missing))
    description = source.describe()
    node = LowerBodyNode(description if described else description.model_copy(update={"standing": []}))
    due = [StandingMark(from_ns=round(a * 1e9), to_ns=round(b * 1e9), given_ns=round(b * 1e9)) for a, b in marks]
    outputs: list[Output] = []
    for message in iter_messages(source):
        if message.stream not in node.streams or message.envelope.final:
            continue
        if due and message.envelope.captured_ns > due[0].given_ns:
            assert isinstance(message.payload, ImuBatch)
            payload = message.payload.model_copy(update={"marks": [due.pop(0)]})
            message = Message(message.stream, message.envelope, payload)
        outputs += node.step(message)
    return outputs + node.finish()


def of(kind, outputs):
    return [output.payload for output in outputs if isinstance(output.payload, kind)]


def notices(outputs) -> list[str]:
    said = [pose.notice for pose in of(LivePose, outputs)]
    return [text for text, before in zip(said, ["", *said], strict=False) if text and text != before]


def knee(outputs) -> dict[int, float]:
    rows = [(t, row[KNEE]) for s in of(JointState, outputs) for t, row in zip(s.captured_ns, s.position, strict=True)]
    return dict(rows)


def test_a_mark_in_the_standing_before_a_walk_gives_the_angles_of_the_standing_found() -> None:
    found, marked = replay("neura_s02_walk", []), replay("neura_s02_walk", [(4.0, 9.0)])
    assert notices(marked) == ["Standing taken as marked"]
    assert of(Calibration, marked)[0].method == "standing, marked by the operator + walking"
    one, other = knee(found), knee(marked)
    walking = [t for t in one if t in other and t > 12_000_000_000]
    assert len(walking) > 900
    difference = np.degrees([one[t] - other[t] for t in walking])
    assert np.sqrt(np.mean(difference**2)) < 1.0


def test_a_mark_in_the_walk_is_refused() -> None:
    outputs = replay("neura_s02_walk", [(12.0, 14.0)])
    (notice,) = notices(outputs)
    assert notice.startswith("Not taken as standing: ")
    assert notice.endswith(" moved")
    assert knee(outputs) == knee(replay("neura_s02_walk", []))


@pytest.mark.parametrize("described", [True, False])
def test_no_mark_anywhere_in_sit_to_stand_takes_sitting_or_rising_for_standing(described: bool) -> None:
    """Ten repetitions without a second of quiet: every mark is refused, before and after there are angles."""
    marks = [(start, start + 2.0) for start in np.arange(1.0, 37.0, 2.5)]
    outputs = replay("alborno_sub03_sts1", marks, described=described)
    said = [pose.notice for pose in of(LivePose, outputs) if pose.notice]
    assert said
    assert all(text.startswith("Not taken as standing: ") for text in said)
    assert len(of(Calibration, outputs)) == int(described)
