"""Files for other programs, read back by those who read them: what is lost on the way, their sizes and times."""

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.payload import Payload
from schemas.signals import JOINT_CENTRES, JOINT_STATE, Signal
from schemas.vocabulary import JointCentre
from services.bench.report import Section, Table
from services.bench.scoreboard import Row, at_most, informative
from services.cli.assembly import build_chain
from services.exports.c3d.points import LABELS, angle_outputs
from services.exports.formats import FORMATS, Options, write
from services.exports.joint_positions import Positions, joint_positions
from services.exports.motion import Motion, even_rate_hz, even_times, gather_motion, nominal_rates_hz, resampled
from services.exports.opensim.coordinates import to_coordinates
from services.exports.opensim.models import RANGES, known_model
from services.exports.session import HeldSession
from services.ingest.choices import AS_THE_SOURCE_SAYS
from services.ingest.source import iter_messages, open_chosen

Array = NDArray[np.float64]
Advance = Callable[[], None]

LIMIT_RAD = 1e-4
SESSIONS = {
    "walk": "synthetic:walk?speed=1.1&seed=3&duration=60",
    "squat": "synthetic:squat?seed=3",
}
STEPS = 2 * len(SESSIONS)
PARAGRAPHS = (
    "A synthetic walk of inertial sensors and synthetic squats before a camera are computed, written in every format, "
    "and read back by ezc3d and OpenSim. The error is the largest of any sample and angle against what was computed: "
    "C3D holds angles as 32-bit degrees, .mot and .sto eight decimals, .trc joint centres in mm, of which the angle "
    "between thigh and shank is compared.",
)


class Written(NamedTuple):
    """A file of a session."""

    path: Path
    size_bytes: int
    seconds: float


def run(advance: Advance) -> Section:
    """Round trips of two sessions."""
    rows: list[Row] = []
    lines: list[list[str]] = []
    with tempfile.TemporaryDirectory() as folder:
        for name, spec in SESSIONS.items():
            session, seconds = computed(spec)
            advance()
            files = {kind: written(session, kind, Path(folder)) for kind in FORMATS if _holds(session, kind)}
            rows += [*_round_trips(name, session, files), *_costs(name, files)]
            lines += [
                [f"{name}, {seconds:.0f} s", kind, f"{file.size_bytes / 1e6:.2f}", f"{file.seconds:.2f}"]
                for kind, file in files.items()
            ]
            advance()
    table = Table("Files of a session", ("session", "format", "MB", "s to write"), lines)
    return Section("Exports: round trips through other programs", list(PARAGRAPHS), rows, [table])


def computed(spec: str) -> tuple[HeldSession, float]:
    """A source through the nodes, and how long it lasts, s."""
    source = open_chosen(spec, AS_THE_SOURCE_SAYS)
    description = source.describe()
    chain, last_ns = build_chain(description), 0
    payloads: list[tuple[Signal, Payload]] = []
    for message in iter_messages(source):
        last_ns = message.envelope.captured_ns
        for produced in chain.push(message):
            if produced.payload is not None and produced.stream.signal.archived == "derived":
                payloads.append((produced.stream.signal, produced.payload))
    return HeldSession(description, payloads), last_ns * 1e-9


def written(session: HeldSession, kind: str, folder: Path, options: Options | None = None) -> Written:
    """One format, timed."""
    path = folder / f"session-{FORMATS[kind].ending}.{kind}"
    start = time.perf_counter()
    with path.open("wb") as file:
        size = write(kind, session, file, options)
    return Written(path, size, time.perf_counter() - start)


def _holds(session: HeldSession, kind: str) -> bool:
    return FORMATS[kind].needs.name in session.signals


def _costs(name: str, files: dict[str, Written]) -> Iterator[Row]:
    for kind, file in files.items():
        yield informative(f"{name}: {kind}, size", file.size_bytes / 1e6, "MB", detail=True)
        yield informative(f"{name}: {kind}, time", file.seconds, "s", detail=True)


def _round_trips(name: str, session: HeldSession, files: dict[str, Written]) -> Iterator[Row]:
    motion = gather_motion(session.payloads(JOINT_STATE, JOINT_CENTRES))
    positions = joint_positions(motion, session.description.anthropometry)
    assert positions is not None
    grid = even_rate_hz(motion.angles.times_ns, nominal_rates_hz(session.description))
    yield from _against("ezc3d", f"{name}: C3D", lambda oracle: c3d_error(oracle, files["c3d"].path, motion, grid))
    for model in RANGES:
        for kind in ("mot", "sto"):
            file = written(session, kind, files[kind].path.parent, Options(known_model(model)))
            measure = _storage_measure(file.path, motion, model, kind)
            yield from _against("opensim", f"{name}: .{kind}, {model}", measure)
    yield from _against(
        "opensim", f"{name}: .trc", lambda oracle: marker_error(oracle, files["trc"].path, positions, grid)
    )


def _storage_measure(path: Path, motion: Motion, model: str, kind: str) -> Callable[[ModuleType], float]:
    return lambda oracle: storage_error(oracle, path, motion, model, in_degrees=kind == "mot")


def _against(oracle: str, name: str, measure: Callable[[ModuleType], float]) -> Iterator[Row]:
    """The error, or why there is none."""
    try:
        module = __import__(oracle)
    except ImportError:
        reason = f"{oracle} is not installed: it is in the extra bench"
        yield Row(f"{name}, largest error", None, "rad", reason, None, None)
        return
    if oracle == "opensim":
        module.Logger.removeFileSink()  # else it writes opensim.log into the current folder
    yield at_most(f"{name} through {oracle}, largest error", measure(module), "rad", LIMIT_RAD)


def c3d_error(ezc3d: ModuleType, path: Path, motion: Motion, rate_hz: float) -> float:
    """Largest difference of any angle in any frame, rad. Raises ValueError when a frame appeared or went missing."""
    found = ezc3d.c3d(str(path))
    labels = found["parameters"]["POINT"]["LABELS"]["value"]
    points = np.asarray(found["data"]["points"], dtype=np.float64)
    track = resampled(motion.angles, even_times(motion.angles.times_ns, rate_hz), rate_hz)
    outputs, worst = angle_outputs(motion), 0.0
    for label, columns in zip(outputs.labels, outputs.columns, strict=True):
        told = [column for column in columns if column is not None]
        valid = track.valid[:, told].all(axis=1)
        for axis, column in enumerate(columns):
            if column is not None:
                read = np.radians(points[axis, labels.index(label)])
                if not np.array_equal(~np.isnan(read), valid):
                    raise ValueError(f"{label}: other frames are valid in {path.name} than were written")
                worst = max(worst, float(np.abs(read - track.value[:, column, 0])[valid].max(initial=0.0)))
    return worst


def storage_error(opensim: ModuleType, path: Path, motion: Motion, model: str, *, in_degrees: bool) -> float:
    """Largest difference of any coordinate in any row, rad."""
    coordinates = to_coordinates(motion, known_model(model))
    table = opensim.TimeSeriesTable(str(path))
    if tuple(table.getColumnLabels()) != coordinates.names:
        raise ValueError(f"{path.name} has the columns {table.getColumnLabels()}")
    values = table.getMatrix().to_numpy()
    return float(np.abs((np.radians(values) if in_degrees else values) - coordinates.values).max())


def marker_error(opensim: ModuleType, path: Path, positions: Positions, rate_hz: float) -> float:
    """Largest difference of the angle between thigh and shank, of either leg in any frame, rad."""
    track = resampled(positions.track, even_times(positions.track.times_ns, rate_hz), rate_hz)
    table = opensim.TimeSeriesTableVec3(str(path))
    worst = 0.0
    for side in ("right", "left"):
        leg = [JointCentre(f"{name}_{side}") for name in ("hip", "knee", "ankle")]
        at = [positions.names.index(centre) for centre in leg]
        read = np.stack([_column(table, LABELS[centre]) for centre in leg], axis=1)
        told = track.valid[:, at].all(axis=1)
        if not np.array_equal(~np.isnan(read).any(axis=(1, 2)), told):
            raise ValueError(f"other frames of the {side} leg are valid in {path.name} than were written")
        difference = knee_angles(read[told]) - knee_angles(track.value[told][:, at])
        worst = max(worst, float(np.abs(difference).max(initial=0.0)))
    return worst


def knee_angles(leg: Array) -> Array:
    """Angle between thigh and shank, rad, of hip, knee and ankle (n, 3, 3)."""
    thigh, shank = leg[:, 1] - leg[:, 0], leg[:, 2] - leg[:, 1]
    across = np.linalg.norm(np.cross(thigh, shank), axis=1)
    return np.asarray(np.arctan2(across, np.einsum("ij,ij->i", thigh, shank)))


def _column(table: Any, label: str) -> Array:
    column = table.getDependentColumn(label)
    return np.array([[column[row][axis] for axis in range(3)] for row in range(table.getNumRows())])
