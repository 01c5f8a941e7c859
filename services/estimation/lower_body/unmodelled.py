"""What no filter on worn sensors can know, as deviations of the joints."""

import numpy as np
from numpy.typing import NDArray

from services.biomech.bones import SEGMENTS
from services.biomech.lower_body import PARENT_SEGMENT, LowerBodyModel
from services.estimation.parameters import UnmodelledErrors

Array = NDArray[np.float64]


def unmodelled_deviations(model: LowerBodyModel, errors: UnmodelledErrors) -> Array:
    """(2, n) rad and rad/s that no covariance knows of, of every degree of freedom of the model."""
    tissue = {"pelvis": errors.soft_tissue_pelvis, "thigh": errors.soft_tissue_thigh, "shank": errors.soft_tissue_shank}
    gravity = {"pelvis": 0.0, "thigh": errors.gravity_thigh, "shank": errors.gravity_shank}
    result = np.zeros((2, len(model.dofs)))
    for segment in SEGMENTS:
        kinds = {part.partition("_")[0] for part in (segment, PARENT_SEGMENT.get(segment, segment))}
        moved = sum(tissue[kind] ** 2 for kind in kinds)
        result[:, model.joints_of(segment)] = [
            [np.sqrt(moved + sum(gravity[kind] ** 2 for kind in kinds))],
            [errors.soft_tissue_rate * np.sqrt(moved)],
        ]
    return result
