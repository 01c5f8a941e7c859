"""A running site is backed up, goes on, dies, and is put back elsewhere: everything is there that was, and nobody who
was erased meanwhile."""

import hashlib
import os
import subprocess
import sys
import urllib.error
from pathlib import Path

import pytest

from services.recordings.folder import session_folders, verify
from tests.system import pages
from tests.system.stage import wait_until

pytestmark = pytest.mark.system

WALK = "synthetic:walk?duration=6&seed=2"


def ambula(data: Path, *words: str, router: str = "tcp/127.0.0.1:1", port: int = 1) -> subprocess.CompletedProcess[str]:
    """Run a command as whoever looks after the site does."""
    environment = {
        **os.environ, "AMBULA_DATA_DIR": str(data), "AMBULA_DATABASE": "", "AMBULA_ROUTER": router,
        "AMBULA_HTTP_PORT": str(port), "COLUMNS": "400",
    }  # fmt: skip
    command = [sys.executable, "-m", "services.cli", *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)


def walked(site: pages.Site, patient: str) -> str:
    """A patient's walk, as fast as the services follow, closed by the archive; its session."""
    wish = {"source": WALK, "speed": None, "patient": patient}
    session = str(site.door.ask("sessions", wish)["id"])

    def is_kept() -> bool:
        files = site.door.ask(f"sessions/{session}/recordings")
        return bool(files) and all(each["sha256"] for each in files)

    wait_until(is_kept, timeout_s=pages.PATIENCE_S)
    return session


def test_a_site_that_died_is_put_back_and_who_was_erased_stays_erased(tmp_path: Path) -> None:
    old, kept, new = tmp_path / "old", tmp_path / "backup", tmp_path / "new"
    with pages.open_site(old) as site:
        stays, goes = (str(site.door.ask("patients", {"year_of_birth": 1957})["code"]) for _ in range(2))
        walk, erased = walked(site, stays), walked(site, goes)
        running = site.door.ask("sessions", {"source": "synthetic:walk?duration=600", "speed": 1.0})["id"]
        wait_until(lambda: list((old / running).glob("*.part")), timeout_s=pages.PATIENCE_S)
        made = ambula(old, "backup", str(kept))
        assert made.returncode == 0, made.stderr
        assert not list(kept.rglob("*.part"))
        password = (old / "demo-account").read_text().split()[1]
        site.door.ask("sign-in/confirmation", {"password": password})
        site.door.ask(f"patients/{goes}/erasure", {"reason": "requested_by_patient"})
        wait_until(lambda: not (old / erased).exists(), timeout_s=pages.PATIENCE_S)
        later = walked(site, stays)
        refused = ambula(old, "restore", str(kept), "--replace", router=site.supervisor.settings.router)
        assert refused.returncode == 1
        assert "Stop the services first" in refused.stderr
        for service in site.supervisor.services:
            site.supervisor.kill(service)

    told = ambula(new, "restore", str(kept), "--erasures", str(old / "erasures.jsonl"))
    assert told.returncode == 0, told.stderr
    assert "erased again: 3" in told.stdout, "a patient, a session and its recording"
    healthy = ambula(new, "doctor", "--deep")
    assert "chain whole" in healthy.stdout
    sums = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in (old / walk).glob("*.mcap")}
    assert sums == {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in (new / walk).glob("*.mcap")}
    assert [fault for folder in session_folders(new) if folder.name != running for fault in verify(folder)] == []
    assert not (new / erased).exists()

    (new / "demo-account").write_bytes((old / "demo-account").read_bytes())
    with pages.open_site(new, ["archive", "gateway"]) as site:
        assert site.door.ask(f"sessions/{walk}")["patient"] == stays
        assert {each["name"]: each["sha256"] for each in site.door.ask(f"sessions/{walk}/recordings")} == sums
        assert site.door.ask(f"sessions/{walk}/metrics")["final"]
        for gone in (f"patients/{goes}", f"sessions/{erased}", f"sessions/{later}"):
            with pytest.raises(urllib.error.HTTPError, match="404"):
                site.door.ask(gone)
