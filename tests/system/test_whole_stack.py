"""All services as real processes over Zenoh on loopback: same numbers as a plain loop, whatever is killed."""

import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from schemas.metrics import SessionMetrics
from schemas.session import SessionDescription
from services.archive.reader import open_recording
from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli import live
from services.cli.assembly import build_chain
from services.cli.supervisor import Supervisor
from services.flow.message import Message, encode_payload
from services.ingest.source import iter_messages, open_source

pytestmark = pytest.mark.system

WALK = "synthetic:walk?speed=1.2&seed=11&duration=24"
SERVICES = ["archive", "estimation", "segmentation", "metrics", "ingest"]


@dataclass
class Stack:
    supervisor: Supervisor
    settings: BusSettings
    data: Path

    def play(self, spec: str, speed: float | None, disturb=None) -> SessionDescription:
        """Play a source to its final metrics; `disturb(supervisor)` runs once a third of it is done."""
        with Bus.open(self.settings, "test") as bus:
            description = live.start_session(bus, spec, speed, "rhythmic_ekf")
            deadline = time.monotonic() + 90
            for news in live.follow(bus, description):
                assert time.monotonic() < deadline
                if isinstance(news, SessionMetrics):
                    return description
                if disturb is not None and news > description.duration_s / 3:
                    disturb(self.supervisor)
                    disturb = None
        raise AssertionError("the session never ended")

    def archived(self, session: str) -> dict[str, list[Message]]:
        """The archived messages by stream, once the archive has sealed the session."""
        folder = self.data / session
        deadline = time.monotonic() + 30
        while list(folder.glob("*.part")) or not (folder / "manifest.json").exists():
            assert time.monotonic() < deadline, sorted(folder.iterdir())
            time.sleep(0.1)
        streams: dict[str, list[Message]] = {}
        for message in open_recording(folder).messages():
            streams.setdefault(message.stream.name, []).append(message)
        return streams


@pytest.fixture(scope="module")
def stack(tmp_path_factory, free_router):
    data = tmp_path_factory.mktemp("recordings")
    settings = BusSettings(router=free_router)
    with Supervisor(SERVICES, settings, environment={"AMBULA_DATA_DIR": str(data)}) as supervisor:
        supervisor.wait_until_ready(timeout_s=120)
        yield Stack(supervisor, settings, data)


def plain_loop(spec: str) -> dict[str, list[bytes]]:
    source = open_source(spec, estimator="rhythmic_ekf")
    chain = build_chain(source.describe())
    streams: dict[str, list[bytes]] = {}
    for message in iter_messages(source):
        for one in [message, *chain.push(message)]:
            if not one.envelope.final:
                streams.setdefault(one.stream.name, []).append(encode_payload(one.payload))
    return streams


def same_as_plain_loop(stack: Stack, description: SessionDescription, spec: str) -> None:
    expected, archived = plain_loop(spec), stack.archived(description.session)
    hub = description.hubs[0].name
    for name in (f"imu/{hub}", "reference/reference", "calibration/estimation", "joint_state/estimation",
                 "rhythm/estimation", "gait_event/segmentation", "stride/segmentation", "metrics/metrics"):  # fmt: skip
        messages = [message for message in archived[name] if not message.envelope.final]
        assert [message.envelope.sequence for message in messages] == list(range(len(expected[name]))), name
        assert [encode_payload(message.payload) for message in messages] == expected[name], name
    assert "gap/archive" not in archived


def test_live_services_give_the_numbers_of_a_plain_loop(stack):
    same_as_plain_loop(stack, stack.play(WALK, None), WALK)


@pytest.mark.parametrize("victim", ["estimation", "segmentation", "metrics", "archive"])
def test_nothing_is_lost_when_a_service_is_killed(stack, victim):
    description = stack.play(WALK, 3.0, disturb=lambda supervisor: supervisor.kill(victim))
    same_as_plain_loop(stack, description, WALK)


def test_two_patients_at_once_equal_each_alone(stack):
    other = "synthetic:walk?speed=0.8&seed=12&duration=24"
    with Bus.open(stack.settings, "test") as bus:
        descriptions = [live.start_session(bus, spec, 4.0, "rhythmic_ekf") for spec in (WALK, other)]
        for description in descriptions:
            assert any(isinstance(news, SessionMetrics) for news in live.follow(bus, description))
    same_as_plain_loop(stack, descriptions[0], WALK)
    same_as_plain_loop(stack, descriptions[1], other)
