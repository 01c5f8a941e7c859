import json

import pytest

from schemas.metrics import SessionMetrics, TrustGrade
from schemas.quality import DataQuality, SourceQuality
from schemas.signals import DATA_QUALITY, METRICS, STRIDE
from schemas.vocabulary import Side
from services.flow.message import Envelope, Message, Stream
from services.metrics.node import build


@pytest.fixture
def messages(stride):
    return [
        Message(
            Stream(STRIDE, "segmentation"),
            Envelope(0, number, made.end_ns),
            made,
        )
        for number, made in enumerate(
            stride(side, index, step_length_m=0.5 + 0.01 * index, turning=index == 3)
            for index in range(8)
            for side in Side
        )
    ]


def run(node, messages) -> list[tuple[int, str]]:
    outputs = [output for message in messages for output in node.step(message)] + node.finish()
    assert all(output.signal is METRICS for output in outputs)
    return [(output.captured_ns, output.payload.model_dump_json()) for output in outputs]


def test_one_message_a_pair_and_a_final_one(messages, description):
    found = [SessionMetrics.model_validate_json(text) for _, text in run(build(description), messages)]
    assert [metrics.final for metrics in found] == [False] * 8 + [True]
    assert [metrics.captured_ns for metrics in found] == sorted(metrics.captured_ns for metrics in found)


def test_one_leg_alone_reports_too(messages, description):
    left = [message for message in messages if message.payload.side is Side.LEFT]
    assert len(run(build(description), left)) == 4 + 1


def test_a_session_without_strides_ends_with_everything_withheld(description):
    [(captured_ns, text)] = run(build(description), [])
    metrics = SessionMetrics.model_validate_json(text)
    assert captured_ns == 0
    assert metrics.final
    assert metrics.curves == []
    assert all(metric.value in (None, 0.0) for metric in metrics.metrics)


@pytest.mark.parametrize("cut", [0, 1, 6, 15])
def test_split_and_resume(cut, messages, description):
    expected = run(build(description), messages)
    first, second = build(description), build(description)
    outputs = [output for message in messages[:cut] for output in first.step(message)]
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert second.snapshot() == first.snapshot()
    before = [(output.captured_ns, output.payload.model_dump_json()) for output in outputs]
    assert before + run(second, messages[cut:]) == expected


def test_two_sessions_interleaved_are_each_alone(messages, stride, description):
    others = [
        Message(
            message.stream, message.envelope, stride(message.payload.side, message.payload.index, stride_time_s=1.3)
        )
        for message in messages
    ]
    nodes, outputs = (build(description), build(description)), ([], [])
    for pair in zip(messages, others, strict=True):
        for node, message, output in zip(nodes, pair, outputs, strict=True):
            output += [(out.captured_ns, out.payload.model_dump_json()) for out in node.step(message)]
    assert outputs[0] + run(nodes[0], []) == run(build(description), messages)
    assert outputs[1] + run(nodes[1], []) == run(build(description), others)


def test_the_state_does_not_grow(messages, description):
    node = build(description)
    sizes = []
    for _ in range(3):
        for message in messages:
            node.step(message)
        sizes.append(len(json.dumps(node.snapshot())))
    assert max(sizes) - min(sizes) < 200
    assert node.rejections() == []


def told_quality(description, used: int) -> Message:
    """Half a minute, of which every sensor's samples were used in part."""
    sources = [
        SourceQuality(name=sensor.name, expected=3000, used=used, rejected=0, longest_silence_s=0.1, misplaced=False)
        for hub in description.hubs
        for sensor in hub.sensors
    ]
    payload = DataQuality(
        captured_ns=30_000_000_000, sources=sources, calibrated=True, absolute=True, spanned_s=30.0, estimated_s=30.0,
        moving_s=25.0, locked_s=24.0, late=0,
    )  # fmt: skip
    return Message(Stream(DATA_QUALITY, "estimation"), Envelope(0, 0, payload.captured_ns), payload)


def test_the_quality_of_the_data_counts_at_the_end_whenever_it_came(messages, description):
    poor = told_quality(description, used=2600)
    early, late = run(build(description), [poor, *messages]), run(build(description), [*messages, poor])
    assert early == late
    assert early[:-1] == run(build(description), messages)[:-1]
    final = SessionMetrics.model_validate_json(early[-1][1])
    assert final.quality == poor.payload
    by_name = {(metric.name, metric.side): metric for metric in final.metrics}
    assert by_name["stance_time", "left"].grade is TrustGrade.POOR
    assert by_name["strides_counted", "left"].grade is TrustGrade.GOOD


def test_split_and_resume_keeps_the_quality(messages, description):
    poor = told_quality(description, used=2600)
    first, second = build(description), build(description)
    first.step(poor)
    second.restore(json.loads(json.dumps(first.snapshot(), allow_nan=False)))
    assert run(second, messages) == run(first, messages)


def test_legs_are_compared_while_the_session_runs_and_at_its_end(messages, description):
    found = [SessionMetrics.model_validate_json(text) for _, text in run(build(description), messages)]
    assert found[0].sides == []
    assert {side.joint for side in found[-1].sides} == {
        "hip_flexion", "hip_adduction", "hip_internal_rotation", "knee_flexion"
    }  # fmt: skip
    assert all(side.rmse == 0.0 for side in found[-1].sides)
