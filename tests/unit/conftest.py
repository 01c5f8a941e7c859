"""A small session and the recording of it, for whatever reads or writes recordings."""

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import NameOID

from schemas.session import Anthropometry, HubDescription, Placement, SensorDescription, SessionDescription
from schemas.signals import GAIT_EVENT, IMU, JOINT_STATE
from schemas.vocabulary import Segment
from services.archive.disk import Disk
from services.archive.manifest import new_manifest, store, with_files
from services.archive.seal import seal
from services.archive.writer import SessionWriter
from services.flow.message import Envelope, Stream
from services.recordings.record import Record

HUB = Stream(IMU, "hub")
JOINTS = Stream(JOINT_STATE, "estimation")
EVENTS = Stream(GAIT_EVENT, "segmentation")
VERSION = "0.1.0"
STARTED = 1_790_000_000_000_000_000


@pytest.fixture
def description():
    return SessionDescription(
        session="s1",
        title="a walk",
        started_unix_ns=STARTED,
        origin="synthetic",
        protocol="walk",
        estimator="ekf",
        walk_path="turning",
        hubs=[
            HubDescription(
                name="hub",
                sensors=[
                    SensorDescription(
                        name="shank_left",
                        segment=Segment.SHANK_LEFT,
                        rate_hz=100.0,
                        outward_axis=[0.0, 0.0, 1.0],
                        placement=Placement.LATERAL,
                        position_in_segment=None,
                    )
                ],
            )
        ],
        anthropometry=Anthropometry(
            height_m=1.7, mass_kg=70.0, thigh_length_m=0.4, shank_length_m=0.4, hip_width_m=0.2, source="default"
        ),
        standing=[],
        reference=[],
        duration_s=None,
    )


def record(stream, sequence, *, epoch=0, final=False, payload=None, captured_ns=None):
    captured_ns = sequence * 10_000_000 if captured_ns is None else captured_ns
    if payload is None:
        payload = b"" if final else b'{"sensors":[],"n":%d}' % sequence
    return Record(stream, Envelope(epoch, sequence, captured_ns, final), payload, STARTED + captured_ns + 1_000_000)


def walk(count, stream=HUB, first=0):
    return [record(stream, sequence) for sequence in range(first, first + count)]


@pytest.fixture
def tape():
    """Streams and message makers for the tests."""
    return SimpleNamespace(hub=HUB, joints=JOINTS, events=EVENTS, record=record, walk=walk)


@pytest.fixture
def recorded(tmp_path, description):
    """Record messages into a folder; the open files when `closed` is false."""

    def run(messages, *, every=10, closed=True, folder=None, disk=None, **options):
        folder = folder or tmp_path / description.session
        folder.mkdir(exist_ok=True)
        disk = disk or Disk()
        writer = SessionWriter(folder, description, VERSION, disk=disk, **options)
        parts = []
        for place, message in enumerate(messages):
            writer.write(message)
            if place % every == every - 1:
                writer.flush()
                parts += writer.close() if writer.full else []
        writer.flush()
        parts += writer.close()
        if closed:
            entries = [seal(part, "ambula test", disk, 4096) for part in parts]
            manifest = with_files(new_manifest(description, VERSION), [entry for entry in entries if entry])
            store(folder, manifest, disk)
        return folder

    return run


@pytest.fixture(scope="session")
def make_pair(tmp_path_factory):
    """Writes a self-signed certificate and its key; their paths."""

    def make(days=60.0, name="clinic.example", password=None):
        now = datetime.now(UTC)
        folder = tmp_path_factory.mktemp("certificate")
        key = ec.generate_private_key(ec.SECP256R1())
        subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])
        made = (
            x509.CertificateBuilder()
            .subject_name(subject).issuer_name(subject).public_key(key.public_key())
            .serial_number(x509.random_serial_number())
            .not_valid_before(now - timedelta(days=100)).not_valid_after(now + timedelta(days=days))
            .add_extension(x509.SubjectAlternativeName([x509.DNSName(name)]), critical=False)
            .sign(key, hashes.SHA256())
        )  # fmt: skip
        lock = serialization.BestAvailableEncryption(password) if password else serialization.NoEncryption()
        pem, form = serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8
        paths = folder / "certificate.pem", folder / "key.pem"
        paths[0].write_bytes(made.public_bytes(pem))
        paths[1].write_bytes(key.private_bytes(pem, form, lock))
        return paths

    return make
