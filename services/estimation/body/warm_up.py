"""Compile what runs per frame before the first frame comes."""

from dataclasses import replace

import numpy as np

from services.biomech.rhythm.trusted import TrustedRhythm
from services.biomech.whole_body.model import MODEL
from services.biomech.whole_body.parameters import MEAN_STATURE, REST_DEG, lengths_of, per_angle
from services.estimation.body.frames import Frame
from services.estimation.body.parameters import BodyParameters
from services.estimation.body.tracker import BodyTracker
from services.estimation.parameters import EstimationParameters
from services.estimation.rows import RHYTHM_CHANNELS

PERIOD_NS = 33_333_333


def warm_up() -> None:
    """Let an imagined person stand for a second, go away and come back, and one of whom nothing is known begin."""
    q = np.concatenate([np.zeros(3), per_angle(REST_DEG)[:, 0]])
    centres, state = MODEL.centres(q, lengths_of(MEAN_STATURE)), np.full(15, 2, dtype=np.int64)
    for wait_s in (BodyParameters().wait_s, 0.0):
        tracker = BodyTracker("body_cekf", None, replace(BodyParameters(), wait_s=wait_s))
        times = [k * PERIOD_NS for k in (*range(36), 60, 61)]
        for captured_ns in times:
            tracker.take(Frame(captured_ns, 1, 1, centres, state))
    rhythm = TrustedRhythm(len(RHYTHM_CHANNELS), EstimationParameters().filter.rhythm)
    rhythm.step(np.zeros(len(RHYTHM_CHANNELS)), 0.01)
