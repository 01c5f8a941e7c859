"""The shape that the README promises: same face for every process, same names everywhere."""

import ast
import re
from pathlib import Path

import pytest
import yaml

from schemas.signals import SIGNALS

ROOT = Path(__file__).parents[2]
SERVICES = ROOT / "services"
PROCESSES = sorted(path.parent.name for path in SERVICES.glob("*/__main__.py") if path.parent.name != "cli")
NODES = ("estimation", "segmentation", "metrics")
CODE = sorted(path for top in ("services", "schemas") for path in (ROOT / top).rglob("*.py"))
BANNED = {"utils", "util", "helpers", "helper", "common", "misc", "manager"}


def compose() -> dict:
    """What runs by itself; services of a profile are run by hand."""
    services = yaml.safe_load((ROOT / "compose.yaml").read_text())["services"]
    return {name: service for name, service in services.items() if "profiles" not in service}


def test_every_process_is_here():
    assert sorted(["ingest", "estimation", "segmentation", "metrics", "archive", "gateway"]) == PROCESSES


@pytest.mark.parametrize("process", PROCESSES)
def test_a_process_has_the_same_face_as_its_siblings(process):
    folder = SERVICES / process
    assert (folder / "README.md").exists()
    assert len((folder / "__main__.py").read_text().splitlines()) < 30


@pytest.mark.parametrize("node", NODES)
def test_a_node_keeps_its_tunables_apart(node):
    assert (SERVICES / node / "node.py").exists()
    assert (SERVICES / node / "parameters.py").exists()


def test_compose_runs_exactly_the_processes():
    ours = {name: service for name, service in compose().items() if name not in ("router", "database")}
    assert sorted(ours) == PROCESSES
    for name, service in ours.items():
        assert service["command"] == ["python", "-m", f"services.{name}"]
        assert service["healthcheck"]["test"] == ["CMD", "ambula", "doctor", "--service", name]
        assert service["environment"]["AMBULA_ROUTER"] == "tcp/router:7447"


def test_compose_keeps_the_database_off_the_bus():
    services = compose()
    assert services["database"]["networks"] == ["database"]
    assert [name for name in PROCESSES if "database" in services[name].get("networks", [])] == ["gateway"]


def test_compose_shares_recordings_with_one_writer():
    mounts = {
        name: mount for name in PROCESSES for mount in compose()[name].get("volumes", []) if "recordings:" in mount
    }
    assert [name for name, mount in mounts.items() if not mount.endswith(":ro")] == ["archive"]


def test_compose_has_no_password_in_the_environment():
    text = (ROOT / "compose.yaml").read_text()
    assert "PASSWORD:" not in text
    assert "database_password" in compose()["gateway"]["secrets"]
    for service in compose().values():
        values = service.get("environment", {}).values()
        assert not [value for value in values if re.search(r"://[^/@]+:[^/@]+@", str(value))]


def test_the_gateway_of_compose_writes_its_own_folder_alone():
    gateway = compose()["gateway"]
    own = gateway["environment"]["AMBULA_GATEWAY_DIR"]
    assert [mount for mount in gateway["volumes"] if not mount.endswith(":ro")] == [f"gateway:{own}"]


def test_every_producer_is_a_process():
    assert {signal.producer for signal in SIGNALS if not signal.producer.startswith("every ")} <= set(PROCESSES)


def test_router_of_compose_has_no_discovery():
    text = (ROOT / "docker" / "router.json5").read_text()
    assert "multicast: { enabled: false }" in text
    assert "gossip: { enabled: false }" in text


@pytest.mark.parametrize("path", CODE, ids=lambda path: str(path.relative_to(ROOT)))
def test_module(path):
    assert path.stem not in BANNED
    assert path.parent.name not in BANNED
    tree = ast.parse(path.read_text())
    assert ast.get_docstring(tree), "a module says in one line what it holds"
    assert not re.search(r"\b(TODO|FIXME|XXX)\b", path.read_text())


def test_packages_stay_out_of_docker_and_tests():
    assert not list((ROOT / "tests").rglob("__init__.py")) + list((ROOT / "docker").rglob("__init__.py"))
