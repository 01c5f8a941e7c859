"""Which further states run beside the filter's own, and what decides between them (`kernels/companions.py`)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import Segment
from services.biomech.kernels.fixed import LANES, Width
from services.biomech.kernels.tables import Companions
from services.biomech.lower_body import LowerBodyModel, SensorMount, segment_of
from services.biomech.single_joint.innovation_gate import InnovationGate

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CompanionModel:
    """What runs beside the filter. By default nothing, at no cost.

    shares: of the filter's process noise, one for each further state, each bolder than the one before.
    joints: names of the degrees of freedom that a bolder state may decide; all others stay the filter's own.
    judges: whose gyroscopes decide about a joint: the 'segment' it moves, its whole 'leg', or the whole 'body'.
    rate_hz: of the samples; a share of the noise is a part of the correction that depends on it.
    """

    shares: tuple[float, ...] = ()
    joints: tuple[str, ...] = ()
    judges: Literal["segment", "leg", "body"] = "segment"
    gate: InnovationGate = field(default_factory=InnovationGate)
    rate_hz: float = 100.0


def companion_tables(
    model: LowerBodyModel,
    mounts: Sequence[SensorMount],
    companions: CompanionModel,
    jerk_density: float,
    gyro_std: float,
    width: Width,
) -> Companions:
    """Tables and scratch of the kernels; all states at rest at zero. Noise as in NoiseModel."""
    C, n, S, M = len(companions.shares), len(model.dofs), len(mounts), LANES * len(width)
    groups = _groups(companions.judges)
    member = np.array([[float(mount.segment in group) for mount in mounts] for group in groups])
    gate = companions.gate
    part, decided = np.ones((C, 3, n)), _decided(model, companions.joints, groups)
    for c, share in enumerate(companions.shares):
        part[c, 1:, decided >= 0] = smaller_parts(jerk_density, gyro_std, 1.0 / companions.rate_hz, share)
    return Companions(
        x=np.zeros((C, 3, n)),
        jerk=np.zeros((C, n)),
        part=part,
        group=decided,
        member=member.reshape(len(groups), S),
        evidence=np.zeros((C, len(groups), 2)),
        weight=np.zeros((C, len(groups))),
        estimate=np.zeros((3, n)),
        gate=np.array([gate.memory_s, gate.doubt, gate.refusal]),
        innovation=np.zeros((C, S, 6)),
        heading=np.zeros((C, 3)),
        virtual_innovation=np.zeros((C, 6)),
        dx=np.zeros((C, M)),
        squared=np.zeros((C + 1, S)),
        y=np.zeros(6),
    )


def smaller_parts(jerk_density: float, gyro_std: float, dt_s: float, share: float) -> tuple[float, float]:
    """Gains of velocity and acceleration with `share` of the process noise, as parts of those with all of it.

    Steady gains of a velocity measured with gyro_std and driven by white jerk are those of the alpha-beta filter
    (Kalata 1984): with L = sigma_jerk dt^2 / gyro_std and r = (4 + L - sqrt(8 L + L^2)) / 4, alpha = 1 - r^2 and
    beta = 2 (2 - alpha) - 4 sqrt(1 - alpha) = 2 (1 - r)^2.
    """
    index = math.sqrt(jerk_density / dt_s) * dt_s**2 / gyro_std
    all_of_it, less = (_alpha_beta_root(index * math.sqrt(s)) for s in (1.0, share))
    return (1.0 - less**2) / (1.0 - all_of_it**2), ((1.0 - less) / (1.0 - all_of_it)) ** 2


def _alpha_beta_root(index: float) -> float:
    return (4.0 + index - math.sqrt(8.0 * index + index * index)) / 4.0


def _groups(judges: str) -> list[set[Segment]]:
    legs = [{Segment.THIGH_RIGHT, Segment.SHANK_RIGHT}, {Segment.THIGH_LEFT, Segment.SHANK_LEFT}]
    if judges == "leg":
        return legs
    if judges == "body":
        return [legs[0] | legs[1] | {Segment.PELVIS}]
    return [{segment} for leg in legs for segment in sorted(leg)]


def _decided(model: LowerBodyModel, joints: Sequence[str], groups: list[set[Segment]]) -> NDArray[np.int64]:
    group = np.full(len(model.dofs), -1, dtype=np.int64)
    for j, dof in enumerate(model.dofs):
        if dof.name in joints:
            group[j] = next((g for g, segments in enumerate(groups) if segment_of(dof) in segments), -1)
    return group
