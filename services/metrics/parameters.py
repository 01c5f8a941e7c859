"""Everything that can be tuned in the metrics: unit, default, where the default comes from."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MetricsParameters:
    """How many strides or repetitions a number must rest on."""

    least_strides: int = 3
    """strides below which a mean is withheld (proposal; reliable means need 6 of each foot)."""
    least_strides_for_variability: int = 10
    """strides below which standard deviation and CV are withheld as metrics (proposal of the clinical conventions)."""
    least_steady_strides: int = 3
    """steady strides of each foot that is seen, from which on the starting and stopping ones are left out; as many as
    a mean needs."""

    least_repetitions: int = 3
    """repetitions of an exercise below which their numbers are withheld; a line needs as many to have an error."""
    longest_pause_s: float = 10.0
    """s of rest after a repetition beyond which the next one begins another set; prescribed holds and rests within a
    set last 5 to 10 (proposal)."""
    most_repetitions: int = 1000
    """repetitions told one by one; what a message takes."""
    most_phases: int = 500
    """phases of a timed test told one by one; what a message takes."""
