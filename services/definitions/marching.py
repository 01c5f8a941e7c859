"""What each metric of marching on the spot is: what a stride tells of it, under names of its own, and its rhythm."""

from dataclasses import replace

from services.definitions.definition import CV_SUFFIX, PARETIC_RATIO_SUFFIX, RATIO_SUFFIX, SD_SUFFIX, Basis, Definition
from services.definitions.strides import STRIDE_METRICS
from services.definitions.symmetry import PARETIC_RATIOS, RATIOS
from services.definitions.variability import COUNTED, COUNTS, REJECTED, VARIABILITY

MARCHING_PREFIX = "marching_"
_SENTENCES = {
    "stride_time": "Time of a cycle of one leg, from one contact of a foot to its next.",
    "cadence": "Two steps per cycle time.",
    "step_time": "Time from the other foot's contact to this foot's next one.",
    "swing_time": "Time for which a foot is in the air.",
    "hip_flexion_range": "How far the thigh is lifted: largest minus smallest hip flexion of a cycle.",
    "hip_flexion_peak": "Largest hip flexion of a cycle.",
    "knee_flexion_range": "Largest minus smallest knee flexion of a cycle.",
}
"""What is told of marching, and how it is said."""
_RATIOS_OF = ("step_time", "hip_flexion_range", "knee_flexion_range")
_SPREADS_OF = ("stride_time", "step_time")


def _named(definition: Definition, sentence: str | None = None) -> Definition:
    said = definition.sentence if sentence is None else sentence
    return replace(definition, name=MARCHING_PREFIX + definition.name, sentence=said, measure=None)


def _kept() -> dict[str, Definition]:
    kept = {row.name: _named(row, _SENTENCES[row.name]) for row in STRIDE_METRICS if row.name in _SENTENCES}
    suffixes = [*((name, (RATIO_SUFFIX, PARETIC_RATIO_SUFFIX)) for name in _RATIOS_OF)]
    suffixes += [(name, (SD_SUFFIX, CV_SUFFIX)) for name in _SPREADS_OF]
    wanted = {name + suffix for name, both in suffixes for suffix in both}
    rows = [row for row in (*RATIOS, *PARETIC_RATIOS, *VARIABILITY) if row.name in wanted]
    counted = [row for row in COUNTS if row.name in (COUNTED, REJECTED)]
    return kept | {row.name: _named(row) for row in (*rows, *counted)}


KEPT: dict[str, Definition] = _kept()
"""By the name that the same number has in walking."""

RHYTHM = Definition(
    "marching_rhythm_cv",
    "1",
    False,
    "Irregularity of the rhythm by itself: scatter of the difference of successive cycle times of a foot / sqrt(2) / "
    "mean cycle time; a tempo that drifts, with a metronome or without, is not in it.",
    basis=Basis.CONTACTS,
)

MARCHING: tuple[Definition, ...] = (*KEPT.values(), RHYTHM)
"""All metrics of marching; a message has the ratios of one kind."""
