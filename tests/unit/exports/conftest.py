"""Ten seconds of a made-up walk whose every angle is a known function of time, and its messages."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from schemas.conditions import Conditions, Footwear, WalkingAid
from schemas.gait import CURVE_POINTS, GaitEvent, Stride
from schemas.kinematics import Calibration, JointCentres, JointState
from schemas.metrics import MeanCurve, Metric, SessionMetrics, SideComparison, TrustGrade
from schemas.session import CameraDescription
from schemas.signals import (
    CALIBRATION,
    GAIT_EVENT,
    JOINT_CENTRES,
    JOINT_STATE,
    METRICS,
    REPETITION,
    STRIDE,
    TASK_PHASE,
)
from schemas.tasks import Repetition, TaskPhase
from schemas.vocabulary import BODY_MODELS, CameraKind, GaitEventKind, JointCentre, Task, TaskPhaseKind
from services.exports.session import HeldSession

RATE_HZ = 100.0
START_NS = 2_240_000_000
BATCH = 10


def angles_at(model, seconds):
    """(n, dof) rad: each angle another sine, knees bent forward only, the person turning to the left."""
    columns = []
    for place, freedom in enumerate(BODY_MODELS[model]):
        wave = np.sin(2 * math.pi * (0.9 * seconds + 0.07 * place))
        if freedom.name.startswith("knee_flexion"):
            columns.append(0.6 + 0.5 * wave)
        elif freedom.name == "pelvis_rotation":
            columns.append(0.4 * seconds)
        else:
            columns.append(0.2 * wave)
    return np.stack(columns, axis=1)


def joint_states(model="lower_body", count=1000, rate_hz=RATE_HZ, valid=None, batch=BATCH, start_ns=START_NS):
    valid = [True] * len(BODY_MODELS[model]) if valid is None else valid
    times = start_ns + np.round(np.arange(count) * 1e9 / rate_hz).astype(int)
    position = angles_at(model, times * 1e-9)
    states = []
    for first in range(0, count, batch):
        some = slice(first, first + batch)
        rows = position[some].tolist()
        zeros = np.zeros_like(position[some]).tolist()
        fields = {"velocity": zeros, "acceleration": zeros, "velocity_std": zeros, "valid": valid, "observed": []}
        std = [[0.01] * len(row) for row in rows]
        states.append(
            JointState(model=model, captured_ns=times[some].tolist(), position=rows, position_std=std, **fields)
        )
    return states


def joint_centres(state):
    points = [[[0.1 * place, 1.0, -2.0 + 0.01 * place] for place in range(len(JointCentre))] for _ in state.captured_ns]
    seen = [centre is not JointCentre.WRIST_LEFT for centre in JointCentre]
    return JointCentres(captured_ns=state.captured_ns, position=points, seen=seen)


def contacts(count):
    kinds = (GaitEventKind.INITIAL_CONTACT, GaitEventKind.TOE_OFF)
    sides = ("left", "right")
    at = [START_NS + round(place * 9.9e9 / max(count, 1)) for place in range(count)]
    return [
        GaitEvent(kind=kinds[place % 2], side=sides[place // 2 % 2], captured_ns=captured_ns, time_std_s=0.01)
        for place, captured_ns in enumerate(at)
    ]


def a_stride():
    times = dict.fromkeys(("step_time_s", "step_length_std_m", "phase_advance", "rejected_because"))
    return Stride(
        side="left", index=0, start_ns=START_NS, toe_off_ns=START_NS + 640_000_000, opposite_contact_ns=None,
        end_ns=START_NS + 1_100_000_000, stride_time_s=1.1, stance_fraction=0.58, step_length_m=0.5,
        stride_length_m=1.02, walking_speed=0.93, turning=False, valid=True, curves={}, **times,
    )  # fmt: skip


def some_metrics():
    def metric(name, side, unit, value):
        return Metric(
            name=name, side=side, unit=unit, value=value, spread=0.1, mean_std=0.01, low=None, high=None, strides=12,
            grade=TrustGrade.GOOD, doubts=[], withheld_because=None if value is not None else "too few strides",
        )  # fmt: skip

    metrics = [
        metric("cadence", None, "steps/min", 108.0),
        metric("stance_fraction", "left", "1", 0.61),
        metric("knee_flexion_range", "right", "rad", 1.0),
        metric("walking_speed", None, "m/s", None),
    ]
    curve = MeanCurve(
        degree_of_freedom="knee_flexion_left", strides=12, mean=[0.5] * CURVE_POINTS, spread=[0.1] * CURVE_POINTS
    )
    sides = SideComparison(
        joint="knee_flexion", reference_side="right", rmse=0.2, rmse_std=0.02, rmse_about_mean=0.15, shift=0.01,
        strides=11,
    )  # fmt: skip
    return SessionMetrics(
        captured_ns=START_NS, final=True, software="ambula 0.0.1+abc", metrics=metrics, curves=[curve], sides=[sides],
        quality=None, phases=[], repetitions=[],
    )  # fmt: skip


def a_phase(end_ns):
    return TaskPhase(
        task=Task.TIMED_UP_AND_GO, attempt=0, phase=TaskPhaseKind.TURN, start_ns=START_NS, start_std_s=0.1,
        end_ns=end_ns, end_std_s=None, largest_turn_rate=2.0, largest_thigh_rate=None, steps=4,
    )  # fmt: skip


def a_repetition():
    return Repetition(
        degree_of_freedom="knee_flexion_left", side="left", index=0, start_ns=START_NS, turn_ns=START_NS + 10**9,
        end_ns=START_NS + 2 * 10**9, start_angle=0.1, turn_angle=1.5, end_angle=0.1, angle_std=0.02,
        largest_velocity=2.0, valid=True, rejected_because=None, ranges={"hip_flexion_left": 0.5},
    )  # fmt: skip


@pytest.fixture
def about(description):
    """The description of the walk: with a cane, in shoes."""
    conditions = Conditions(aid=WalkingAid.CANE, footwear=Footwear.SHOES)
    return description.model_copy(update={"conditions": conditions})


@pytest.fixture
def calibration():
    return Calibration(
        model="lower_body", estimator="ekf", method="standing", datum="quiet standing", quality=1.0, sensors=[],
        events_from={}, unused={}, misplaced={}, lengths={}, absolute=True,
    )  # fmt: skip


@pytest.fixture
def walk(about, calibration):
    """A session of inertial sensors in memory."""
    messages = [(CALIBRATION, calibration)]
    messages += [(JOINT_STATE, state) for state in joint_states()]
    messages += [(GAIT_EVENT, event) for event in contacts(20)]
    messages += [(STRIDE, a_stride()), (METRICS, some_metrics())]
    messages += [(TASK_PHASE, a_phase(None)), (TASK_PHASE, a_phase(START_NS + 10**9)), (REPETITION, a_repetition())]
    return HeldSession(about, messages, "ambula 0.0.1+abc")


@pytest.fixture
def seen(about):
    """A session of a camera in memory; the left wrist is never seen."""
    camera = CameraDescription(name="kinect", kind=CameraKind.KINECT_V2, rate_hz=30.0, joints=[], floor_m=None)
    states = joint_states("whole_body", 120, 30.0)
    messages = [pair for s in states for pair in ((JOINT_STATE, s), (JOINT_CENTRES, joint_centres(s)))]
    return HeldSession(about.model_copy(update={"cameras": [camera], "estimator": "body_cekf"}), messages)


@pytest.fixture
def made():
    """Makers of the messages."""
    makers = (angles_at, joint_states, joint_centres, contacts, a_stride, some_metrics, a_phase, a_repetition)
    return SimpleNamespace(start_ns=START_NS, rate_hz=RATE_HZ, **{maker.__name__: maker for maker in makers})
