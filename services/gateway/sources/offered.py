"""What the ingests offer to whom."""

from services.gateway.access.scope import EVERYTHING
from services.gateway.context import Gateway
from services.gateway.control import Source
from services.gateway.devices.records import foreign_sources


def offered_sources(gateway: Gateway) -> list[Source]:
    """What the caller may start: a device that another clinic has registered is that clinic's alone.

    Raises ControlUnavailable.
    """
    offered = gateway.control.offered()
    with gateway.database.transaction(EVERYTHING) as database:
        foreign = foreign_sources(database, gateway.known_caller.clinic)
    return [source for source in offered if source.id not in foreign]
