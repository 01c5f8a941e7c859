"""REST of health."""

from fastapi import APIRouter

from schemas.health import Health
from services.gateway.access.rules import KNOWN
from services.gateway.context import Context
from services.gateway.health.models import HealthOut, ServiceHealth
from services.gateway.problems import documented

router = APIRouter(prefix="/v1/health", tags=["health"])


@router.get("", dependencies=KNOWN, responses=documented())
def read_health(gateway: Context) -> HealthOut:
    """The latest report of every service, and which needed ones are silent. Always answers."""
    board = gateway.live.health
    return HealthOut(
        **board.brief(),
        database=gateway.database.answers(),
        pages=(gateway.settings.pages_dir / "index.html").exists(),
        services=[_shape(health, age_s, board.is_stale(age_s)) for health, age_s in board.reports()],
    )


def _shape(health: Health, age_s: float, stale: bool) -> ServiceHealth:
    return ServiceHealth(**health.model_dump(), age_s=round(age_s, 2), stale=stale)
