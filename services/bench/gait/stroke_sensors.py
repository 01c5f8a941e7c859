"""A stroke survivor on the treadmill: feet and lower back, each alone, against the shanks.

The shanks' own events are 15 to 20 ms uncertain, so only detection and gross bias are judged. Tuned on.
"""

import numpy as np

from schemas.vocabulary import GaitEventKind, Segment, Side
from services.bench.gait.detections import Times, detection, detection_rows
from services.bench.gait.strides import ESTIMATOR, STROKE, through_chain
from services.bench.gait.voisard import BACK, FEET
from services.bench.scoreboard import Row, informative
from services.ingest.errors import SourceError

SHANKS = frozenset({Segment.SHANK_LEFT, Segment.SHANK_RIGHT})


def stroke_sensor_rows() -> list[Row]:
    """Strides and detection by feet and by the back; one row that says why without the data."""
    try:
        by_shanks = through_chain(STROKE, ESTIMATOR, SHANKS).found
        alone = {
            "feet": through_chain(STROKE, ESTIMATOR, FEET).found,
            "back": through_chain(STROKE, ESTIMATOR, BACK).found,
        }
    except SourceError as missing:
        return [Row("stroke: skipped", None, "", str(missing), None, None)]
    true: Times = {(side, kind): np.sort(by_shanks.times_s(side, kind)) for side in Side for kind in GaitEventKind}
    rows: list[Row] = []
    for name, found in alone.items():
        for side in Side:
            ours, theirs = (sum(s.side is side for s in run.strides) for run in (found, by_shanks))
            rows.append(informative(f"stroke, {name}: strides {side}; beside it by the shanks", ours, "", theirs))
        for kind in GaitEventKind:
            title = f"stroke, {name}, {kind.value.replace('_', ' ')} against the shanks"
            rows += detection_rows(title, [detection(true, found, kind)])
    return rows
