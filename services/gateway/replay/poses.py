"""The pictures that a live page got, drawn anew from the recording by the same code."""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from schemas.kinematics import JointCentres, JointState, LivePose
from schemas.payload import Payload
from schemas.rhythm import Rhythm
from schemas.session import CameraDescription, SessionDescription
from schemas.signals import IMU, JOINT_CENTRES, JOINT_STATE, RHYTHM, SKELETON
from schemas.skeleton import SkeletonBatch
from schemas.vocabulary import FUSION_ESTIMATORS, JointCentre, SkeletonJoint, TrackingState
from services.biomech import figure
from services.biomech.figure import Angles, Pace, Told
from services.flow.message import decode_payload
from services.gateway.replay.statuses import SECOND_NS, Statuses, statuses_between
from services.recordings.ranges import Found, RecordedRanges

NEAR_NS = 200_000_000
"""Raw pictures so near to a joint state are not shown: the estimate is."""


class Wanted(NamedTuple):
    """Which pictures: from <= time < to, ns of session time, at most `rate_hz` a second."""

    from_ns: int
    to_ns: int
    rate_hz: float


def poses(ranges: RecordedRanges, wanted: Wanted) -> list[LivePose]:
    """Pictures in the order of time. Raises DamagedRecording, DecodeError, OSError."""
    # A message carries the time of its newest row: what is wanted may begin in the first message after.
    found = ranges.find(JOINT_STATE, wanted.from_ns, wanted.to_ns + SECOND_NS)
    statuses = statuses_between(ranges, wanted.from_ns, wanted.to_ns)
    drawn = _estimated(ranges, wanted, found, statuses)
    drawn += _before_an_estimate(ranges, wanted, [each.captured_ns for each in found], statuses)
    return sorted(drawn, key=lambda pose: pose.captured_ns)


def due(found: Sequence[Found], rate_hz: float) -> list[Found]:
    """Messages with the first row of each period; all other rows lie before it."""
    pace = Pace(rate_hz)
    return [each for each in found if pace.is_due(each.captured_ns)]


def _estimated(ranges: RecordedRanges, wanted: Wanted, found: Sequence[Found], statuses: Statuses) -> list[LivePose]:
    chosen = due(found, wanted.rate_hz)
    times = {each.captured_ns for each in chosen}
    beside = [
        each
        for signal in (RHYTHM, JOINT_CENTRES)
        for each in ranges.find(signal, wanted.from_ns, wanted.to_ns + SECOND_NS)
        if each.captured_ns in times
    ]
    rows: list[tuple[int, JointState]] = []
    rhythms: dict[int, tuple[Rhythm, int]] = {}
    centres: dict[int, tuple[JointCentres, int]] = {}
    for payload in _payloads(ranges, [*chosen, *beside]):
        if isinstance(payload, JointState):
            rows += [(k, payload) for k in range(len(payload.captured_ns))]
        elif isinstance(payload, Rhythm):
            rhythms |= {captured_ns: (payload, k) for k, captured_ns in enumerate(payload.captured_ns)}
        elif isinstance(payload, JointCentres):
            centres |= {captured_ns: (payload, k) for k, captured_ns in enumerate(payload.captured_ns)}
    artist = _Artist(ranges.description, statuses, rhythms, centres)
    pace = Pace(wanted.rate_hz)
    rows.sort(key=lambda row: row[1].captured_ns[row[0]])
    return [
        artist.drawn(joints, k)
        for k, joints in rows
        if wanted.from_ns <= joints.captured_ns[k] < wanted.to_ns and pace.is_due(joints.captured_ns[k])
    ]


class _Artist:
    """Draws rows of one session."""

    def __init__(
        self, description: SessionDescription, statuses: Statuses, rhythms: dict[int, tuple[Rhythm, int]],
        centres: dict[int, tuple[JointCentres, int]],
    ) -> None:  # fmt: skip
        self._body, self._segments = description.anthropometry, figure.drawn_segments(description)
        self._is_fused = description.estimator in FUSION_ESTIMATORS
        self._statuses, self._rhythms, self._centres = statuses, rhythms, centres

    def drawn(self, joints: JointState, k: int) -> LivePose:
        """The picture of one row."""
        now_ns, position, std = joints.captured_ns[k], joints.position[k], joints.position_std[k]
        rhythm, place = self._rhythms.get(now_ns, (None, 0))
        cadence = None
        if rhythm is not None:
            cadence = figure.cadence_per_min(rhythm.frequency[place], locked=rhythm.locked[place])
        sensors, cameras = self._statuses.at(now_ns)
        told = Told(sensors=sensors, cameras=cameras, cadence_per_min=cadence)
        angles = Angles(joints.model, now_ns, position, std, joints.valid)
        if now_ns in self._centres:
            return self._in_room(joints, angles, told)
        bones = figure.segment_pictures(self._body, position, self._segments, joints.observed)
        return figure.estimated_pose(angles, bones, told)

    def _in_room(self, joints: JointState, angles: Angles, told: Told) -> LivePose:
        message, place = self._centres[angles.captured_ns]
        at = message.position[place]
        is_there = figure.is_placed(at) if self._is_fused else any(message.seen)
        shown = dict(zip(JointCentre, at, strict=True)) if is_there else {}
        bones = []
        if self._is_fused and not is_there:
            lower = figure.lower_body_of(angles.position)
            bones = figure.segment_pictures(self._body, lower, self._segments, joints.observed)
        pose = figure.estimated_pose(angles, bones, told, shown)
        return figure.with_directions(pose, angles.position, angles.position_std, message.seen)


def _before_an_estimate(
    ranges: RecordedRanges, wanted: Wanted, estimated_ns: Sequence[int], statuses: Statuses
) -> list[LivePose]:
    """Where no joint state is near: what the camera saw, or who spoke."""
    covered_ns = [wanted.from_ns, *estimated_ns, min(wanted.to_ns, ranges.end_ns)]
    if all(later - earlier < NEAR_NS for earlier, later in pairwise(covered_ns)):
        return []
    camera = next(iter(ranges.description.cameras), None)
    raw = ranges.find(IMU if camera is None else SKELETON, wanted.from_ns, wanted.to_ns)
    alone = [each for each in due(raw, wanted.rate_hz) if not _is_near(each.captured_ns, estimated_ns)]
    if not alone:
        return []
    if camera is None:
        return [_waiting(each.captured_ns, statuses, {}) for each in alone]
    source = f"{SKELETON.name}/{camera.name}"
    frames = _payloads(ranges, [each for each in alone if each.stream == source])
    return [
        _waiting(captured_ns, statuses, _seen(camera, batch, k))
        for batch in frames
        if isinstance(batch, SkeletonBatch)
        for k, captured_ns in enumerate(batch.captured_ns)
        if wanted.from_ns <= captured_ns < wanted.to_ns
    ]


def _is_near(captured_ns: int, estimated_ns: Sequence[int]) -> bool:
    place = bisect_left(estimated_ns, captured_ns)
    return any(abs(each - captured_ns) < NEAR_NS for each in estimated_ns[max(0, place - 1) : place + 1])


def _seen(camera: CameraDescription, batch: SkeletonBatch, k: int) -> dict[JointCentre, list[float]]:
    """Centres that a camera tracked or inferred in one frame, m; empty while nobody is followed."""
    if batch.body[k] is None:
        return {}
    found = {}
    for centre in JointCentre:
        joint = SkeletonJoint(centre.value)
        place = camera.joints.index(joint) if joint in camera.joints else None
        at = None if place is None else batch.position[k][place]
        if place is not None and at is not None and batch.state[k][place] is not TrackingState.NOT_TRACKED:
            found[centre] = at
    return found


def _waiting(captured_ns: int, statuses: Statuses, centres: dict[JointCentre, list[float]]) -> LivePose:
    sensors, cameras = statuses.at(captured_ns)
    return LivePose(
        captured_ns=captured_ns,
        phase="calibrating" if centres else "waiting",
        message="",
        notice="",
        segments=[],
        angles={},
        angles_std={},
        sensors=sensors,
        centres=centres,
        cameras=cameras,
        cadence_per_min=None,
        stood=None,
    )


def _payloads(ranges: RecordedRanges, found: Sequence[Found]) -> Iterator[Payload]:
    for stream, envelope, payload, _ in ranges.read(found):
        decoded = decode_payload(stream.signal, envelope, payload)
        if decoded is not None:
            yield decoded
