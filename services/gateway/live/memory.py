"""What a viewer who comes late must know of a session: the last of each kind, not all that happened."""

from collections.abc import Iterator

from schemas.vocabulary import Task
from services.gateway.live.views import View


class Memory:
    """Bounded: one view per kind, side or movement, and the phases of one attempt.

    Walks, turns and rests of a six-minute walk follow each other many times: all are kept, for its distance is theirs.
    """

    def __init__(self) -> None:
        self._views: dict[tuple[str, ...], View] = {}

    def __iter__(self) -> Iterator[View]:
        return iter(self._views.values())

    def of(self, kind: str) -> list[View]:
        """What is remembered of one kind."""
        return [view for view in self if view["kind"] == kind]

    def keep(self, view: View) -> None:
        """Remember a view in place of the one before it, if it is of a kind that matters later."""
        match view["kind"]:
            case "metrics" | "calibration" | "data_quality" as kind:
                self._views[kind,] = view
            case "stride":
                self._views["stride", view["side"]] = view
            case "repetition":
                self._views["repetition", view["degree_of_freedom"], view["side"] or ""] = view
            case "task_phase":
                self._keep_phase(view)

    def newest_phases(self, count: int) -> list[View]:
        """The last phases that began."""
        return self.of("task_phase")[-count:]

    def _keep_phase(self, view: View) -> None:
        newest = max((each["attempt"] for each in self.of("task_phase")), default=view["attempt"])
        if view["attempt"] > newest:
            self._views = {key: each for key, each in self._views.items() if each["kind"] != "task_phase"}
        if view["attempt"] >= newest:
            self._views[self._phase_key(view)] = view

    def _phase_key(self, view: View) -> tuple[str, ...]:
        kind = ("task_phase", view["phase"])
        if view["task"] != Task.SIX_MINUTE_WALK:
            return kind
        for key, each in self._views.items():
            if key[:2] == kind and (each["end_s"] is None or each["start_s"] == view["start_s"]):
                return key
        return (*kind, str(view["start_s"]))
