"""Scores of the whole-body bench."""

import numpy as np
import pytest

from services.bench.kinect.cells import PUBLISHED, agreement, mean_cells
from services.bench.kinect.recorded_section import Followed


def test_the_published_table_has_34_cells_and_its_own_means() -> None:
    cells = [cell for task in PUBLISHED.values() for cell in task.values()]
    assert len(cells) == 34
    assert np.mean([cell[0] for cell in cells]) == pytest.approx(9.67, abs=0.005)
    assert np.mean([cell[1] for cell in cells]) == pytest.approx(0.857, abs=0.001)


def test_a_constant_offset_is_rmsd_but_no_zero_mean_error() -> None:
    truth = np.sin(np.linspace(0.0, 12.0, 300))
    cell = agreement(1, 7, truth + np.radians(5.0), truth)
    assert cell.rmsd_deg == pytest.approx(5.0)
    assert cell.zero_mean_deg == pytest.approx(0.0, abs=1e-9)
    assert cell.correlation == pytest.approx(1.0)
    assert cell.moves


def test_a_diverged_estimate_is_wrong_by_half_a_turn() -> None:
    truth = np.sin(np.linspace(0.0, 12.0, 300))
    assert agreement(1, 7, np.full(300, np.nan), truth).rmsd_deg == pytest.approx(180.0)


def test_cells_average_over_people() -> None:
    truth = np.sin(np.linspace(0.0, 12.0, 300))
    cells = [[agreement(1, 7, truth + np.radians(offset), truth)] for offset in (2.0, 4.0)]
    assert mean_cells(cells)[0].rmsd_deg == pytest.approx(3.0)


def test_steps_of_either_knee_count_once_per_frame() -> None:
    angles = np.zeros((10, 22))
    angles[5:, [6, 10]] = np.radians(25.0)
    found = Followed(angles, np.ones((10, 12)))
    assert found.steps() == 1
    assert found.largest_step() == pytest.approx(25.0)
    assert found.violations() == 0
