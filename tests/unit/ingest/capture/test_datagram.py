"""A datagram is a frame, or refused for a reason."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.health import Reason
from services.ingest.capture.datagram import MOST_BODIES, MOST_BYTES, BadDatagram, CameraFrame, decode_frame
from tests.unit.ingest.capture.datagrams import datagram, frame, joints


def test_a_frame_is_read_as_it_was_sent():
    body = {"id": 2**64 - 1, "joints": joints()}
    decoded = decode_frame(datagram(3, bodies=[body], floor=[0.0, 1.0, 0.1, 0.9]))
    assert (decoded.camera, decoded.seq, decoded.device_ns) == ("kinect_v2", 3, 5_099_999_000)
    assert decoded.floor == (0.0, 1.0, 0.1, 0.9)
    assert decoded.bodies[0].id == 2**64 - 1
    assert decoded.bodies[0].positions.tolist() == [row[:3] for row in body["joints"]]
    assert decoded.bodies[0].codes.tolist() == [row[3] for row in body["joints"]]


def test_time_in_ns_and_fields_of_a_newer_sender():
    said = {**frame(0), "t_ns": 17, "colour": "red"}
    del said["t_us"]
    assert decode_frame(json.dumps(said).encode()).device_ns == 17


def test_an_azure_kinect_has_32_joints_in_mm():
    decoded = decode_frame(datagram(0, kind="azure_kinect", bodies=[{"id": 1, "joints": joints("azure_kinect")}]))
    assert decoded.bodies[0].positions.shape == (32, 3)
    assert np.abs(decoded.bodies[0].positions).max() > 2000


def joint_with(value):
    return [{"id": 1, "joints": [[value, 0.0, 2.0, 2], *joints()[1:]]}]


@pytest.mark.parametrize(
    ("change", "reason", "word"),
    [
        ({"camera": "webcam"}, Reason.WRONG_SHAPE, "kinect_v2"),
        ({"camera": "other"}, Reason.WRONG_SHAPE, "kinect_v2"),
        ({"camera": None}, Reason.WRONG_SHAPE, "camera"),
        ({"seq": -1}, Reason.WRONG_SHAPE, "seq"),
        ({"seq": 1.5}, Reason.WRONG_SHAPE, "seq"),
        ({"seq": "1"}, Reason.WRONG_SHAPE, "seq"),
        ({"seq": 2**63}, Reason.WRONG_SHAPE, "seq"),
        ({"t_ns": 5}, Reason.WRONG_SHAPE, "t_us"),
        ({"t_us": -5}, Reason.WRONG_SHAPE, "t_us"),
        ({"t_us": 1e6}, Reason.WRONG_SHAPE, "t_us"),
        ({"floor": [0, 1, 0]}, Reason.WRONG_SHAPE, "floor"),
        ({"floor": [0, 1, 0, float("inf")]}, Reason.NOT_FINITE, "floor"),
        ({"bodies": None}, Reason.WRONG_SHAPE, "bodies"),
        ({"bodies": [{"id": 1, "joints": joints()[:-1]}]}, Reason.WRONG_SHAPE, "24 joints"),
        ({"bodies": [{"id": 1, "joints": joints("azure_kinect")}]}, Reason.WRONG_SHAPE, "32 joints"),
        ({"bodies": [{"id": 1, "joints": [[0.0, 0.0, 2.0]] * 25}]}, Reason.WRONG_SHAPE, "joints"),
        ({"bodies": [{"id": 1, "joints": [[0.0, 0.0, 2.0, 2]] * 65}]}, Reason.WRONG_SHAPE, "64"),
        ({"bodies": [{"id": True, "joints": joints()}]}, Reason.WRONG_SHAPE, "id"),
        ({"bodies": [{"id": 1, "joints": joints()}] * 2}, Reason.WRONG_SHAPE, "same id"),
        ({"bodies": [{"id": k, "joints": joints()} for k in range(MOST_BODIES + 1)]}, Reason.WRONG_SHAPE, "at most"),
        ({"bodies": joint_with(float("nan"))}, Reason.NOT_FINITE, "bodies.0.joints.0"),
        ({"bodies": joint_with("1.0")}, Reason.WRONG_SHAPE, "bodies.0.joints.0"),
        ({"bodies": joint_with(True)}, Reason.WRONG_SHAPE, "bodies.0.joints.0"),
        ({"bodies": joint_with(1e300)}, Reason.OUT_OF_RANGE, "in m"),
        ({"bodies": joint_with(1234.0)}, Reason.OUT_OF_RANGE, "in m"),
    ],
)
def test_what_is_no_frame_is_refused_and_said_why(change, reason, word):
    with pytest.raises(BadDatagram, match=word) as refused:
        decode_frame(json.dumps({**frame(0), **change}).encode())
    assert refused.value.reason is reason


@pytest.mark.parametrize(
    "garbage",
    [b"", b"\x00" * 40, b"\xff\xfe{", b"[" * 50_000, b"{", b'{"seq":' + b"9" * 6000 + b"}", datagram(0)[:-10]],
    ids=["empty", "zeros", "not utf-8", "deep", "cut", "long number", "cut frame"],
)
def test_garbage_is_undecodable(garbage):
    with pytest.raises(BadDatagram) as refused:
        decode_frame(garbage)
    assert refused.value.reason is Reason.UNDECODABLE


def test_no_datagram_is_longer_than_the_limit():
    with pytest.raises(BadDatagram, match="bytes"):
        decode_frame(datagram(0) + b" " * MOST_BYTES)
    longest = [[-1234.5678901234567, -1234.5678901234567, 4321.123456789012, 2]] * 32
    bodies = [{"id": 2**63 + k, "joints": longest} for k in range(6)]
    assert len(datagram(2**40, kind="azure_kinect", bodies=bodies)) < MOST_BYTES / 3


@settings(max_examples=300, deadline=None)
@given(st.binary(max_size=200), st.integers(0, 3000), st.integers(0, 255))
def test_damage_is_refused_or_still_a_frame(noise, at, value):
    """Random bytes, and a real datagram with bytes written over."""
    whole = bytearray(datagram(1))
    whole[at % len(whole)] = value
    for data in (noise, bytes(whole), bytes(whole[: at % len(whole)]) + noise):
        try:
            decoded = decode_frame(data)
        except BadDatagram:
            continue
        assert isinstance(decoded, CameraFrame)
        assert all(np.isfinite(body.positions).all() for body in decoded.bodies)
