"""Everything that can be tuned in the metrics of walking tests: unit, default, where the default comes from."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WalkingTestMetricsParameters:
    """How a corridor and steps are brought together, and what counts as steady."""

    test_time_tolerance_s: float = 1.0
    """s by which a test's end may be missed: a recording that is stopped with the clock."""
    most_corridor_misfit: float = 0.15
    """share by which steps and a declared corridor may differ; beyond it turns were missed, or it was another one."""
    most_length_misfit: float = 0.25
    """share by which the steps of a length may differ from the median; else a turn was missed, or made on the way."""
    most_time_misfit: float = 0.5
    """the same of times, where steps have no length; people slow down."""
    scaled_step_share: float = 0.02
    """share of a way walked by steps that a corridor has scaled."""
    timed_rest_share: float = 0.15
    """share of a way that is known by its time alone."""
    stopping_place_m: float = 0.3
    """m, of where a person turns and stops: to within a foot's length."""
    shortest_length_s: float = 3.0
    """s below which a walk from turn to turn is too short for a speed."""
    steady_share: float = 0.1
    """share of the speed by which both halves of a timed zone may differ in a steady walk (proposal)."""


WALKING_TESTS = WalkingTestMetricsParameters()
