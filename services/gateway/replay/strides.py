"""The table of strides out of a recording."""

from schemas.gait import Stride
from schemas.signals import STRIDE
from services.flow.message import decode_payload
from services.gateway.replay.models import StrideOut, StridePage
from services.recordings.ranges import RecordedRanges

_CURVES = b',"curves":'


def stride_page(session: str, recording: RecordedRanges, offset: int, limit: int) -> StridePage:
    """Some strides, counted and found by the index. Raises DamagedRecording, DecodeError, OSError."""
    found = recording.find(STRIDE, 0, recording.end_ns + 1)
    strides = []
    for stream, envelope, payload, _ in recording.read(found[offset : offset + limit]):
        decoded = decode_payload(stream.signal, envelope, without_curves(payload))
        assert isinstance(decoded, Stride)
        strides.append(decoded)
    strides.sort(key=lambda stride: (stride.end_ns, stride.side))
    return StridePage(session=session, total=len(found), items=[stride_out(stride) for stride in strides])


def without_curves(payload: bytes) -> bytes:
    """A stride's message without what is nine tenths of it, and stands at its end."""
    head, curves, _ = payload.partition(_CURVES)
    return head + curves + b"{}}" if curves else payload


def stride_out(stride: Stride) -> StrideOut:
    """A stride for the API."""
    return StrideOut(
        side=stride.side,
        index=stride.index,
        start_s=stride.start_ns / 1e9,
        toe_off_s=None if stride.toe_off_ns is None else stride.toe_off_ns / 1e9,
        end_s=stride.end_ns / 1e9,
        stride_time_s=stride.stride_time_s,
        stance_fraction=stride.stance_fraction,
        step_time_s=stride.step_time_s,
        step_length_m=stride.step_length_m,
        step_length_std_m=stride.step_length_std_m,
        stride_length_m=stride.stride_length_m,
        walking_speed=stride.walking_speed,
        step_width_m=stride.step_width_m,
        circumduction_m=stride.circumduction_m,
        turn=stride.turn,
        turning=stride.turning,
        valid=stride.valid,
        rejected_because=stride.rejected_because,
    )
