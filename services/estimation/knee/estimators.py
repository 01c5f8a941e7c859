"""Estimators of one knee by name."""

from services.estimation.knee.estimator import KneeEstimator
from services.estimation.knee.found_axis import FoundAxis
from services.estimation.knee.worn_legs import WornLeg
from services.estimation.parameters import KneeParameters


def estimator_of(name: str, leg: WornLeg, parameters: KneeParameters) -> KneeEstimator:
    """The estimator of one leg. Raises ValueError for a name that is none."""
    if name == "knee_axis":
        return FoundAxis(leg.sensors, parameters)
    raise ValueError(f"estimation has no knee estimator {name!r}")
