"""`ambula up`: every service as a child process, one router, one page to open."""

import time

from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import live
from services.cli.console import err, out
from services.cli.supervisor import Supervisor
from services.gateway.settings import GatewaySettings
from services.ingest.errors import SourceError
from services.ingest.source import open_source

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]
DEMO_SOURCES = (
    "synthetic:walk?speed=1.15&seed=1&duration=900",
    "synthetic:walk?speed=0.7&asymmetry=0.25&seed=2&duration=900",
    "synthetic:knee?exercise=1&seed=2&duration=900",
    "synthetic:tug?worn=1&seed=4&attempts=20",
    "synthetic:squat?person=2&repetitions=240",
    "neura_s02_walk",
)


def run_stack(*, demo: bool, seconds: float | None) -> int:
    """Start, serve until Ctrl-C (or for so many seconds), stop in order. Exit code."""
    settings = BusSettings()
    with Supervisor(SERVICES, settings) as stack:
        out.print("starting the services (the first start compiles the filters: up to two minutes) ...")
        stack.wait_until_ready(timeout_s=180)
        out.print(f"\n  Open  [bold]{GatewaySettings().url}[/bold]  in a browser. Ctrl-C stops everything.\n")
        if demo:
            _start_demo(stack.settings)
        stack.run(seconds)
    return 0


def _start_demo(settings: BusSettings) -> None:
    with Bus.open(settings, "demo") as bus:
        for spec in DEMO_SOURCES:
            try:
                open_source(spec)
            except SourceError as error:
                err.print(f"  not shown: {spec} ({error})", highlight=False)
                continue
            description = live.start_session(bus, spec, 1.0)
            out.print(f"  live: {description.title}")
            time.sleep(0.1)
