"""When the person stood still, as the operator says; travels with the samples of any sensor."""

from pydantic import Field

from schemas.payload import Payload, SessionTime


class StandingMark(Payload):
    """The operator says, while the session runs, that the person stood still. It counts from `given_ns` on."""

    from_ns: SessionTime
    to_ns: SessionTime
    given_ns: SessionTime = Field(description="ns: newest sample of the session when the mark came; later ones know it")
