"""Joint states of the lower body and of the whole body, as both estimators send them, become one."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.kinematics import JointState
from schemas.rhythm import Rhythm
from schemas.vocabulary import BODY_MODELS, Segment
from services.biomech.fusion.parameters import FusionParameters
from services.biomech.fusion.shared_angles import SharedAngles, Told
from services.estimation.fusion.blend import Blend, Leading
from services.estimation.fusion.readings import COLUMNS, History, Reading, carried, readings
from services.flow.node import State, pack_array, unpack_array

Array = NDArray[np.float64]

MODEL = "whole_body"
DOFS = len(BODY_MODELS[MODEL])
PLACES = COLUMNS[MODEL]

ABSENT_NS = 150_000_000
"""A source that said nothing for so long is away: five frames of a camera, and longer than a burst of lost samples."""
LEARNED_GAP_NS = 50_000_000
"""Inertial rows further apart than this say nothing of the time between them."""
KEPT_INERTIAL, KEPT_CAMERA = 100, 30


class _Body(NamedTuple):
    """The newest whole body from the camera."""

    captured_ns: int
    tables: Array  # (5, 24): position, velocity, acceleration and both deviations
    valid: NDArray[np.bool_]  # (24,)
    observed: list[Segment]


class Fuser:
    """Rows come at the inertial sensors' times while these speak, at the camera's otherwise; never twice for a time."""

    def __init__(self, parameters: FusionParameters | None = None) -> None:
        p = parameters or FusionParameters()
        self._shared = SharedAngles(p)
        self._blend = Blend(p.joined_s)
        self._inertial, self._camera = History(KEPT_INERTIAL), History(KEPT_CAMERA)
        self._pending: list[Reading] = []
        self._body: _Body | None = None
        self._last_ns = -1
        self._compared_ns = -1

    @property
    def last_ns(self) -> int:
        """Time of the last row."""
        return self._last_ns

    def take_inertial(self, joints: JointState, _rhythm: Rhythm | None) -> JointState | None:
        """The fused rows at these times; None when all of them are past."""
        later = [k for k, captured_ns in enumerate(joints.captured_ns) if captured_ns > self._last_ns]
        rows: list[tuple[int, Array, NDArray[np.bool_]]] = []
        for k, reading in enumerate(readings(joints)):
            self._inertial.append(reading)
            self._compare_pending(reading.captured_ns)
            if later and k >= later[0]:
                rows.append(self._row(reading.captured_ns, reading))
        if not rows:
            return None
        return self._joint_state(rows, joints.observed)

    def take_camera(self, joints: JointState, rhythm: Rhythm | None) -> JointState | None:
        """Learn from these rows; where the inertial sensors are away, the fused rows at these times."""
        rows = []
        for k, reading in enumerate(readings(joints, rhythm)):
            self._body = _body(joints, k)
            self._camera.append(reading)
            if self._is_away(self._inertial, reading.captured_ns):
                self._pending = []
                if reading.captured_ns > self._last_ns:
                    rows.append(self._row(reading.captured_ns, None))
            else:
                self._pending.append(reading)
                newest = self._inertial.newest
                self._compare_pending(-1 if newest is None else newest.captured_ns)
        return self._joint_state(rows, []) if rows else None

    @staticmethod
    def _is_away(history: History, now_ns: int) -> bool:
        newest = history.newest
        return newest is None or now_ns - newest.captured_ns > ABSENT_NS

    def _compare_pending(self, reached_ns: int) -> None:
        while self._pending and self._pending[0].captured_ns <= reached_ns:
            camera = self._pending.pop(0)
            inertial = self._inertial.at(camera.captured_ns, LEARNED_GAP_NS)
            if inertial is not None:
                since_s = (camera.captured_ns - self._compared_ns) / 1e9
                self._shared.compare(since_s, inertial, camera.told, camera.turn)
                self._compared_ns = camera.captured_ns

    def _row(self, captured_ns: int, inertial: Reading | None) -> tuple[int, Array, NDArray[np.bool_]]:
        """(5, 24) tables and (24,) validity at one instant."""
        by_camera = None if inertial is not None and inertial.told.valid.all() else self._by_camera(captured_ns)
        by_inertial = None if inertial is None else self._shared.from_inertial(inertial.told)
        told = self._blend.take(captured_ns, by_inertial, by_camera)
        tables, valid = self._others(captured_ns)
        tables[0, PLACES], tables[1, PLACES], tables[3, PLACES], valid[PLACES] = *told[:3], told.valid
        if inertial is not None:
            led = self._blend.leading == Leading.INERTIAL
            tables[2, PLACES[led]] = inertial.acceleration[led]
        self._last_ns = captured_ns
        return captured_ns, tables, valid

    def _by_camera(self, captured_ns: int) -> Told | None:
        """What the camera says at a time, through its manner; None while it is away."""
        camera = self._camera.newest
        if camera is None or self._is_away(self._camera, captured_ns):
            return None
        return self._shared.from_camera(*carried(camera, captured_ns))

    def _others(self, captured_ns: int) -> tuple[Array, NDArray[np.bool_]]:
        """What the camera alone tells, carried on to a time; not valid when it is away."""
        body = self._body
        if body is None:
            return np.concatenate([np.zeros((3, DOFS)), np.full((2, DOFS), np.pi)]), np.zeros(DOFS, dtype=np.bool_)
        tables, valid = body.tables.copy(), body.valid.copy()
        elapsed_ns = captured_ns - body.captured_ns
        if elapsed_ns > ABSENT_NS:
            tables[1:3] = 0.0
            return tables, np.zeros(DOFS, dtype=np.bool_)
        tables[0] += tables[1] * (elapsed_ns / 1e9)
        return tables, valid

    def _joint_state(self, rows: list[tuple[int, Array, NDArray[np.bool_]]], observed: list[Segment]) -> JointState:
        position, velocity, acceleration, position_std, velocity_std = np.stack([row[1] for row in rows], axis=1)
        seen = [] if self._body is None or self._is_away(self._camera, rows[-1][0]) else self._body.observed
        return JointState(
            model=MODEL,
            captured_ns=[row[0] for row in rows],
            position=position.tolist(),
            velocity=velocity.tolist(),
            acceleration=acceleration.tolist(),
            position_std=position_std.tolist(),
            velocity_std=velocity_std.tolist(),
            valid=np.all([row[2] for row in rows], axis=0).tolist(),
            observed=[segment for segment in Segment if segment in {*observed, *seen}],
        )

    def snapshot(self) -> State:
        """Everything that changes."""
        body = self._body
        return {
            "shared": {
                part: {name: pack_array(array) for name, array in arrays.items()}
                for part, arrays in self._shared.snapshot().items()
            },
            "blend": self._blend.snapshot(),
            "inertial": self._inertial.snapshot(),
            "camera": self._camera.snapshot(),
            "pending_ns": [reading.captured_ns for reading in self._pending],
            "body": None if body is None else _packed(body),
            "times_ns": [self._last_ns, self._compared_ns],
        }

    def restore(self, state: State) -> None:
        """Inverse of `snapshot`."""
        self._shared.restore(
            {
                part: {name: unpack_array(array).copy() for name, array in arrays.items()}
                for part, arrays in state["shared"].items()
            }
        )
        self._blend.restore(state["blend"])
        self._inertial.restore(state["inertial"])
        self._camera.restore(state["camera"])
        self._pending = self._camera.of(state["pending_ns"])
        self._body = None if state["body"] is None else _unpacked(state["body"])
        self._last_ns, self._compared_ns = state["times_ns"]


def _body(joints: JointState, k: int) -> _Body:
    tables = (joints.position, joints.velocity, joints.acceleration, joints.position_std, joints.velocity_std)
    return _Body(joints.captured_ns[k], np.array([t[k] for t in tables]), np.array(joints.valid), joints.observed)


def _packed(body: _Body) -> State:
    return {
        "captured_ns": body.captured_ns,
        "tables": pack_array(body.tables),
        "valid": body.valid.tolist(),
        "observed": [segment.value for segment in body.observed],
    }


def _unpacked(state: State) -> _Body:
    observed = [Segment(value) for value in state["observed"]]
    return _Body(state["captured_ns"], unpack_array(state["tables"]).copy(), np.array(state["valid"]), observed)
