"""`ambula up`: every service as a child process, one router, one page to open."""

import time

from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import live
from services.cli.console import err, out
from services.cli.door import ACCOUNT_FILE, Door
from services.cli.supervisor import Supervisor
from services.gateway.accounts.first_run import code_file
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
        gateway = GatewaySettings()
        out.print(f"\n  Open  [bold]{gateway.url}[/bold]  in a browser. Ctrl-C stops everything.")
        _tell_how_to_sign_in(gateway, demo=demo)
        if demo:
            _start_demo(stack.settings)
        stack.run(seconds)
    return 0


def _tell_how_to_sign_in(gateway: GatewaySettings, *, demo: bool) -> None:
    if demo:
        try:
            Door.of_first_administrator(gateway.url, gateway.data_dir)
            login, password = (gateway.data_dir / ACCOUNT_FILE).read_text(encoding="utf-8").split()
            out.print(f"  Sign in as  [bold]{login}[/bold]  with  [bold]{password}[/bold]\n")
        except PermissionError:
            out.print("  Sign in with your account.\n")
    elif code_file(gateway.data_dir).exists():
        code = code_file(gateway.data_dir).read_text(encoding="utf-8").strip()
        out.print(f"  Nobody has an account yet. The code for the first administrator is  [bold]{code}[/bold]\n")


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
