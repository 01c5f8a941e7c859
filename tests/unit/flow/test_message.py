"""The envelope's wire form: exact both ways, and only DecodeError for anything else."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from schemas.imu import ImuBatch, SensorSamples
from schemas.signals import IMU, SIGNALS
from services.flow.message import DecodeError, Envelope, Stream, decode_payload, encode_payload

WORDS = st.lists(st.text("0123456789-+_ .eabcé", max_size=6), min_size=3, max_size=7)


@given(st.integers(0, 2**63), st.integers(0, 2**63), st.integers(-(2**63), 2**63), st.booleans())
def test_an_envelope_survives_the_wire(epoch, sequence, captured_ns, final):
    envelope = Envelope(epoch, sequence, captured_ns, final)
    assert Envelope.decode(envelope.encode()) == envelope


@settings(max_examples=2000)
@given(st.binary(max_size=60) | WORDS.map(lambda words: " ".join(words).encode()))
def test_any_bytes_are_an_envelope_or_a_decode_error(data):
    try:
        envelope = Envelope.decode(data)
    except DecodeError:
        return
    assert envelope.encode() == data


@pytest.mark.parametrize(
    "words",
    ["", "0 0 0 0", "0 -1 0 0 v", "-1 0 0 0 v", "0 0 0 2 v", "0 1_0 0 0 v", "00 0 0 0 v", "0 0 0 0 ", "0 0 0 0 a b"],
)
def test_near_misses_are_refused(words):
    with pytest.raises(DecodeError):
        Envelope.decode(words.encode())


@settings(max_examples=500)
@given(st.sampled_from(SIGNALS), st.binary(max_size=80) | st.recursive(
    st.none() | st.booleans() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=12), inner, max_size=3),
).map(lambda value: repr(value).replace("'", '"').encode()))  # fmt: skip
def test_any_bytes_are_a_payload_or_a_decode_error(signal, data):
    try:
        decode_payload(signal, Envelope(0, 0, 0), data)
    except DecodeError:
        return


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 3), max_size=5))
def test_floats_survive_to_the_bit(vectors):
    count = len(vectors)
    samples = SensorSamples(
        captured_ns=list(range(count)), angular_velocity=[list(v) for v in vectors], specific_force=[[0.0] * 3] * count
    )
    batch = ImuBatch(sensors=[samples], marks=[])
    assert decode_payload(IMU, Envelope(0, 0, 0), encode_payload(batch)) == batch


@pytest.mark.parametrize("word", [b"NaN", b"Infinity", b"1e999", b'"x"', b"null"])
def test_numbers_that_are_none_are_refused(word):
    text = b'{"sensors":[{"captured_ns":[0],"angular_velocity":[[0,0,' + word + b']],"specific_force":[[0,0,0]]}]}'
    with pytest.raises(DecodeError):
        decode_payload(IMU, Envelope(0, 0, 0), text)


def test_the_final_message_has_no_payload():
    assert encode_payload(None) == b""
    assert decode_payload(IMU, Envelope(0, 0, 0, final=True), b"") is None


def test_streams_have_names():
    stream = Stream(IMU, "left/hub")
    assert Stream.parse(stream.name) == stream
    with pytest.raises(KeyError):
        Stream.parse("nonsense/hub")
