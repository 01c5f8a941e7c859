"""What the documentation names exists, and what exists is named."""

import re
from pathlib import Path

import pytest
import typer.main

from schemas.signals import SIGNALS
from services.bench.registry import SCOREBOARDS
from services.cli.__main__ import app

ROOT = Path(__file__).parents[2]
READMES = sorted(path for path in ROOT.rglob("README.md") if not {".venv", "node_modules"} & set(path.parts))
COMMANDS = set(typer.main.get_command(app).commands)
TARGETS = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))


@pytest.mark.parametrize("path", READMES, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_in_readmes_exist(path):
    text = path.read_text()
    for command in re.findall(r"(?:^|`|\s)ambula ([a-z][a-z-]*)", text):
        assert command in COMMANDS, f"there is no `ambula {command}`"
    for target in re.findall(r"(?:^|`)make ([a-z-]+)", text, re.MULTILINE):
        assert target in TARGETS or target.startswith("bench-"), f"there is no `make {target}`"
    for board in re.findall(r"ambula bench ([a-z_]+)", text):
        assert board in SCOREBOARDS, f"there is no scoreboard {board}"


@pytest.mark.parametrize("path", READMES, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_in_readmes_lead_somewhere(path):
    for link in re.findall(r"\]\(([^)#:]+)\)", path.read_text()):
        assert (path.parent / link).exists(), link


def test_every_command_is_in_the_readme():
    text = (ROOT / "README.md").read_text()
    missing = [command for command in COMMANDS if f"ambula {command}" not in text]
    assert not missing


def test_every_signal_is_in_the_picture_of_the_services():
    text = (ROOT / "services" / "README.md").read_text()
    assert [signal.name for signal in SIGNALS if f"`{signal.name}`" not in text] == []


def test_no_machine_path_or_registry_in_text():
    pattern = re.compile(r"/(home|root|Users)/\w|pypi\.org|registry\.npmjs|deb\.debian")
    for path in [
        *READMES,
        ROOT / "Makefile",
        *ROOT.glob("requirements*.lock"),
        *ROOT.glob("services/gateway/web/*.json"),
    ]:
        assert not pattern.search(path.read_text()), path
