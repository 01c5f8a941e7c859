"""Makers of trials and visits of one made-up patient."""

from datetime import UTC, datetime, timedelta

from schemas.conditions import Conditions
from schemas.gait import CURVE_POINTS
from schemas.metrics import MeanCurve, Metric, SessionMetrics, SideComparison, TrustGrade
from schemas.vocabulary import Side, Task
from services.progress.visits import Trial, in_visits

FIRST_DAY = datetime(2026, 9, 1, 9, tzinfo=UTC)
SAID = {"aid": "none", "orthosis": "none", "footwear": "shoes", "speed_instruction": "comfortable"}
TEN_METRES = SAID | {"start": "walking", "timed_from_m": 2.0, "timed_to_m": 8.0}


def metric(number, half=0.02, name="walking_speed", side=None, unit="m/s", **changes) -> Metric:
    fields = {
        "name": name, "side": side, "unit": unit, "value": number, "spread": None, "mean_std": half / 1.96,
        "low": None if number is None else number - half, "high": None if number is None else number + half,
        "strides": 30, "grade": TrustGrade.GOOD, "doubts": [], "withheld_because": None,
    }  # fmt: skip
    return Metric(**(fields | changes))


def comparison(rmse, joint="knee_flexion", std=0.005) -> SideComparison:
    return SideComparison(
        joint=joint, reference_side=Side.RIGHT, rmse=rmse, rmse_std=std, rmse_about_mean=rmse, shift=0.0, strides=20
    )


def curve(name, level) -> MeanCurve:
    return MeanCurve(degree_of_freedom=name, strides=20, mean=[level] * CURVE_POINTS, spread=[0.01] * CURVE_POINTS)


def results(*metrics, sides=(), curves=(), software="ambula 0.1.0") -> SessionMetrics:
    return SessionMetrics(
        captured_ns=60_000_000_000, final=True, software=software, metrics=list(metrics), curves=list(curves),
        sides=list(sides),
    )  # fmt: skip


def trial(session, day, *metrics, hours=0.0, **changes) -> Trial:
    fields = {
        "session": session,
        "began": FIRST_DAY + timedelta(days=day, hours=hours),
        "task": Task.WALK,
        "conditions": Conditions.model_validate(SAID),
        "walkway_m": None,
        "walk_path": "turning",
        "estimator": "rhythmic_ekf",
        "sensors": ("pelvis:lateral", "shank_left:lateral", "shank_right:lateral"),
        "leg_length_m": 0.81,
        "lengths_from": "measured",
        "datum": "quiet standing",
        "metrics": results(*metrics),
    }
    return Trial(**(fields | changes))


def speeds(*values, half=0.02, **changes):
    """One walk every second week."""
    return in_visits(trial(f"s{k}", 14 * k, metric(value, half), **changes) for k, value in enumerate(values))


def said(**changes) -> Conditions:
    return Conditions.model_validate(SAID | changes)
