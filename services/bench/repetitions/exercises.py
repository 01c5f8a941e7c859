"""The synthetic exercises that are scored, and when their repetitions truly begin, turn and end."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.ingest.synthetic.knee_flexion import SyntheticKnee
from services.ingest.synthetic.knee_plan import TrueRepetition
from services.ingest.synthetic.parameters import KneeParameters
from services.segmentation.repetitions.parameters import RepetitionParameters

Array = NDArray[np.float64]

ONSET_SHARE = RepetitionParameters().onset_share
STEP_S = 0.002

HARD = "tremor=0.04&jitter=0.1&hesitations=0.2&partials=0.15&fatigue=0.4&slowing=0.3&set_of=8&rest=6"
EXERCISES = {
    "seated extension": "exercise=1",
    "seated extension, held 5 s": "exercise=1&tempo=6&hold=5&breath=2&duration=120",
    "seated extension, hard": f"exercise=1&{HARD}",
    "heel slides": "exercise=2&tempo=8&duration=120",
    "heel slides, hard": f"exercise=2&tempo=8&duration=150&{HARD}",
    "squats": "exercise=3",
    "squats, hard": f"exercise=3&{HARD}",
    "cycling, slow": "exercise=4&tempo=40",
    "cycling, fast": "exercise=4&tempo=90&tremor=0.03",
    "sit to stand": "exercise=5",
    "sit to stand, held 2 s": "exercise=5&tempo=8&hold=2&breath=2",
}
"""Options of `synthetic:knee` by name. Hard: tremor, hesitations, partial repetitions, fatigue and sets."""

SCORED_SEEDS = range(300, 400)
"""Seeds below 300 were looked at while the rules and their parameters were chosen."""


class Truth(NamedTuple):
    """One repetition: s, rad. Start and end are where the exact speed passes the share that defines them."""

    start_s: float
    turn_s: float
    end_s: float
    reach: float
    is_partial: bool


def exercise(options: str) -> SyntheticKnee:
    """The session of `synthetic:knee?{options}`."""
    return SyntheticKnee(KneeParameters.parse(options))


def truths(session: SyntheticKnee) -> list[Truth]:
    """Its repetitions, without the tremor."""
    calm = SyntheticKnee(replace(session.dials, tremor=0.0))
    return [_truth(calm, repetition) for repetition in calm.repetitions]


def _truth(session: SyntheticKnee, repetition: TrueRepetition) -> Truth:
    time_s = np.arange(repetition.start_s, repetition.end_s, STEP_S)
    knee = session.strides(time_s).posture[f"knee_flexion_{session.side}"]
    away, speed = np.abs(knee.value - knee.value[0]), np.abs(knee.rate)
    reached = np.flatnonzero(away >= away.max() - 1e-6)
    turn = int(reached[0] + reached[-1]) // 2
    out, back = speed[: turn + 1], speed[turn:]
    start = int(np.argmax(out >= ONSET_SHARE * out.max()))
    end = turn + int(np.flatnonzero(back >= ONSET_SHARE * back.max())[-1])
    reach = float(knee.value.max() - knee.value.min())
    return Truth(
        float(time_s[start]), float(time_s[turn]), float(time_s[end]), reach, repetition.is_partial
    )  # fmt: skip
