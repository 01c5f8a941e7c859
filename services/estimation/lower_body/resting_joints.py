"""Joints that no sensor tells: they are not valid, and a weak pull draws them to zero."""

from collections.abc import Set

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY, Segment
from services.biomech.lower_body import PARENT_SEGMENT, LowerBodyModel, segment_of
from services.estimation.parameters import FilterParameters


def rest_variances(
    model: LowerBodyModel, parameters: FilterParameters, worn: Set[Segment], unseen: Set[Segment]
) -> NDArray[np.float64]:
    """(3, n) variances of the pull to zero: soft knees always, and every joint below a segment that is not seen.

    Without it the variance of an unseen joint grows without bound. Its heading is left free: zero means nothing.
    """
    p, rest = parameters, np.zeros((3, len(model.dofs)))
    for segment in sorted(unseen):
        is_worn = segment in worn
        position_std, velocity_std = (
            (p.rest_position_std, p.rest_velocity_std) if is_worn else (p.unworn_std, p.unworn_std)
        )
        stds = np.array([[position_std], [velocity_std], [p.rest_acceleration_std]])
        rest[:, model.joints_of(segment)] = stds**2
    if Segment.PELVIS in unseen:
        rest[0, model.first_rotation] = 0.0
    rest[0, model.soft] = p.noise.soft_knee_std**2
    return rest


def valid_without(model: LowerBodyModel, missing: Set[Segment]) -> list[bool]:
    """Per LOWER_BODY dof: both segments of the joint are seen, and the model has the dof."""
    joints = [segment_of(dof) for dof in LOWER_BODY]
    return [
        bool(index >= 0) and not {segment, PARENT_SEGMENT.get(segment, segment)} & missing
        for segment, index in zip(joints, model.reported, strict=True)
    ]
