"""Named settings of the filter, and what stands behind each."""

from dataclasses import replace

import numpy as np

from services.biomech.whole_body.constrained_ekf import OURS, FilterSettings
from services.biomech.whole_body.parameters import (
    NO_PRIORS,
    CameraNoise,
    ProcessNoise,
    StartNoise,
)

PUBLISHED_VARIANCE = 0.0052
"""m^2, average measurement variance of the paper (section 3.4)."""

PUBLISHED_CAMERA = CameraNoise(
    variance=PUBLISHED_VARIANCE, along=0.0, inferred=1.0, stretch=0.0, gate=0.0, swap_share=0.0
)
"""One constant R, whatever the camera says of a centre."""

FLAT_PROCESS = ProcessNoise.of_groups(np.full(11, 100.0))
"""The same white jerk for every coordinate: what can be said without any recording."""

CORRECTED = FilterSettings(
    PUBLISHED_CAMERA, FLAT_PROCESS, NO_PRIORS, constrained=True, margin=0.0, lengths_learnt_s=np.inf
)
"""The paper's filter with its constraint put right, and nothing else of ours."""

UNCONSTRAINED = FilterSettings(PUBLISHED_CAMERA, FLAT_PROCESS, NO_PRIORS, constrained=False, lengths_learnt_s=np.inf)

UNCALIBRATED = FilterSettings(replace(PUBLISHED_CAMERA, swap_share=CameraNoise().swap_share), FLAT_PROCESS, NO_PRIORS)
"""For a start that is not standing: neither lengths nor offsets nor the rest posture are known.

Then a calm filter with one large variance jumps least: gate and tracking state would doubt what contradicts a wrong
start. Chosen with a recorded squat in view that starts low; there is no reference for it.
"""


def settings_for(*, standing: bool) -> FilterSettings:
    """What a session filters with. The same for every task: settings per task gained nothing worth a choice."""
    return OURS if standing else UNCALIBRATED


PAPER_BIAS = StartNoise(bias_std=(0.037, 0.067, 0.022))
"""Offsets as large as the paper's own camera had."""
