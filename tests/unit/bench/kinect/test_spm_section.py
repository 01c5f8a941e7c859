"""Where in a repetition methods differ."""

import numpy as np
import pytest

from services.bench.kinect import spm_section
from services.bench.kinect.cells import PUBLISHED
from services.bench.kinect.contenders import BEST, BY_FREQUENCY, OPTIMISED, Piece
from services.bench.kinect.spm_section import METHODS, compared, curves_of, repetition_borders
from services.bench.kinect.spm_section import spm_section as section
from services.bench.kinect.trials import truth
from services.biomech.spm.paired import NODES


def curves(mean: float, seed: int) -> np.ndarray:
    """(people, repetitions, nodes) of errors, deg."""
    generator = np.random.default_rng(seed)
    wave = np.sin(np.linspace(0.0, 9.0, NODES) + generator.uniform(0.0, 6.0, size=(7, 1)))
    people = mean + generator.normal(0.0, 0.3, size=(7, 1)) + 0.5 * wave
    return people[:, None, :] + generator.normal(0.0, 0.1, size=(7, 3, 1)) * np.ones(NODES)


def test_borders_are_where_the_number_changes() -> None:
    number = np.array([0, 0, 1, 1, 1, 0, 2, 2, 3, 3, 0.0])
    assert repetition_borders(number) == [(2, 5), (6, 8), (8, 10)]
    assert repetition_borders(np.array([1.0, 1.0])) == [(0, 2)]
    assert repetition_borders(np.zeros(4)) == []


def test_a_trial_has_ten_repetitions_and_the_truth_moves_in_them() -> None:
    trial = truth(0, 3)
    borders = repetition_borders(trial.repetition)
    assert len(borders) == 10
    trunk = np.degrees(trial.q[:, 3 + 11])
    assert all(np.ptp(trunk[a:b]) > 10.0 for a, b in borders)
    assert np.ptp(trunk[: borders[0][0]]) < 10.0


def test_curves_of_a_trial_are_absolute_errors_over_a_repetition() -> None:
    found = curves_of(Piece(BEST, "clinic", 1, 3))
    assert list(found) == list(PUBLISHED[3])
    assert all(curve.shape == (10, NODES) and (curve >= 0.0).all() for curve in found.values())
    assert 0.5 < np.mean(list(found.values())) < 10.0


def test_positive_is_where_the_second_is_nearer() -> None:
    one = compared(1, 7, curves(9.0, 1), curves(3.0, 2))
    assert one.spm.share(positive=True) > 0.9
    assert one.flips.p == pytest.approx(2 / 128)
    assert one.first.shape == (7, NODES)


def test_repetitions_taken_for_pairs_lower_the_threshold() -> None:
    one = compared(1, 7, curves(4.0, 1), curves(3.0, 2))
    assert one.pooled.field.nu == 20
    assert one.spm.field.nu == 6
    assert one.pooled.threshold < one.spm.threshold


def test_the_section_compares_every_angle_both_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors of 9, 5 and 5 deg: optimising helps everywhere, ours nowhere."""
    means = {BY_FREQUENCY: 9.0, OPTIMISED: 5.0, BEST: 5.0}
    made = {
        (name, task, angle): curves(means[name], 1000 * METHODS.index(name) + 100 * task + angle)
        for name in METHODS for task in PUBLISHED for angle in PUBLISHED[task]
    }  # fmt: skip
    monkeypatch.setattr(spm_section, "error_curves", lambda spread, advance: made)
    monkeypatch.setattr(spm_section, "PROCESSES", 1)
    found = section(lambda: None)
    rows = {row.name: row.value for row in found.rows}
    assert rows["spm, Q eq. 6-7 against Q eq. 8: angles compared"] == 34
    assert rows["spm, Q eq. 6-7 against Q eq. 8: second nearer over 60 % of the repetition"] == 34
    assert rows["spm, Q eq. 8 against ours: second nearer over 60 % of the repetition"] < 5
    assert [len(table.rows) for table in found.tables] == [34, 34]
    assert len(found.charts) == 2 * 2 * len(spm_section.FIGURE_6)
    assert "t* =" in found.charts["spm_1_task_1_angle_4_t"]


def test_clusters_are_told_with_place_side_and_p() -> None:
    one = compared(1, 7, curves(9.0, 1), curves(3.0, 2))
    assert spm_section.clusters_text(one.spm.clusters).startswith("0-100 % second, p < 0.001")
    assert spm_section.clusters_text([]) == "no difference"
