"""Search for settings one value at a time: camera and scale of the process first, then each group of the process."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from services.biomech.whole_body.constrained_ekf import FilterSettings
from services.biomech.whole_body.parameters import GROUPS, ProcessNoise

Move = Callable[[FilterSettings, float], FilterSettings]
Judge = Callable[[Sequence[FilterSettings]], list[float]]
"""Value of each of several settings, less is better; it may judge them in several processes."""

STEPS = 3
"""At most, in one direction, before the next value has its turn."""


def descend(
    judge: Judge, start: FilterSettings, sweeps: int, factor: float, least_gain: float,
    on_step: Callable[[], None] = lambda: None,
) -> FilterSettings:  # fmt: skip
    """Settings with a lower value. Each sweep tries every value up and down by a factor, the next by its root.

    A step counts if it gains more than `least_gain`. `on_step` is called after each value of each sweep.
    """
    best, least = start, judge([start])[0]
    for sweep in range(sweeps):
        step = factor ** (0.5**sweep)
        for move in moves():
            for _ in range(STEPS):
                tried = [move(best, step), move(best, 1.0 / step)]
                values = judge(tried)
                value = min(values)
                if value >= least - least_gain:
                    break
                best, least = tried[values.index(value)], value
            on_step()
    return best


def moves() -> list[Move]:
    """What is searched: variance of the camera, along bones, scale of the process, its 11 groups."""

    def scale(settings: FilterSettings, factor: float) -> FilterSettings:
        process = settings.process
        return replace(settings, process=ProcessNoise.of_groups(process.groups() * factor, held=process.held))

    return [_of_camera("variance"), _of_camera("along"), scale, *(_of_group(name) for name in GROUPS)]


def _of_camera(name: str) -> Move:
    def move(settings: FilterSettings, factor: float) -> FilterSettings:
        return replace(settings, camera=replace(settings.camera, **{name: getattr(settings.camera, name) * factor}))

    return move


def _of_group(name: str) -> Move:
    def move(settings: FilterSettings, factor: float) -> FilterSettings:
        return replace(settings, process=replace(settings.process, **{name: getattr(settings.process, name) * factor}))

    return move
