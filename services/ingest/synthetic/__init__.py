"""Synthetic people who know the truth about themselves. Pure, but for writing it to a folder."""

from services.ingest.synthetic.files import write_recording
from services.ingest.synthetic.knee_flexion import SyntheticKnee
from services.ingest.synthetic.march import SyntheticMarch
from services.ingest.synthetic.parameters import KneeParameters, MarchParameters, TugParameters, WalkParameters
from services.ingest.synthetic.tug import SyntheticTug
from services.ingest.synthetic.walk import SyntheticWalk

__all__ = [
    "KneeParameters", "MarchParameters", "SyntheticKnee", "SyntheticMarch", "SyntheticTug", "SyntheticWalk",
    "TugParameters", "WalkParameters", "write_recording",
]  # fmt: skip
