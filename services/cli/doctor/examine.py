"""All checks, one after the other."""

from collections.abc import Iterator

from services.cli.doctor import machine, stack, stored
from services.cli.doctor.clock import examine_clock
from services.cli.doctor.findings import Finding
from services.gateway.settings import GatewaySettings


def examine(*, deep: bool = False) -> Iterator[Finding]:
    """All findings about this machine, what it keeps and, when one runs, about the stack."""
    yield from machine.findings()
    yield examine_clock()
    try:
        settings = GatewaySettings()
    except ValueError as error:
        yield Finding("Settings", False, f"AMBULA_ variables cannot be read: {error}")
        return
    yield from stored.findings(settings, deep=deep)
    yield from stack.findings(settings)
