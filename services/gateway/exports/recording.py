"""The recording behind a session: the version of its results that pages and report show."""

from pathlib import Path
from typing import NamedTuple

from schemas.archive_layout import folder_name
from services.exports.recorded import listed_signals
from services.gateway.context import Gateway
from services.gateway.sessions.models import SessionState
from services.gateway.sessions.records import get_session
from services.recordings.folder import derived_versions

RUNS = "the session still runs; stop it or wait for its end"
NOT_RECORDED = "the archive holds no closed recording of this session"


class Recorded(NamedTuple):
    """What the database and the folder's manifest say, without reading the recording itself."""

    session: str
    folder: Path
    version: str | None
    """Of the derived files to read; None: those written live."""
    signals: frozenset[str]
    estimator: str
    trouble: str | None
    """Why nothing can be exported."""

    @property
    def software(self) -> str | None:
        """What computed the results."""
        return None if self.version is None else f"ambula {self.version}"


def recorded(gateway: Gateway, session: str) -> Recorded:
    """Raises a 404 problem for a session that is not known."""
    with gateway.transaction() as database:
        row = get_session(database, session)
        runs = row.state in (SessionState.CREATED, SessionState.LIVE)
        estimator = row.estimator
        shown = None if row.metrics is None else row.metrics.software.removeprefix("ambula ")
    folder = gateway.settings.data_dir / folder_name(session)
    versions = derived_versions(folder) if folder.is_dir() and not folder.is_symlink() else []
    version = shown if shown in versions else next(iter(versions), None)
    signals = listed_signals(folder, version) if versions else frozenset()
    trouble = RUNS if runs else None if versions else NOT_RECORDED
    return Recorded(session, folder, version, signals, estimator, trouble)
