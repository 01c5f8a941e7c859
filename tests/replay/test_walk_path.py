"""A recorded walk with a half turn, estimated for a turning and for a straight path, and as published."""

import numpy as np
import pytest

from services.bench.accuracy.joint_scores import estimate_angles
from services.bench.accuracy.neura_truth import collect_truth
from services.bench.accuracy.walk import RECORDINGS, WITH_TURN, figures, mean_of
from services.ingest.data import find_data
from services.ingest.errors import MissingFile

SPEC = RECORDINGS["neura"]


@pytest.fixture(scope="module")
def truth():
    try:
        find_data(SPEC)
    except MissingFile as missing:
        pytest.skip(str(missing))
    return collect_truth(SPEC)


def test_a_straight_path_serves_straight_walking_and_survives_a_turn(truth) -> None:
    angles = estimate_angles(SPEC, "ekf", walk_path="straight")
    scores = {key: mean_of(sides) for key, sides in figures(angles, truth).items()}
    assert scores["knee PiG", "straight"] < 3.1
    assert scores["hip", "straight"] < 2.65
    assert scores["hip", "with turn"] < 3.05


@pytest.mark.parametrize("walk_path", ["turning", "straight"])
def test_the_published_filter_is_whole_and_much_worse(truth, walk_path) -> None:
    angles = estimate_angles(SPEC, "joukov_published", walk_path=walk_path)
    assert np.isfinite(angles[WITH_TURN]).all()
    assert 5.0 < mean_of(figures(angles, truth)["knee PiG", "straight"]) < 10.0
