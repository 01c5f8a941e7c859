"""The whole filter on synthetic walks in the report."""

from collections.abc import Sequence

import numpy as np
from rich.progress import Progress

from services.bench.joukov.sections import Section
from services.bench.joukov.walk_curves import WalkCurves
from services.bench.joukov.walks import NOTE, SEED, WalkStudies, study_walks, walk_charts, walk_rows


def study_seed(number: int) -> WalkStudies:
    """Everything on the walks of one seed, the first being 0."""
    return study_walks(Progress(disable=True), [SEED + number])


def merged(studies: Sequence[WalkStudies]) -> WalkStudies:
    """The walks of several seeds together."""
    curves = [
        WalkCurves(
            of_kind[0].kind, {name: np.concatenate([c.errors[name] for c in of_kind]) for name in of_kind[0].errors}
        )
        for of_kind in zip(*(study.curves for study in studies), strict=True)
    ]
    falls = [fall for study in studies for fall in study.falls]
    bands = [band for study in studies for band in study.bands]
    return WalkStudies(curves, falls, bands, studies[0].skipped)


def walks_section(studies: Sequence[WalkStudies]) -> Section:
    """Curves over S, disturbed walks, and whether the published deviations are true."""
    paragraphs = [
        f"{len(studies)} synthetic walks of each kind (seeds {SEED} and on; gate, third state and judges were chosen "
        "on seeds below 1000) pass the whole filter: steady ones at 50 Hz with noise and 2 deg of soft tissue, ones "
        "whose strides differ as recorded strides do, and ones that stop, turn, stumble or sit down. " + NOTE,
        "Where the stride does not go on, no quantity of any run may be more than 2 % worse than the plain filter's. "
        "Between 90 and 99 % of the truth is to lie within twice the published standard deviation.",
    ]
    together = merged(studies)
    return Section("The whole filter on synthetic walks", paragraphs, walk_rows(together), (), walk_charts(together))
