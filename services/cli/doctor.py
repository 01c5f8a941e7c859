"""`ambula doctor`: is everything here that Ambula needs, and if not, what to do."""

import os
import shutil
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from schemas.signals import service_token_key
from services.archive.settings import ArchiveSettings
from services.bus.connection import Bus, BusUnavailable
from services.bus.settings import BusSettings
from services.ingest.capture.settings import CaptureSettings
from services.ingest.data import find_data_root

LEAST_FREE_BYTES = 5 * 1024**3


@dataclass(frozen=True, slots=True)
class Finding:
    """One line of the report. `ok` None: not needed, but it would be nicer."""

    subject: str
    ok: bool | None
    says: str


def examine() -> Iterator[Finding]:
    """All findings about this machine and, when one runs, about the stack."""
    for check in (_python, _disk, _page, _browser, _recordings, _cameras):
        yield check()
    yield from _stack()


def service_is_alive(service: str) -> bool:
    """Whether a service of that name holds its token on the configured router."""
    try:
        with Bus.open(BusSettings(), "doctor") as bus:
            return bool(bus.tokens(service_token_key(bus.settings.site, service, "*")))
    except BusUnavailable:
        return False


def _python() -> Finding:
    ok = sys.version_info >= (3, 11)
    return Finding("Python", ok, f"{sys.version.split()[0]}" + ("" if ok else "; 3.11 or newer is needed"))


def _disk() -> Finding:
    folder = ArchiveSettings().data_dir
    existing = next(path for path in (folder.resolve(), *folder.resolve().parents) if path.exists())
    free = shutil.disk_usage(existing).free
    writable = os.access(existing, os.W_OK)
    says = f"{free / 1024**3:.0f} GiB free for recordings in {folder}"
    if not writable:
        return Finding("Disk", False, f"{existing} is not writable; set AMBULA_DATA_DIR to a folder that is")
    return Finding("Disk", free >= LEAST_FREE_BYTES, says)


def _page() -> Finding:
    from services.gateway.settings import DIST

    built = (DIST / "index.html").exists()
    return Finding("Web page", built, "built" if built else "not built; run `make web`")


def _browser() -> Finding:
    found = shutil.which("chromium")
    return Finding("Chromium", True if found else None, found or "absent: only the browser test needs it")


def _recordings() -> Finding:
    root: Path | None = find_data_root()
    if root is None:
        return Finding("Recordings", None, "none found; set AMBULA_DATA to the folder that holds them")
    return Finding("Recordings", True, str(root))


def _cameras() -> Finding:
    try:
        settings = CaptureSettings()
    except ValueError as error:
        return Finding("Cameras", False, f"AMBULA_SKELETON_HOST, _PORTS or _SENDERS cannot be read: {error}")
    ports = ", ".join(str(port) for port in settings.skeleton_ports) or "none"
    says = f"skeletons are heard on {settings.skeleton_host}, port {ports}"
    if settings.is_open_to_all:
        return Finding("Cameras", None, f"{says}, from any computer; name those that may in AMBULA_SKELETON_SENDERS")
    return Finding("Cameras", True, says)


def _stack() -> Iterator[Finding]:
    settings = BusSettings()
    try:
        with Bus.open(settings, "doctor") as bus:
            for name in ("ingest", "estimation", "segmentation", "metrics", "archive", "gateway"):
                alive = len(bus.tokens(service_token_key(settings.site, name, "*")))
                yield Finding(name, alive > 0, f"{alive} running" if alive else "not running")
    except BusUnavailable:
        yield Finding("Stack", None, f"no router at {settings.router}; `ambula up` starts one")


MARKS: dict[bool | None, str] = {True: "[green]ok[/green]", False: "[red]fix[/red]", None: "[yellow]note[/yellow]"}
