"""All metrics, in the order of every message, and where each is looked up by its name."""

from services.definitions.definition import Definition
from services.definitions.exercises import EXERCISES
from services.definitions.marching import MARCHING
from services.definitions.repetitions import REPETITIONS
from services.definitions.rhythm import RHYTHMS
from services.definitions.strides import STRIDE_METRICS
from services.definitions.symmetry import OTHER_SYMMETRY, PARETIC_RATIOS, RATIOS
from services.definitions.timed_up_and_go import TUG
from services.definitions.trunk import TRUNK
from services.definitions.variability import COUNTS, VARIABILITY
from services.definitions.walking_tests import WALKING_TESTS

WALK: tuple[Definition, ...] = (
    *STRIDE_METRICS,
    *RATIOS,
    *PARETIC_RATIOS,
    *OTHER_SYMMETRY,
    *VARIABILITY,
    *COUNTS,
    *RHYTHMS,
)
"""Those of walking. A message has the ratios of `symmetry.RATIOS` or, where a paretic side is declared, the others."""

DEFINITIONS: tuple[Definition, ...] = (*WALK, *TRUNK, *REPETITIONS, *EXERCISES, *TUG, *WALKING_TESTS, *MARCHING)
"""Every number that a session can have."""

BY_NAME: dict[str, Definition] = {definition.name: definition for definition in DEFINITIONS}
