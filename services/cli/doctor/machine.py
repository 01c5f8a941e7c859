"""What the machine must have: Python, space, the page, ports."""

import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

from services.archive.settings import ArchiveSettings
from services.cli.doctor.findings import Finding
from services.ingest.capture.settings import CaptureSettings
from services.ingest.data import find_data_root

LEAST_FREE_BYTES = 5 * 1024**3


def findings() -> Iterator[Finding]:
    """All of them."""
    for check in (_python, _disk, _page, _browser, _recordings, _cameras):
        yield check()


def _python() -> Finding:
    ok = sys.version_info >= (3, 11)
    return Finding("Python", ok, f"{sys.version.split()[0]}" + ("" if ok else "; 3.11 or newer is needed"))


def _disk() -> Finding:
    folder = ArchiveSettings().data_dir
    existing = next(path for path in (folder.resolve(), *folder.resolve().parents) if path.exists())
    free = shutil.disk_usage(existing).free
    if not os.access(existing, os.W_OK):
        return Finding("Disk", False, f"{existing} is not writable; set AMBULA_DATA_DIR to a folder that is")
    says = f"{free / 1024**3:.0f} GiB free for recordings in {folder}"
    ok = free >= LEAST_FREE_BYTES
    return Finding("Disk", ok, says if ok else f"{says}; make room: recording stops at 1 GiB")


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
