"""Every format by name: what it is, which messages it needs, and how it is written."""

from collections.abc import Callable, Iterator
from typing import BinaryIO, NamedTuple

from schemas.signals import GAIT_EVENT, JOINT_CENTRES, JOINT_STATE, STRIDE, TASK_PHASE, Signal
from schemas.vocabulary import KNEE_ESTIMATORS
from services.exports.c3d.c3d_file import c3d_file
from services.exports.errors import ExportError
from services.exports.motion import gather_motion
from services.exports.opensim.coordinates import to_coordinates
from services.exports.opensim.marker_file import marker_file
from services.exports.opensim.models import RAJAGOPAL, OpenSimModel, known_model
from services.exports.opensim.storage_file import storage_file
from services.exports.session import Session, contents_of, facts_of
from services.exports.tables.csv_file import csv_text
from services.exports.tables.kinds import TABLES
from services.flow.message import DecodeError


class Options(NamedTuple):
    """What may be chosen."""

    model: OpenSimModel = known_model(RAJAGOPAL)
    """Whose coordinates .mot and .sto have."""


Writing = Callable[[Session, Options], Iterator[bytes]]


class Format(NamedTuple):
    """One kind of file. `needs` is the signal without which there is nothing to write."""

    ending: str
    media_type: str
    about: str
    needs: Signal
    writing: Writing


def _table(name: str) -> Writing:
    signal = TABLES[name].signal

    def write(session: Session, _: Options) -> Iterator[bytes]:
        return csv_text(name, facts_of(session), session.payloads(signal))

    return write


def _c3d(session: Session, _: Options) -> Iterator[bytes]:
    return c3d_file(facts_of(session), *contents_of(session))


def _storage(*, in_degrees: bool) -> Writing:
    def write(session: Session, options: Options) -> Iterator[bytes]:
        motion = gather_motion(session.payloads(JOINT_STATE))
        coordinates = to_coordinates(motion, options.model)
        return storage_file(facts_of(session), options.model, coordinates, in_degrees=in_degrees)

    return write


def _markers(session: Session, _: Options) -> Iterator[bytes]:
    motion = gather_motion(session.payloads(JOINT_STATE, JOINT_CENTRES))
    return marker_file(facts_of(session), motion, file_name(session.description.session, "trc"))


def _foxglove(session: Session, _: Options) -> Iterator[bytes]:
    from services.exports.foxglove.recording import foxglove_recording

    shown = session.payloads(JOINT_STATE, JOINT_CENTRES, GAIT_EVENT, STRIDE, TASK_PHASE)
    return foxglove_recording(facts_of(session), shown)


_CSV = "text/csv; charset=utf-8"
_OF_TABLES = {
    "metrics": "numbers of the session with spread, 95 % interval, grade, doubts and n; mean and SD for z-scores",
    "curves": "mean and SD of each joint over 0-100 % of the stride",
    "sides": "curves of one leg against the other's, joint by joint",
    "strides": "one row a stride of each foot",
    "events": "foot contacts",
    "joint_angles": "angles over time in degrees, with their deviations",
    "phases": "parts of timed tests",
    "repetitions": "repetitions of exercises",
}
FORMATS: dict[str, Format] = {
    **{
        f"{name}.csv": Format(f"{name}.csv", _CSV, f"Table: {about}.", TABLES[name].signal, _table(name))
        for name, about in _OF_TABLES.items()
    },
    "c3d": Format(
        "c3d",
        "application/octet-stream",
        "Joint centres (mm), angles as model outputs (deg), foot contacts and figures, for gait laboratories.",
        JOINT_STATE,
        _c3d,
    ),
    "mot": Format(
        "mot",
        "text/plain; charset=utf-8",
        "Coordinates for OpenSim, in degrees.",
        JOINT_STATE,
        _storage(in_degrees=True),
    ),
    "sto": Format(
        "sto",
        "text/plain; charset=utf-8",
        "Coordinates for OpenSim, in radians.",
        JOINT_STATE,
        _storage(in_degrees=False),
    ),
    "trc": Format("trc", "text/plain; charset=utf-8", "Joint centres for OpenSim (mm, y up).", JOINT_STATE, _markers),
    "mcap": Format(
        "foxglove.mcap",
        "application/vnd.mcap",
        "Recording for Foxglove: skeleton, angles, foot contacts and strides.",
        JOINT_STATE,
        _foxglove,
    ),
}


def why_not(name: str, signals: frozenset[str], estimator: str) -> str | None:
    """Why a format cannot be had of a session; None when nothing speaks against it. Raises ExportError as `format_of`.

    It is told from which messages there are: writing may still find that what they say is too little.
    """
    needs = format_of(name).needs
    if needs.name not in signals:
        return f"the session holds no {needs.name} messages: {needs.meaning}"
    if name == "trc" and estimator in KNEE_ESTIMATORS:
        return "joint centres need hip and knee of a leg; this session told single knees"
    return None


def format_of(name: str) -> Format:
    """Raises ExportError for a name that is not known."""
    if name not in FORMATS:
        raise ExportError("format", f"{name!r} is none of {', '.join(FORMATS)}", "name one of them")
    return FORMATS[name]


def file_name(session: str, name: str) -> str:
    """Says the session's random id and nothing else."""
    return f"ambula-{session}-{FORMATS[name].ending}" if "." in FORMATS[name].ending else f"ambula-{session}.{name}"


def write(name: str, session: Session, file: BinaryIO, options: Options | None = None) -> int:
    """One file of a session; its size, bytes.

    Raises ExportError: the format is not known, or the session cannot be told in it. What reading raises passes.
    """
    reason = why_not(name, session.signals, session.description.estimator)
    if reason is not None:
        raise ExportError("session", reason, "choose another format")
    size = 0
    try:
        for part in format_of(name).writing(session, options or Options()):
            size += file.write(part)
    except DecodeError as error:
        what = f"holds messages that this Ambula does not read, {error}"
        raise ExportError("recording", what, "compute the session anew with `ambula reprocess`") from error
    return size
