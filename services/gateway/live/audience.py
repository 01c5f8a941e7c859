"""Who has a live connection open, counted per clinic: for monitoring, which must not know who they are."""

from collections import Counter

from services.gateway.live.viewer import Viewer


class Audience:
    """Written on the event loop; read from any thread, as whole counts."""

    def __init__(self) -> None:
        self._open: set[Viewer] = set()
        self._skipped: Counter[str] = Counter()

    def join(self, viewer: Viewer) -> Viewer:
        """A connection was opened; the viewer."""
        self._open.add(viewer)
        return viewer

    def leave(self, viewer: Viewer) -> None:
        """It was closed; what its browser was too slow for still counts."""
        self._open.discard(viewer)
        self._skipped[_clinic(viewer)] += viewer.skipped

    def sizes(self) -> dict[str, int]:
        """Open connections of each clinic."""
        return dict(Counter(_clinic(viewer) for viewer in self._open.copy()))

    def skipped(self) -> dict[str, int]:
        """Skeletons and lists that were out of date before a browser of that clinic took them."""
        total = self._skipped.copy()
        for viewer in self._open.copy():
            total[_clinic(viewer)] += viewer.skipped
        return dict(total)


def _clinic(viewer: Viewer) -> str:
    return viewer.scope.clinic or ""
