"""What is kept: the database, recordings, the audit, keys and the certificate."""

from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from schemas.archive_layout import RecordingState
from services.archive.lock import DataFolderLock, DataFolderUnusable
from services.cli.doctor.findings import Finding
from services.gateway import revisions
from services.gateway.access.scope import EVERYTHING
from services.gateway.accounts.first_run import code_file
from services.gateway.audit.heads import Heads, HeadsUnusable
from services.gateway.audit.verification import verify as verify_audit
from services.gateway.certificate import CertificateError, read_pair
from services.gateway.database import Database, DatabaseError
from services.gateway.settings import GatewaySettings
from services.recordings.folder import read_manifest, segment_files, session_folders
from services.recordings.folder import verify as verify_recording

WARN_DAYS = 14
MOST_NAMED = 3
OTHERS = 0o077
SECRETS = Path("/run/secrets")
STILL_OPEN = (RecordingState.RECORDING, RecordingState.STOPPED)


def findings(settings: GatewaySettings, *, deep: bool) -> Iterator[Finding]:
    """All of them; `deep` reads every recording to compare its checksum."""
    schema = examine_schema(settings)
    yield schema
    if schema.ok:
        yield examine_audit(settings)
    yield examine_archive(settings.data_dir, deep=deep)
    yield examine_first_run(settings)
    yield from examine_keys(settings)
    yield examine_certificate(settings)


def examine_schema(settings: GatewaySettings) -> Finding:
    """Whether the database's schema is the code's."""
    if not settings.database and not (settings.data_dir / "ambula.sqlite").exists():
        return Finding("Database", None, "none yet; the gateway makes it at its first start")
    try:
        revision, newest = revisions.present(settings.database_url), revisions.newest()
    except DatabaseError as error:
        return Finding("Database", False, str(error))
    if revision == newest:
        return Finding("Database", True, f"schema {revision}")
    if revision is None or revision in revisions.known():
        steps = f"schema {revision or 'none'}, the software's is {newest}"
        return Finding("Database", None, f"{steps}: make a backup, then start the gateway, which brings it up to date")
    return Finding(
        "Database", False, f"schema {revision} is of a newer version than this one ({newest}); install that version"
    )


def examine_audit(settings: GatewaySettings) -> Finding:
    """Whether the audit's chain is whole and ends where it was signed."""
    database = Database(settings.database_url)
    try:
        heads = Heads(settings.own_dir).read()
        with database.transaction(EVERYTHING) as session:
            verdict = verify_audit(session, heads)
    except HeadsUnusable as error:
        return Finding("Audit", False, str(error))
    finally:
        database.close()
    if verdict.broken is not None:
        return Finding(
            "Audit",
            False,
            f"broken at entry {verdict.broken}: {verdict.fault}; keep everything as it is, compare with a backup",
        )
    signed = "" if verdict.signed is None else f", signed on {verdict.signed.at.date()}"
    return Finding("Audit", True, f"{verdict.entries} entries, chain whole{signed}")


def examine_archive(data_dir: Path, *, deep: bool) -> Finding:
    """Whether recordings are closed and are what their manifests say: by size, or `deep` by checksum."""
    folders = session_folders(data_dir)
    live = _is_recording(data_dir)
    wrong = [fault for folder in folders for fault in _faults(folder, deep=deep)]
    if wrong:
        shown = "; ".join(wrong[:MOST_NAMED]) + (f"; {len(wrong) - MOST_NAMED} more" if len(wrong) > MOST_NAMED else "")
        return Finding("Archive", False, f"{len(folders)} sessions; {shown}")
    unclosed = [] if live else [folder for folder in folders if _is_open(folder)]
    if unclosed:
        says = f"{len(unclosed)} of {len(folders)} sessions were not closed; start the archive, which closes them"
        return Finding("Archive", None, says)
    how = "checksums right" if deep else "sizes right; --deep compares checksums"
    return Finding("Archive", True, f"{len(folders)} sessions, all closed files there, {how}")


def _is_open(folder: Path) -> bool:
    manifest = read_manifest(folder)
    return manifest is None or manifest.state in STILL_OPEN or any(name.part for name, _ in segment_files(folder))


def _faults(folder: Path, *, deep: bool) -> Iterator[str]:
    manifest = read_manifest(folder)
    if manifest is None:
        return
    if deep:
        yield from (f"{folder.name}: {fault}" for fault in verify_recording(folder))
        return
    for entry in manifest.files:
        path = folder / entry.name
        if not path.exists():
            yield f"{folder.name}: {entry.name} is missing; restore it from a backup"
        elif path.stat().st_size != entry.size_bytes:
            yield f"{folder.name}: {entry.name} has another size than when it was closed; restore it from a backup"


def _is_recording(data_dir: Path) -> bool:
    """An archive holds the folder: what is open there is being written."""
    if not data_dir.is_dir():
        return False
    try:
        with DataFolderLock(data_dir):
            return False
    except DataFolderUnusable:
        return True


def examine_first_run(settings: GatewaySettings) -> Finding:
    """Whether anybody who can read the code may still become the first administrator."""
    file = code_file(settings.own_dir)
    if not file.exists():
        return Finding("First run", True, "closed")
    if file.stat().st_mode & OTHERS:
        return Finding("First run", False, f"{file} can be read by others; `chmod 600 {file}`, then use it soon")
    return Finding("First run", None, f"open: nobody has an account; the code is in {file}")


def examine_keys(settings: GatewaySettings) -> Iterator[Finding]:
    """Keys that only their owner may read."""
    key = settings.directory_key
    if not key.exists():
        yield Finding("Directory key", True, "none: no names are kept")
    else:
        yield private("Directory key", key)
    if settings.http_key is not None and settings.http_key.exists():
        yield private("Page's key", settings.http_key)


def private(subject: str, file: Path) -> Finding:
    """Whether a file is its owner's alone. Secrets of a container are nobody else's, whatever their mode says."""
    if file.is_relative_to(SECRETS):
        return Finding(subject, True, f"{file}, a secret of this container")
    if file.stat().st_mode & OTHERS:
        return Finding(subject, False, f"{file} can be read by others; `chmod 600 {file}`")
    return Finding(subject, True, f"{file}, readable by its owner alone")


def examine_certificate(settings: GatewaySettings) -> Finding:
    """Whether browsers will take the page's certificate, and for how long."""
    certificate, key = settings.http_certificate, settings.http_key
    if certificate is None or key is None:
        alone = settings.http_host in ("127.0.0.1", "localhost", "::1")
        says = "none: the page is served without TLS"
        more = "; a proxy in front must speak TLS, or set AMBULA_HTTP_CERTIFICATE and AMBULA_HTTP_KEY"
        return Finding(
            "Certificate", True if alone else None, f"{says}, on this machine alone" if alone else says + more
        )
    try:
        told = read_pair(certificate, key)
    except CertificateError as error:
        return Finding("Certificate", False, str(error))
    days = told.days_left(datetime.now(UTC))
    until = f"for {', '.join(told.names) or 'no name'}, until {told.ends.date()}"
    if days < 0:
        return Finding("Certificate", False, f"{until}: it has expired; renew it and restart the gateway")
    if told.begins > datetime.now(UTC):
        return Finding(
            "Certificate", False, f"{until}: it is not valid before {told.begins.date()}; is the clock right?"
        )
    if days < WARN_DAYS:
        return Finding("Certificate", None, f"{until}: {days:.0f} days left; renew it, then restart the gateway")
    return Finding("Certificate", True, f"{until}: {days:.0f} days left")
