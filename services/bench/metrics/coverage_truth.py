"""What a synthetic patient truly walks like: every metric of a long walk, from the footfalls and angles as planned."""

import numpy as np
from numpy.typing import NDArray

from schemas.gait import CURVE_POINTS, Stride, StrideCurve
from schemas.metrics import Metric
from schemas.vocabulary import Side
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.footfalls import LATERAL, Footfall
from services.ingest.synthetic.patients.walk import PatientWalk
from services.metrics.parameters import MetricsParameters
from services.metrics.session_totals import SessionTotals

Array = NDArray[np.float64]

LONG_S = 160.0
"""s of the walk that is taken for how the person walks; the sessions that are measured are a quarter of it."""
RATE_HZ = 100.0


def true_metrics(query: str) -> dict[tuple[str, str | None], float]:
    """Values by name and side, of the person of `patient=hemiparetic&speed=0.6&seed=3`."""
    walk = PatientWalk(WalkParameters.parse(f"{query}&duration={LONG_S:g}&tape=0&soft_tissue=0"))
    totals = SessionTotals(walk.description().conditions.paretic_side)
    for stride in true_strides(walk):
        totals.add(stride)
    metrics: list[Metric] = totals.metrics(MetricsParameters())
    return {(metric.name, metric.side): metric.value for metric in metrics if metric.value is not None}


def true_strides(walk: PatientWalk) -> list[Stride]:
    """In order of their ends, bout by bout."""
    time_s = np.arange(0.0, walk.parameters.duration, 1.0 / RATE_HZ)
    body = walk.body(time_s)
    paths = {side: body.ankle(side).position[:, [0, 2]] for side in Side}
    angles = {name: jet.value for name, jet in body.angles.items()}
    strides = []
    for bout in walk.footfalls.bouts:
        for number in range(1, len(bout) - 3):
            strides.append(_stride(walk, bout[number : number + 3], time_s, angles, paths, number // 2))
    return strides


def _stride(
    walk: PatientWalk, falls: list[Footfall], time_s: Array, angles: dict[str, Array], paths: dict[Side, Array], k: int
) -> Stride:
    start, opposite, end = falls
    before = max(
        (one for one in walk.footfalls.by_side[start.side.other] if one.contact_s < start.contact_s),
        key=lambda one: one.contact_s,
    )
    lasted = end.contact_s - start.contact_s
    at = np.linspace(start.contact_s, end.contact_s, CURVE_POINTS)
    curves = {name: np.interp(at, time_s, curve) for name, curve in angles.items()}
    return Stride(
        side=start.side,
        index=k,
        start_ns=_ns(start.contact_s),
        toe_off_ns=_ns(start.toe_off_s),
        opposite_contact_ns=_ns(opposite.contact_s),
        opposite_toe_off_ns=_ns(before.toe_off_s),
        end_ns=_ns(end.contact_s),
        stride_time_s=lasted,
        stance_fraction=(start.toe_off_s - start.contact_s) / lasted,
        step_time_s=end.contact_s - opposite.contact_s,
        step_length_m=end.forward - opposite.forward,
        step_length_std_m=0.0,
        stride_length_m=end.forward - start.forward,
        walking_speed=(end.forward - start.forward) / lasted,
        step_width_m=None,
        circumduction_m=_circumduction(
            start, end, np.column_stack([np.interp(at, time_s, c) for c in paths[start.side].T])
        ),
        turn=0.0,
        phase_advance=None,
        turning=False,
        valid=True,
        rejected_because=None,
        curves={name: StrideCurve(position=curve.tolist(), position_std=0.0) for name, curve in curves.items()},
    )


def _circumduction(start: Footfall, end: Footfall, path: Array) -> float:
    """m, largest outward distance of the ankle from the line between its two places."""
    along = np.array([end.forward - start.forward, end.aside - start.aside])
    to_the_right = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    return max(0.0, float((LATERAL[start.side] * (path - path[0]) @ to_the_right).max()))


def _ns(seconds: float) -> int:
    return round(seconds * 1e9)
