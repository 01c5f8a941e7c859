"""A knee estimator is refused where no leg wears both sensors, before a session begins."""

import pytest

from services.ingest.errors import InvalidManifest, InvalidOption
from services.ingest.source import open_source
from services.ingest.synthetic import write_recording


@pytest.mark.parametrize("estimator", ["knee_axis", "knee_band_grover"])
def test_a_pelvis_alone_is_no_knee(estimator):
    with pytest.raises(InvalidOption, match="a sensor on the thigh and one on the shank of one leg"):
        open_source("synthetic:walk?worn=3", estimator=estimator).describe()


@pytest.mark.parametrize("worn", [0, 1, 2])
def test_a_whole_leg_is_one(worn):
    description = open_source(f"synthetic:walk?worn={worn}", estimator="knee_axis_mcgrath").describe()
    assert description.estimator == "knee_axis_mcgrath"


def test_a_manifest_says_what_to_correct(tmp_path):
    write_recording(tmp_path, "duration=5&worn=3")
    manifest = tmp_path / "recording.toml"
    manifest.write_text('estimator = "knee_axis"\n' + manifest.read_text())
    with pytest.raises(InvalidManifest, match="correct the segments, or leave the estimator out"):
        open_source(str(tmp_path))
