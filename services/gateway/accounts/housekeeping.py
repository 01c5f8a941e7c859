"""Sign-ins that nobody can use any more are removed."""

import logging
from datetime import UTC, datetime

from services.bus.logs import event
from services.gateway.access import sign_ins
from services.gateway.access.scope import EVERYTHING
from services.gateway.database import Database
from services.gateway.parameters import GatewayParameters

log = logging.getLogger(__name__)


def forget_expired_sign_ins(database: Database, parameters: GatewayParameters) -> int:
    """Remove those that have expired; their number."""
    with database.transaction(EVERYTHING) as session:
        gone = sign_ins.forget_expired(session, datetime.now(UTC), parameters)
    if gone:
        log.info(event("sign_ins_expired", number=gone))
    return gone
