"""What Prometheus reads."""

from fastapi import APIRouter, Response
from prometheus_client import CONTENT_TYPE_LATEST, generate_latest

from services.gateway.access.roles import Permission
from services.gateway.access.rules import needs
from services.gateway.context import Context
from services.gateway.problems import documented

router = APIRouter(tags=["monitoring"])

TEXT = {"content": {"text/plain": {"schema": {"type": "string"}}}, "description": "Prometheus text format"}


@router.get(
    "/metrics",
    dependencies=[needs(Permission.OPERATE)],
    response_class=Response,
    responses={**documented(), 200: TEXT},
)
def read_numbers(gateway: Context) -> Response:
    """Numbers about the services, for Prometheus. None is about a patient, a session or an account."""
    return Response(generate_latest(gateway.numbers), media_type=CONTENT_TYPE_LATEST)
