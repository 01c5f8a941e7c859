"""Settings that were tuned for a task."""

import numpy as np
import pytest

from schemas.vocabulary import Task
from services.biomech.whole_body.constrained_ekf import OURS, WholeBodyEkf
from services.biomech.whole_body.parameters import GROUPS
from services.biomech.whole_body.presets import CORRECTED
from services.biomech.whole_body.task_presets import (
    TASK_NUMBERS,
    WAYS,
    numbered,
    settings_for_task,
    values_of,
    with_values,
)
from services.biomech.whole_body.tuned_tables import TABLES, TUNED_ON


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("task", TASK_NUMBERS.values())
def test_every_task_was_tuned_in_every_way(way, task: int) -> None:
    values = TABLES[way][task]
    assert len(values) == 2 + len(GROUPS)
    assert all(np.isfinite(value) and value >= 0.0 for value in values)
    assert values_of(numbered(way, task))[2:] == values[2:]


def test_only_what_was_tuned_differs_from_the_base() -> None:
    """Eq. 8 leaves the camera's noise alone; hidden centres do not."""
    ours, hidden, published = (numbered(way, 2) for way in ("ours", "hidden", "published"))
    assert ours.camera == OURS.camera
    assert ours.priors == hidden.priors == OURS.priors
    assert hidden.camera != OURS.camera
    assert (hidden.camera.variance, hidden.camera.along) == TABLES["hidden"][2][:2]
    assert published.camera == CORRECTED.camera
    assert not np.array_equal(ours.process.groups(), OURS.process.groups())


def test_a_session_chooses_by_its_task() -> None:
    assert settings_for_task(Task.STEPPING) == numbered("ours", 2)
    assert settings_for_task(Task.SQUAT, "hidden") == numbered("hidden", 1)
    with pytest.raises(ValueError, match="tuned for"):
        settings_for_task(Task.WALK)


def test_it_is_known_on_whom() -> None:
    assert "person 0" in TUNED_ON
    assert "seeds" in TUNED_ON


@pytest.mark.parametrize("way", ["ours", "hidden"])
@pytest.mark.parametrize("task", [1, 2, 3, 4])
def test_a_filter_runs_with_them_and_stays_sound(way, task: int, person) -> None:
    q = person.squats(90)
    ekf = WholeBodyEkf(person.start(), numbered(way, task))
    for k, centres in enumerate(person.seen(q, 0.01)):
        ekf.advance(1.0 / 30.0 if k else 0.0, centres, np.full(15, 2))
    assert ekf.is_sound()
    assert np.linalg.eigvalsh(ekf.P).min() > 0.0


def test_values_go_into_settings_and_come_back() -> None:
    values = (2e-3, 0.05, *(float(k) for k in range(1, 12)))
    assert values_of(with_values(OURS, values)) == values
