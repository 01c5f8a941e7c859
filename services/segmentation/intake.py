"""Messages become arrays, and what cannot be used is counted."""

from operator import lt

import numpy as np
from numpy.typing import NDArray

from schemas.health import Reason, Rejection
from schemas.kinematics import JointCentres, JointState
from schemas.rhythm import Rhythm
from schemas.signals import JOINT_CENTRES, JOINT_STATE, RHYTHM, SEGMENT_MOTION
from schemas.vocabulary import BODY_MODELS, JointCentre
from services.flow.message import Stream
from services.flow.node import State
from services.segmentation.batch import COLUMNS, INDEX, Batch, Centres

Array = NDArray[np.float64]

JOINTS_FROM = Stream(JOINT_STATE, "estimation")
RHYTHM_FROM = Stream(RHYTHM, "estimation")
MOTION_FROM = Stream(SEGMENT_MOTION, "estimation")
CENTRES_FROM = Stream(JOINT_CENTRES, "estimation")

MOST_ANGLE, MOST_RATE = 1e4, 200.0
"""rad and rad/s; beyond them a value is no joint coordinate (pelvis_rotation counts whole turns)."""
_LIMITS = np.array([MOST_ANGLE, MOST_RATE, MOST_ANGLE])[:, None, None]

MOST_DISTANCE = 100.0
"""m; beyond it no camera sees anybody."""

MOST_PHASE = 1e9
"""rad, beyond the strides of a lifetime."""

LATEST_NS = 10**17
"""ns, three years; a session time beyond it is none."""

_COLUMNS_OF = {
    model: None if model == "lower_body" else np.array([INDEX[dof.name] for dof in dofs])
    for model, dofs in BODY_MODELS.items()
}
"""Where each coordinate of a model stands in a batch; None: they stand there as they come."""


class Intake:
    """Checks samples; remembers how many were not used, and why."""

    def __init__(self) -> None:
        self._newest_ns = -1
        self._model: str | None = None
        self._rejected: dict[tuple[str, Reason], int] = {}

    def take(self, joints: JointState, rhythm: Rhythm | None, centres: JointCentres | None = None) -> Batch | None:
        """The usable samples of a message; None when there are none."""
        rows = len(joints.captured_ns)
        tables = None if self._model not in (None, joints.model) else _tables(joints)
        if tables is None:
            self._reject(JOINTS_FROM, Reason.WRONG_SHAPE, rows)
            return None
        if max(map(abs, joints.captured_ns)) > LATEST_NS:
            self._reject(JOINTS_FROM, Reason.OUT_OF_RANGE, rows)
            return None
        captured_ns = np.array(joints.captured_ns, dtype=np.int64)
        use = self._usable(captured_ns, tables)
        if use is None:
            return None
        self._newest_ns, self._model = int(captured_ns[use][-1]), joints.model
        valid, tables = _in_columns(joints.model, np.array(joints.valid), tables)
        position, velocity, std = tables[:, use]
        phase, observed = self._phase(rhythm, rows)[use], frozenset(joints.observed)
        placed = None if centres is None else self._centres(centres, use)
        return Batch(captured_ns[use], position, velocity, phase, std, valid, observed, placed)

    def refuse_motion(self, count: int) -> None:
        """Count samples of lone segments that can not be used."""
        self._reject(MOTION_FROM, Reason.OUT_OF_RANGE, count)

    def _usable(self, captured_ns: NDArray[np.int64], tables: Array) -> NDArray[np.bool_] | slice | None:
        """Which rows to use, None for none. Almost always all of them, which is looked at first."""
        bounded = np.abs(tables) < _LIMITS
        times = captured_ns.tolist()
        if all(map(lt, [self._newest_ns, *times], times)) and bounded.all():
            return slice(None)
        newest = np.maximum.accumulate(np.concatenate([[self._newest_ns], captured_ns]))
        later = captured_ns > newest[:-1]
        use: NDArray[np.bool_] = later & bounded.all(axis=(0, 2))
        self._reject(JOINTS_FROM, Reason.CLOCK_BACKWARDS, int(np.sum(~later)))
        self._reject(JOINTS_FROM, Reason.OUT_OF_RANGE, int(np.sum(later & ~use)))
        return use if use.any() else None

    def _phase(self, rhythm: Rhythm | None, rows: int) -> Array:
        if rhythm is None:
            return np.full(rows, np.nan)
        if len(rhythm.phase) != rows or len(rhythm.locked) != rows:
            self._reject(RHYTHM_FROM, Reason.WRONG_SHAPE, rows)
            return np.full(rows, np.nan)
        phase = np.array(rhythm.phase, dtype=np.float64)
        return np.where(np.array(rhythm.locked) & (np.abs(phase) < MOST_PHASE), phase, np.nan)

    def _centres(self, centres: JointCentres, use: NDArray[np.bool_] | slice) -> Centres | None:
        rows, number = len(centres.captured_ns), len(JointCentre)
        try:
            position = np.array(centres.position, dtype=np.float64)
        except ValueError:
            position = np.empty(0)
        if position.shape != (rows, number, 3) or len(centres.seen) != number:
            self._reject(CENTRES_FROM, Reason.WRONG_SHAPE, rows)
            return None
        if not (np.abs(position) < MOST_DISTANCE).all():
            self._reject(CENTRES_FROM, Reason.OUT_OF_RANGE, rows)
            return None
        return Centres(position[use], np.array(centres.seen))

    def _reject(self, stream: Stream, reason: Reason, count: int) -> None:
        if count:
            key = (stream.name, reason)
            self._rejected[key] = self._rejected.get(key, 0) + count

    def rejections(self) -> list[Rejection]:
        """Samples that were not used."""
        return [
            Rejection(subject=subject, reason=reason, count=count)
            for (subject, reason), count in sorted(self._rejected.items())
        ]

    def snapshot(self) -> State:
        """The newest time, the model and the counts."""
        rejected = [[subject, reason.value, count] for (subject, reason), count in self._rejected.items()]
        return {"newest_ns": self._newest_ns, "model": self._model, "rejected": rejected}

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._newest_ns, self._model = state["newest_ns"], state["model"]
        self._rejected = {(subject, Reason(reason)): count for subject, reason, count in state["rejected"]}


def _tables(joints: JointState) -> Array | None:
    """Position, velocity and deviation (3, n, dof); None when the message has another shape than its model."""
    dofs = len(BODY_MODELS.get(joints.model, ()))
    if not dofs or len(joints.valid) != dofs:
        return None
    try:
        tables = np.array([joints.position, joints.velocity, joints.position_std], dtype=np.float64)
    except ValueError:
        return None
    return tables if tables.shape == (3, len(joints.captured_ns), dofs) else None


def _in_columns(model: str, valid: NDArray[np.bool_], tables: Array) -> tuple[NDArray[np.bool_], Array]:
    """Flags and tables in the columns of a batch."""
    columns = _COLUMNS_OF[model]
    if columns is None:
        return valid, tables
    flags, values = np.zeros(len(COLUMNS), dtype=np.bool_), np.zeros((*tables.shape[:2], len(COLUMNS)))
    flags[columns], values[..., columns] = valid, tables
    return flags, values
