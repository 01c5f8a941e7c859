"""For whom a threshold or a reference was measured, in the words that both sides of a comparison use."""

from enum import StrEnum


class Population(StrEnum):
    """Groups of people that published thresholds are for."""

    HEALTHY = "healthy"
    STROKE_SUBACUTE = "stroke_subacute"
    STROKE_CHRONIC = "stroke_chronic"
    PARKINSON = "parkinson"
    MULTIPLE_SCLEROSIS = "multiple_sclerosis"
    SPINAL_CORD_INJURY = "spinal_cord_injury"
    KNEE_OSTEOARTHRITIS = "knee_osteoarthritis"
    OTHER = "other"


class Sex(StrEnum):
    """As published reference values are divided."""

    FEMALE = "female"
    MALE = "male"
