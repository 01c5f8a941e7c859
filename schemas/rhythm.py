"""What the rhythm model knows: phase, frequency, and whether it may be trusted."""

from pydantic import Field

from schemas.payload import Payload, SessionTime


class Rhythm(Payload):
    """Rhythm of one batch of samples; message for message beside joint_state, with the same sequence number."""

    captured_ns: list[SessionTime]
    phase: list[float] = Field(description="rad, unwrapped: one stride is 2 pi; continues over stops")
    frequency: list[float] = Field(description="rad/s of the stride")
    quality: list[float] = Field(description="explained share of joint velocity, at most 1; 0 when unlocked")
    locked: list[bool]
