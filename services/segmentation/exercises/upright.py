"""What upright is for a person: from there a lean to either side is a repetition of its own."""

from statistics import median

from services.flow.node import State
from services.segmentation.exercises.parameters import ExerciseParameters


class Upright:
    """The lean at which a person rests. Takes the lean at increasing times, rad."""

    def __init__(self, parameters: ExerciseParameters) -> None:
        self._parameters = parameters
        self._first: float | None = None
        self._rests: list[float] = []
        self._since: tuple[int, float] | None = None
        self._sum, self._count, self._told = 0.0, 0, False

    @property
    def lean(self) -> float:
        """rad, positive to the right; 0 before the first rest."""
        return median(self._rests) if self._rests else 0.0

    def take(self, captured_ns: int, lean: float) -> None:
        """One sample. A rest is told once, by its mean, when it has lasted long enough."""
        p = self._parameters
        if self._since is None or abs(lean - self._since[1]) > p.upright_band:
            self._since, self._sum, self._count, self._told = (captured_ns, lean), 0.0, 0, False
        self._sum += lean
        self._count += 1
        if self._told or captured_ns - self._since[0] < p.upright_s * 1e9:
            return
        self._told, mean = True, self._sum / self._count
        if self._first is None and abs(mean) <= p.upright_first:
            self._first = mean
        # Against the first one: against the last, small leans would drag it along step by step.
        if self._first is not None and abs(mean - self._first) <= p.upright_later:
            self._rests = [*self._rests, mean][-p.upright_memory :]

    def interrupt(self) -> None:
        """Samples are missing."""
        self._since = None

    def snapshot(self) -> State:
        """Everything that changes."""
        return {
            "first": self._first,
            "rests": list(self._rests),
            "since": None if self._since is None else list(self._since),
            "sum": self._sum,
            "count": self._count,
            "told": self._told,
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        since = state["since"]
        self._first, self._rests = state["first"], list(state["rests"])
        self._since = None if since is None else (since[0], since[1])
        self._sum, self._count, self._told = state["sum"], state["count"], state["told"]
