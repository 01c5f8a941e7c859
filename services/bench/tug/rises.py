"""Rising and sitting in a recording of somebody who never walks, against optical knee angles."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from schemas.imu import ReferenceBatch
from schemas.kinematics import JointState
from schemas.tasks import TaskPhase
from schemas.vocabulary import TaskPhaseKind
from services.bench.scoreboard import Row, at_least, at_most, informative
from services.bench.tug.sessions import estimated
from services.flow.message import Message
from services.ingest.source import iter_messages, open_source
from services.segmentation.intake import Intake
from services.segmentation.timed_up_and_go.instants import instant, sight
from services.segmentation.timed_up_and_go.parameters import TimedUpAndGoParameters
from services.segmentation.timed_up_and_go.posture import Change, Posture
from services.segmentation.timed_up_and_go.trace import Trace

Array = NDArray[np.float64]

SPEC = "alborno_sub03_sts1"
CHANNEL = "knee_flexion_left"
NEAR_S = 1.0
MOST_S = 0.25


def rise_rows() -> list[Row]:
    """Rises and sits counted and timed; no attempt may be found."""
    messages = list(estimated(SPEC))
    told = [message.payload for message in messages if isinstance(message.payload, TaskPhase)]
    completed = [phase for phase in told if phase.phase is TaskPhaseKind.TURN_TO_SIT and phase.end_std_s is not None]
    seen_from_s = min(joints.captured_ns[0] for joints in _joints(messages)) * 1e-9
    found = list(changes(messages))
    rows = [
        at_most("sit to stand recording: attempts completed", len(completed), "1", 0),
        at_most("sit to stand recording: attempts begun", len({phase.attempt for phase in told}), "1", 0),
    ]
    time_s, flexion = optical_flexion()
    for rises, name in ((True, "rises"), (False, "sits")):
        true_s = [at for at in middles_s(time_s, flexion, rises=rises) if at > seen_from_s + NEAR_S]
        ours = [change for change in found if change.rises is rises]
        middle_s = np.array([0.5e-9 * (change.start_ns + change.end_ns) for change in ours])
        hit = [float(np.min(np.abs(middle_s - at))) < NEAR_S for at in true_s if len(ours)]
        rows.append(at_least(f"sit to stand recording: {name} found of {len(true_s)}", sum(hit), "1", len(true_s)))
        rows.append(at_most(f"sit to stand recording: {name} invented", max(0, len(ours) - sum(hit)), "1", 0))
        rows += _end_rows(name, time_s, flexion, ours)
    return rows


def changes(messages: list[Message]) -> Iterator[Change]:
    """The changes of posture that the segmenter sees, whether they belong to a test or not."""
    p = TimedUpAndGoParameters()
    intake, trace, posture = Intake(), Trace(p.memory_s), Posture(p)
    last = -1
    for joints in _joints(messages):
        batch = intake.take(joints, None)
        if batch is None:
            continue
        seen = sight(batch)
        for i, captured_ns in enumerate(batch.captured_ns.tolist()):
            slot = captured_ns // round(p.instant_s * 1e9)
            if slot != last:
                trace.append(instant(captured_ns, seen, i, None))
                change = posture.step(trace)
                if change is not None:
                    yield change
            last = slot


def optical_flexion() -> tuple[Array, Array]:
    """s and rad, where the cameras saw the knee."""
    source = open_source(SPEC, session="truth")
    column = [channel.name for channel in source.describe().reference].index(CHANNEL)
    rows = [
        (captured_ns * 1e-9, values[column])
        for message in iter_messages(source)
        if isinstance(message.payload, ReferenceBatch)
        for captured_ns, values in zip(message.payload.captured_ns, message.payload.values, strict=True)
        if values[column] is not None
    ]
    table = np.array(rows, dtype=np.float64)
    return table[:, 0], table[:, 1]


def middles_s(time_s: Array, flexion: Array, *, rises: bool) -> list[float]:
    """When the knee passes the middle of its range for good: extending to rise, flexing to sit."""
    high, low = np.percentile(flexion, 95), np.percentile(flexion, 5)
    middle, bent = (high + low) / 2, flexion[0] > (high + low) / 2
    found = []
    for at, value in zip(time_s, flexion, strict=True):
        if bent and value < middle - 0.15 * (high - low):
            bent = False
            found += [float(at)] if rises else []
        elif not bent and value > middle + 0.15 * (high - low):
            bent = True
            found += [] if rises else [float(at)]
    return found


def _end_rows(name: str, time_s: Array, flexion: Array, ours: list[Change]) -> list[Row]:
    """Upright is when the optical knee stops extending, seated when it stops flexing: 5 % of its largest rate."""
    sign = -1.0 if name == "rises" else 1.0
    rate = sign * np.gradient(flexion, time_s)
    errors = []
    for change in ours:
        within = np.flatnonzero((time_s > change.start_ns * 1e-9) & (time_s < change.end_ns * 1e-9 + 0.5))
        if len(within) < 5:
            continue
        peak = within[np.argmax(rate[within])]
        over = np.flatnonzero(rate[peak:] < 0.05 * rate[peak])
        if len(over):
            errors.append(change.end_ns * 1e-9 - time_s[peak + over[0]])
    if len(errors) < 2:
        return []
    bias, spread = float(np.mean(errors)), float(np.std(errors, ddof=1))
    return [
        at_most(
            f"sit to stand recording: end of {name} against cameras, |bias| + 2 SD", abs(bias) + 2 * spread, "s", MOST_S
        ),
        informative(f"sit to stand recording: end of {name}, bias", bias, "s", detail=True),
        informative(f"sit to stand recording: end of {name}, SD", spread, "s", detail=True),
    ]


def _joints(messages: list[Message]) -> list[JointState]:
    return [message.payload for message in messages if isinstance(message.payload, JointState)]
