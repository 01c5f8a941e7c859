"""Estimators of one knee by name."""

from services.biomech.worn_legs import WornLeg
from services.estimation.knee.band import OurBand, PublishedBand
from services.estimation.knee.estimator import KneeEstimator
from services.estimation.knee.found_axis import FoundAxis
from services.estimation.knee.published_axis import PublishedAxis
from services.estimation.parameters import KneeParameters


def estimator_of(name: str, leg: WornLeg, parameters: KneeParameters) -> KneeEstimator:
    """The estimator of one leg.

    Raises:
        ValueError: the name is none, or the estimator cannot work with what is worn; says what to do.
    """
    if name == "knee_axis":
        return FoundAxis(leg.sensors, parameters)
    if name == "knee_axis_mcgrath":
        return PublishedAxis(leg.sensors, parameters)
    if name == "knee_band":
        return OurBand(leg.sensors)
    if name == "knee_band_grover":
        return PublishedBand(leg.sensors)
    raise ValueError(f"estimation has no knee estimator {name!r}")
