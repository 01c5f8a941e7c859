"""REST of a session's results by software version."""

from http import HTTPStatus

from fastapi import APIRouter

from services.gateway.access.rules import READ
from services.gateway.context import Context, SessionId
from services.gateway.problems import documented
from services.gateway.recordings.folder import list_recordings
from services.gateway.sessions.records import get_session
from services.gateway.versions.models import VersionsOut
from services.gateway.versions.records import former_metrics
from services.gateway.versions.shapes import versions_out

router = APIRouter(prefix="/v1/sessions/{session}/versions", tags=["sessions"])


@router.get("", dependencies=READ, responses=documented(HTTPStatus.NOT_FOUND))
def list_versions(session: SessionId, gateway: Context) -> VersionsOut:
    """The session's results by the software that computed them, and what changed from each to the current one.

    A difference here is another algorithm, not another patient. `ambula reprocess --store` adds a result.
    """
    files = [each.path.name for each in list_recordings(gateway.settings.data_dir, session)]
    with gateway.transaction() as database:
        row = get_session(database, session)
        return versions_out(session, row.metrics, former_metrics(database, session), files)
