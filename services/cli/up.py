"""`ambula up`: every service as a child process, one router, one page to open."""

import time
from typing import Self

from services.bus.settings import BusSettings
from services.cli.console import err, out
from services.cli.demo import start as start_demo
from services.cli.door import ACCOUNT_FILE, Door
from services.cli.supervisor import Supervisor
from services.gateway.accounts.first_run import code_file
from services.gateway.settings import GatewaySettings

SERVICES = ["archive", "estimation", "segmentation", "metrics", "gateway", "ingest"]


def run_stack(*, demo: bool, seconds: float | None) -> int:
    """Start, serve until Ctrl-C (or for so many seconds), stop in order. Exit code."""
    settings = BusSettings()
    with Supervisor(SERVICES, settings) as stack:
        with _Progress() as progress:
            stack.wait_until_ready(timeout_s=300, tell=progress.tell)
        gateway = GatewaySettings()
        out.print(f"\n  Open  [bold]{gateway.url}[/bold]  in a browser. Ctrl-C stops everything.")
        door = _tell_how_to_sign_in(gateway, demo=demo)
        if demo:
            start_demo(stack.settings, gateway, door)
        stack.run(seconds)
    return 0


class _Progress:
    """A line that says what is waited for; on a terminal it moves, elsewhere each news is a line of its own."""

    def __init__(self) -> None:
        self._began = time.monotonic()
        self._said = ""
        self._status = err.status("starting the services ...")

    def __enter__(self) -> Self:
        self._status.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._status.stop()

    def tell(self, missing: list[str], compiling: list[str]) -> None:
        said = f"starting {', '.join(missing)}"
        if compiling:
            said = f"{' and '.join(compiling)} being compiled, about a minute and a half on a first start"
        if not err.is_terminal and said != self._said:
            err.print(f"{said} ...", highlight=False)
        self._said = said
        self._status.update(f"{said} ... {time.monotonic() - self._began:.0f} s")


def _tell_how_to_sign_in(gateway: GatewaySettings, *, demo: bool) -> Door | None:
    """The way in of the account that was made for the demo; None when there is none."""
    if demo:
        try:
            door = Door.of_first_administrator(gateway.url, gateway.own_dir, certificate=gateway.http_certificate)
            login, password = (gateway.own_dir / ACCOUNT_FILE).read_text(encoding="utf-8").split()
            out.print(f"  Sign in as  [bold]{login}[/bold]  with  [bold]{password}[/bold]\n")
            return door
        except PermissionError:
            out.print("  Sign in with your account.\n")
    elif code_file(gateway.own_dir).exists():
        code = code_file(gateway.own_dir).read_text(encoding="utf-8").strip()
        out.print(f"  Nobody has an account yet. The code for the first administrator is  [bold]{code}[/bold]\n")
    return None
