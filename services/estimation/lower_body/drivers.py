"""What the rhythm of the joints `channels` drives, by the name of the estimator."""

from services.biomech.companions import CompanionModel
from services.biomech.lower_body import LowerBodyModel
from services.biomech.rhythm.reading import RhythmEstimator
from services.estimation.parameters import FilterParameters


def companions_of(
    estimator: str, parameters: FilterParameters, channels: tuple[str, ...], rate_hz: float
) -> CompanionModel:
    """The rhythm drives a state beside the plain filter's; the published oscillator drives the filter itself."""
    if estimator != "rhythmic_ekf":
        return CompanionModel()
    shares = (1.0, parameters.calm_share) if parameters.calm_share < 1.0 else (1.0,)
    return CompanionModel(shares, channels, parameters.judges, parameters.gate, rate_hz)


def driver_of(
    estimator: str, model: LowerBodyModel, rhythm: RhythmEstimator, channels: tuple[str, ...]
) -> tuple[RhythmEstimator | None, list[int]]:
    """Whose jerk the filter is fed, and for which joints."""
    if estimator == "ekf":
        return None, []
    if estimator == "rhythmic_ekf":
        return rhythm, [model.names.index(name) for name in channels]
    if estimator in ("rhythmic_ekf_joukov", "joukov_published"):
        from services.biomech.rhythm.joukov import JoukovOscillator

        # The right knee comes first: its error drives the phase; every joint has its own harmonics.
        first = model.names.index("knee_flexion_right")
        joints = [first] + [j for j in range(model.first_rotation, len(model.dofs)) if j != first]
        return JoukovOscillator(len(joints)), joints
    raise ValueError(f"estimation has no estimator {estimator!r}")
