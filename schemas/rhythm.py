"""What the rhythm model knows: phase, frequency, whether it may be trusted, and what it has learned of the stride."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from schemas.payload import Payload, SessionTime


class Rhythm(Payload):
    """Rhythm of one batch of samples; message for message beside joint_state, with the same sequence number."""

    captured_ns: list[SessionTime]
    phase: list[float] = Field(description="rad, unwrapped: one stride is 2 pi; continues over stops")
    frequency: list[float] = Field(description="rad/s of the stride")
    quality: list[float] = Field(description="explained share of joint velocity, at most 1; 0 when unlocked")
    locked: list[bool]


Coefficients = Annotated[list[float], Field(min_length=1, max_length=32)]


class LearnedJoint(Payload):
    """Mean stride of one joint: q(W) = sum over k of cosine[k-1] cos kW + sine[k-1] sin kW, about its mean.

    The rhythm learns velocities; k times the stride frequency times these are theirs. Angles are kept, because a
    person repeats them at another speed.
    """

    degree_of_freedom: str
    cosine: Coefficients = Field(description="rad, of harmonics 1, 2, ... of the stride")
    sine: Coefficients = Field(description="rad, of harmonics 1, 2, ... of the stride")
    spread: Coefficients = Field(
        description="rad: standard deviation over the strides, root mean square of the cosine's and the sine's"
    )

    @model_validator(mode="after")
    def _same_harmonics(self) -> Self:
        if not len(self.cosine) == len(self.sine) == len(self.spread):
            raise ValueError(f"{self.degree_of_freedom}: cosine, sine and spread must have as many harmonics each")
        return self


class LearnedRhythm(Payload):
    """The mean stride of a session so far, on one phase; the last one of a session is its result."""

    captured_ns: SessionTime
    frequency: float = Field(gt=0, description="rad/s of the stride, mean over the strides")
    frequency_spread: float = Field(ge=0, description="rad/s, standard deviation over the strides")
    strides: int = Field(ge=1, description="number of strides it was learned from")
    quality: float = Field(ge=0, le=1, description="lock quality: mean over the strides of their lowest, a share")
    joints: Annotated[list[LearnedJoint], Field(min_length=1, max_length=32)]

    @model_validator(mode="after")
    def _same_waveform_length(self) -> Self:
        if len({len(joint.cosine) for joint in self.joints}) > 1:
            raise ValueError("every joint of a learned rhythm must have as many harmonics")
        return self


RhythmKind = Literal["previous trial", "previous visit", "exemplar"]
"""Where a known rhythm comes from: the same day, an earlier day, or somebody to compare with."""


class KnownRhythm(Payload):
    """A rhythm that was learned before the session."""

    name: str = Field(max_length=200, description="where it comes from, e.g. the session it was learned in")
    kind: RhythmKind
    rhythm: LearnedRhythm
