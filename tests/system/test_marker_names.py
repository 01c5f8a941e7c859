"""A whole session over real processes with names that are easily found: nowhere but where they belong (R19, R20).

They belong into the sealed directory of names, and a login into its account. What is looked through: logs, every key
and payload on the bus, every answer with its headers, recordings, the inside of PDF and zip files, databases,
temporary files.
"""

import io
import json
import time
import urllib.error
import zipfile
from urllib.parse import quote

import pytest
from mcap.reader import make_reader
from pypdf import PdfReader
from sqlalchemy import MetaData, create_engine, select

from services.bus.connection import Bus
from services.bus.settings import BusSettings
from services.cli.door import Door
from services.cli.supervisor import Supervisor
from tests.system.pages import SERVICES, free_port

pytestmark = pytest.mark.system

NAME, RECORD, LOGIN, PASSWORD = "Erika Markername", "RN-Markerrecord", "markerlogin", "a Markerpassword of 3 words"
MARKERS = ("markername", "markerrecord", "markerlogin", "markerpassword")
WALK = "synthetic:walk?speed=1.2&seed=11&duration=24"
PATIENCE_S = 120


def found(where, data):
    """Where a marker is, in whatever case."""
    text = (data if isinstance(data, bytes) else str(data).encode()).lower()
    return [f"{where}: {marker}" for marker in MARKERS if marker.encode() in text]


class Listening:
    """Every key on the bus, and whether a marker was ever in a payload."""

    def __init__(self, bus):
        self.keys, self.hits = set(), []
        bus.subscribe("ambula/**", self._hear)
        bus.watch_tokens("ambula/**", lambda key, alive: self.keys.add(key))

    def _hear(self, received):
        self.keys.add(received.key)
        self.hits += found(received.key, received.payload)


class Visitor(Door):
    """Somebody who signs in, and remembers every answer with its address and headers."""

    def __init__(self, url):
        super().__init__(url)
        self.hits, self.addresses = [], []

    def get(self, path):
        address = f"{self.url}{path}"
        self.addresses.append(address)
        with self._opener.open(address, timeout=60) as answer:
            body = answer.read()
            self.hits += found(f"headers of {path}", answer.headers)
            self.hits += inside(path, body)
        return body


def inside(where, body):
    """Markers in a body, also within a PDF or a zip."""
    hits = found(where, body)
    if body.startswith(b"%PDF"):
        reader = PdfReader(io.BytesIO(body))
        hits += found(f"{where} metadata", reader.metadata) + found(f"{where} XMP", reader.trailer["/Root"])
        hits += [hit for page in reader.pages for hit in found(f"{where} text", page.extract_text())]
    if body.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(body)) as archive:
            for name in archive.namelist():
                hits += found(f"{where}: name {name}", name) + inside(f"{where}: {name}", archive.read(name))
    return hits


def in_recordings(folder):
    hits = []
    for file in folder.rglob("*.mcap"):
        with file.open("rb") as opened:
            reader = make_reader(opened)
            for metadata in reader.iter_metadata():
                hits += found(file.name, metadata)
            for schema, channel, message in reader.iter_messages():
                hits += found(f"{file.name} {channel.topic}", message.data) + found(file.name, (schema, channel))
    return hits


def in_files(folder):
    """Markers in names and bytes of files; those of the main database are looked at by table."""
    hits = []
    for file in folder.rglob("*"):
        hits += found("name of a file", file.name)
        if file.is_file() and not file.name.startswith("ambula.sqlite"):
            hits += found(file.name, file.read_bytes())
    return hits


def tables_with_markers(folder):
    engine = create_engine(f"sqlite:///{folder}/ambula.sqlite")
    tables = MetaData()
    tables.reflect(engine)
    with engine.connect() as connection:
        held = {each.name: found(each.name, connection.execute(select(each)).all()) for each in tables.sorted_tables}
    engine.dispose()
    return {name: hits for name, hits in held.items() if hits}


def until(condition, what):
    end = time.monotonic() + PATIENCE_S
    while not (value := condition()):
        assert time.monotonic() < end, what
        time.sleep(0.1)
    return value


def finished(door, data, session):
    manifest = data / session / "manifest.json"
    told = door.ask(f"sessions/{session}")["state"] == "finished"
    return told and manifest.exists() and json.loads(manifest.read_text())["state"] == "finished"


def everything_about(visitor, code, session):
    """Read whatever there is to be read."""
    for path in ("", "/name", "/visits", "/progress", "/treatments", "/export"):
        visitor.get(f"/v1/patients/{code}{path}") if path != "/name" else visitor.ask(f"patients/{code}/name")
    for path in (
        "",
        "/metrics",
        "/curves",
        "/report",
        "/report.html",
        "/report.pdf",
        "/recordings",
        "/fhir",
        "/versions",
    ):
        visitor.get(f"/v1/sessions/{session}{path}")
    for each in json.loads(visitor.get(f"/v1/sessions/{session}/exports"))["items"]:
        if each["available"]:
            visitor.get(f"/v1/sessions/{session}/exports/{each['format']}")
    for each in json.loads(visitor.get(f"/v1/sessions/{session}/recordings")):
        visitor.get(f"/v1/sessions/{session}/recordings/{each['name']}")
    for path in ("/v1/patients", "/v1/sessions", "/v1/health", "/v1/audit", "/v1/audit/export", "/metrics"):
        visitor.get(path)
    visitor.get("/v1/audit/export?format=fhir")


def make_mistakes(visitor, code):
    """What people type where it does not belong."""
    wrong = (
        ("sign-in", {"login": LOGIN, "password": f"{PASSWORD}!"}, None),
        (f"patients/{code}/name", {"name": NAME, "surname": NAME}, "PUT"),
        ("patients", {"name": NAME}, None),
        (f"patients/{quote(NAME)}", None, None),
        (f"sessions/{quote(NAME)}/metrics", None, None),
        (f"patients/{code}/erasure", {"reason": NAME}, None),
    )
    for path, body, method in wrong:
        with pytest.raises(urllib.error.HTTPError) as refused:
            visitor.ask(path, body, method)
        visitor.hits += found(f"refusal of {method or 'POST'} {path.partition('/')[0]}", refused.value.read())


def test_names_are_nowhere_but_where_they_belong(tmp_path):
    data, temporary, port, logs = tmp_path / "data", tmp_path / "temporary", free_port(), []
    temporary.mkdir()
    environment = {
        "AMBULA_HTTP_HOST": "127.0.0.1", "AMBULA_HTTP_PORT": str(port), "AMBULA_DATA_DIR": str(data),
        "AMBULA_DATABASE": "", "TMPDIR": str(temporary),
    }  # fmt: skip
    settings, url = BusSettings(router=f"tcp/127.0.0.1:{free_port()}"), f"http://127.0.0.1:{port}"
    with Supervisor(SERVICES, settings, environment, output=logs.append) as stack, Bus.open(stack.settings, "t") as bus:
        listening = Listening(bus)
        stack.wait_until_ready(timeout_s=180)
        first = Door.of_first_administrator(url, data, PATIENCE_S)
        first.ask("accounts", {"login": LOGIN, "role": "admin", "password": PASSWORD})
        visitor = Visitor(url)
        visitor.ask("sign-in", {"login": LOGIN, "password": PASSWORD})

        code = visitor.ask("patients", {"year_of_birth": 1957})["code"]
        visitor.ask(f"patients/{code}/name", {"name": NAME, "record_number": RECORD}, "PUT")
        assert [each["code"] for each in visitor.ask("directory/search", {"text": "MARKERNAME"})["items"]] == [code]
        started = visitor.ask("sessions", {"source": WALK, "speed": None, "patient": code})
        session = started["id"]
        until(lambda: finished(visitor, data, session), "the session is recorded")
        everything_about(visitor, code, session)
        make_mistakes(visitor, code)

        assert visitor.hits == []
        assert found("addresses", visitor.addresses) == []
        assert (found("keys", sorted(listening.keys)), listening.hits) == ([], [])
        assert any(f"/{session}/" in key for key in listening.keys), "the bus was listened to"
        assert in_recordings(data) == []
        assert list(data.rglob("*.mcap")), "something was recorded"
        assert in_files(tmp_path) == []
        assert tables_with_markers(data).keys() == {"account"}

        erased = visitor.ask(f"patients/{code}/erasure", {"reason": "requested_by_patient"})
        assert erased == {"sessions": 1, "recordings_left": 0}
        assert not (data / session).exists()
        assert visitor.ask("audit/verification")["intact"]
    assert [hit for line in logs for hit in found("log", line)] == []
    assert any("serving" in line for line in logs), "the logs were listened to"
    assert list(temporary.iterdir()) == []
