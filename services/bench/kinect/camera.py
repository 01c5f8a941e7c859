"""The simulated cameras of the scoreboard: one of a clinic, and one with offsets as large as the paper's had."""

import numpy as np
from numpy.typing import NDArray

from services.bench.kinect.motions import Trial
from services.ingest.synthetic.whole_body.body import Placed
from services.ingest.synthetic.whole_body.camera import AS_THE_PAPER_HAD, CLINIC, Seen
from services.ingest.synthetic.whole_body.camera import see as see_placed
from services.ingest.synthetic.whole_body.programme import RATE_HZ

KINDS = {"clinic": CLINIC, "paper": AS_THE_PAPER_HAD}


def offset_std(kind: str) -> NDArray[np.float64]:
    """(3,) m, constant offset of a centre among people: depth, height, sideways."""
    return np.array(KINDS[kind].offset_std)


def see(trial: Trial, person: int, kind: str = "clinic") -> Seen:
    """The trial as seen; a person's offsets are the same in all tasks."""
    rng = np.random.default_rng([person, trial.task, 5])
    return see_placed(Placed(trial.centres, trial.carriers), rng, (person,), KINDS[kind], RATE_HZ)
