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

UNCALIBRATED = replace(
    OURS,
    camera=replace(OURS.camera, variance=1.2e-3, along=0.4, inferred=50.0, gate=1.5),
    process=replace(
        OURS.process, hip_flexion=2000.0, hip_adduction=30.0, knee=1500.0, clavicle=10.0, shoulder_rotation=20.0
    ),
    biases_learnt_s=np.inf,
)
"""For a start that is not standing: posture and lengths are those that fit a few frames, offsets and all.

A wrong start turns what the camera gets wrong into fast legs, so the camera is believed less and legs are calmer: as
calm as costs nothing on simulated people who start at the bottom of a squat (the tuning people). Offsets stay free:
only movement tells them there.
"""


def settings_for(*, standing: bool) -> FilterSettings:
    """What a session filters with. The same for every task: settings per task gained nothing worth a choice."""
    return OURS if standing else UNCALIBRATED


PAPER_BIAS = StartNoise(bias_std=(0.037, 0.067, 0.022))
"""Offsets as large as the paper's own camera had."""
