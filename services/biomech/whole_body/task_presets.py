"""Settings tuned for each of the four tasks. They are there to be chosen; what a session uses without a word is common.

`tuned_tables.py` holds the values and says on whom they were found; `ambula tune --out` writes it.
"""

from dataclasses import replace
from typing import Literal, get_args

import numpy as np

from schemas.vocabulary import Task
from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings
from services.biomech.whole_body.parameters import ProcessNoise
from services.biomech.whole_body.presets import CORRECTED
from services.biomech.whole_body.tuned_tables import TABLES

Way = Literal["published", "ours", "hidden"]
"""Q of the corrected filter by eq. 8; Q of ours by eq. 8; R and Q of ours by hidden centres, without a reference."""
WAYS: tuple[Way, ...] = get_args(Way)
BASES: dict[Way, FilterSettings] = {"published": CORRECTED, "ours": OURS, "hidden": OURS}

TASK_NUMBERS = {Task.SQUAT: 1, Task.STEPPING: 2, Task.TRUNK_TILT_SAGITTAL: 3, Task.TRUNK_TILT_FRONTAL: 4}
"""As the paper numbers them."""

Values = tuple[float, ...]
"""Variance of the camera, m^2; along bones, squared bones; the 11 groups of the process."""


def values_of(settings: FilterSettings) -> Values:
    """What of settings is tuned."""
    return (settings.camera.variance, settings.camera.along, *map(float, settings.process.groups()))


def with_values(base: FilterSettings, values: Values) -> FilterSettings:
    """Settings with tuned values in the place of their own."""
    variance, along, *groups = values
    process = ProcessNoise.of_groups(np.array(groups), held=base.process.held)
    return replace(base, camera=replace(base.camera, variance=variance, along=along), process=process)


def settings_for_task(task: Task, way: Way = "ours") -> FilterSettings:
    """What was tuned for a task.

    Raises:
        ValueError: nothing was tuned for that task.
    """
    if task not in TASK_NUMBERS:
        raise ValueError(f"settings were tuned for {', '.join(TASK_NUMBERS)}, not for {task}")
    return numbered(way, TASK_NUMBERS[task])


def numbered(way: Way, task: int) -> FilterSettings:
    """What was tuned for a task by its number in the paper, 1 to 4. Eq. 8 leaves the camera as it is believed."""
    base = BASES[way]
    found = with_values(base, TABLES[way][task])
    return found if way == "hidden" else replace(found, camera=base.camera)
