"""A synthetic walker that knows the truth about itself. Pure, but for writing it to a folder."""

from services.ingest.synthetic.files import write_recording
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.walk import SyntheticWalk

__all__ = ["SyntheticWalk", "WalkParameters", "write_recording"]
