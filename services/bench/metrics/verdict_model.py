"""How far visits are off, measured on the chain, so that hundreds of patients can be drawn instead of simulated.

value = true (1 + b + c (true - first) + w): a person's own error b at the first visit's speed and its slope c over
speed, normal over persons, and w, normal, of the day: mounting, tape, noise, steps. Half an interval, the scatter of
the strides and the grade are drawn from those measured.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from schemas.metrics import Metric
from services.bench.metrics.verdict_visits import Told
from services.progress.points import interval


@dataclass(frozen=True)
class ErrorModel:
    """Errors relative to the speed."""

    mean: tuple[float, float]
    """Over persons: of b, 1, and of c, s/m."""
    covariance: tuple[tuple[float, float], tuple[float, float]]
    """Of b and c over persons."""
    day_sd: float
    templates: tuple[Metric, ...]
    """Measured ones, of which intervals, grades and numbers of strides are taken."""

    def draw(self, rng: np.random.Generator, speeds: Sequence[float]) -> list[Metric]:
        """What the visits of one person say who truly walks at these speeds, m/s."""
        offset, slope = rng.multivariate_normal(self.mean, self.covariance, method="svd")
        own = [offset + slope * (speed - speeds[0]) for speed in speeds]
        return [self._visit(rng, speed, error) for speed, error in zip(speeds, own, strict=True)]

    def change_error(self, before: float, after: float) -> float:
        """m/s, root mean square of the error of a change between two true speeds."""
        gain = after - before
        # value_after - value_before - gain = gain b + after gain c + noise of both days.
        sizes = np.array([gain, after * gain])
        own = float(sizes @ (np.array(self.covariance) + np.outer(self.mean, self.mean)) @ sizes)
        return float(np.sqrt(own + self.day_sd**2 * (before**2 + after**2)))

    def _visit(self, rng: np.random.Generator, speed: float, own: float) -> Metric:
        value = float(speed * (1.0 + own + self.day_sd * rng.standard_normal()))
        template = self.templates[rng.integers(len(self.templates))]
        low, high = interval(template)
        assert template.value is not None
        assert low is not None
        assert high is not None
        scale = value / template.value
        scaled = {
            name: None if old is None else scale * old
            for name, old in (("spread", template.spread), ("mean_std", template.mean_std))
        }
        ends = {"low": scale * low, "high": scale * high}
        return template.model_copy(update={"value": value, **ends, **scaled})


def measured_model(persons: Sequence[Sequence[Told]]) -> ErrorModel:
    """From the visits of several persons, at least three each at two speeds. What told no value says nothing.

    A line of least squares through each person's errors: w from what is left, b and c from the lines; what w alone
    makes of b and c is taken off their covariance as far as it stays positive.
    """
    lines, left, freedom, noises = [], 0.0, 0, []
    for visits in persons:
        told = [(each.speed, each.metric.value / each.speed - 1.0) for each in visits if each.metric.value is not None]
        speeds, errors = np.array(told).T
        design = np.column_stack([np.ones_like(speeds), speeds - visits[0].speed])
        line, *_ = np.linalg.lstsq(design, errors, rcond=None)
        left += float(np.sum((errors - design @ line) ** 2))
        freedom += len(errors) - 2
        lines.append(line)
        noises.append(np.linalg.inv(design.T @ design))
    day = left / freedom
    between = np.cov(np.array(lines).T) - day * np.mean(noises, axis=0)
    values, axes = np.linalg.eigh(between)
    (bb, bc), (_, cc) = (axes @ np.diag(np.clip(values, 0.0, None)) @ axes.T).tolist()
    offset, slope = np.mean(lines, axis=0).tolist()
    templates = tuple(told.metric for visits in persons for told in visits if _is_whole(told.metric))
    return ErrorModel((offset, slope), ((bb, bc), (bc, cc)), day**0.5, templates)


def _is_whole(metric: Metric) -> bool:
    return metric.value is not None and interval(metric)[0] is not None
