"""A whole synthetic session, block by block: description, samples and truth. Pure."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from schemas.conditions import UNSAID
from schemas.session import Anthropometry, HubDescription, ReferenceChannel, SessionDescription
from schemas.vocabulary import LOWER_BODY, Side, Task
from services.ingest.synthetic.block import Block, SeenFrames
from services.ingest.synthetic.gait import Gait, Strides, WalkingBody
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import BeforeCameraParameters, SessionParameters
from services.ingest.synthetic.rigid import PointMotion
from services.ingest.synthetic.sensors import (
    LEFT_LEG,
    PELVIS,
    RIGHT_LEG,
    SHANK_UPSIDE_DOWN,
    SWAPPED,
    THIGH_UPSIDE_DOWN,
    Mount,
    measure,
    mounts,
    spoiled,
)
from services.ingest.synthetic.timeline import Timeline
from services.ingest.synthetic.whole_body.parameters import CAMERA_ALONE, NO_CAMERA
from services.ingest.tracks import ImuTrack, ReferenceTrack

if TYPE_CHECKING:
    from services.ingest.synthetic.whole_body.walker import SeenWalker

HUB = "walker"
BLOCK_SAMPLES = 1000
"""Samples made at a time: memory stays bounded however long the session is."""

AMPLITUDES = np.linspace(0.0, 1.6, 33)
"""At which the length of a stride is known."""

_WORN_IN_WORDS = {
    LEFT_LEG: ", sensors on the left leg alone",
    RIGHT_LEG: ", sensors on the right leg alone",
    PELVIS: ", a sensor on the pelvis alone",
}
_MISWORN_IN_WORDS = {
    SWAPPED: ", thigh and shank swapped",
    THIGH_UPSIDE_DOWN: ", thigh sensor upside down",
    SHANK_UPSIDE_DOWN: ", shank sensor upside down",
}


class SyntheticSession(ABC):
    """A person who moves in strides and wears sensors.

    Deterministic by its parameters: the same session, sample by sample, whenever and however often it is made.
    """

    title: str
    protocol: str
    task = Task.WALK
    walkway_m: float | None = None
    own_channels: tuple[str, ...] = ()
    """Truth, dimensionless, that only this motion has."""

    def __init__(self, parameters: SessionParameters, timeline: Timeline, gait: Gait) -> None:
        self.parameters = parameters
        self.timeline = timeline
        self.gait = gait
        self.reference_hz = parameters.rate
        self.camera = _camera(parameters)
        alone = self.camera is not None and self.camera.parameters.camera == CAMERA_ALONE
        self.mounts: list[Mount] = [] if alone else mounts(parameters)

    @abstractmethod
    def amplitude(self, time_s: Array) -> Jet:
        """How large the movement is: 0 standing, 1 as the gait's curves are drawn."""

    @property
    def sample_count(self) -> int:
        """Samples of each sensor."""
        return math.floor(self.parameters.duration * self.parameters.rate)

    @cached_property
    def stride_length(self) -> PchipInterpolator:
        """m per stride over amplitude."""
        return PchipInterpolator(AMPLITUDES, self.gait.stride_length(AMPLITUDES))

    def amplitude_at(self, speed: float) -> float:
        """Amplitude at which stride length times stride frequency is a speed, m/s; the largest for a higher one."""
        wanted = speed / self.timeline.frequency_hz
        longest = float(self.stride_length(AMPLITUDES[-1]))
        if wanted >= longest:
            return float(AMPLITUDES[-1])
        return float(brentq(lambda amplitude: float(self.stride_length(amplitude)) - wanted, 0.0, AMPLITUDES[-1]))

    def own_truth(self, time_s: Array) -> Array:
        """The channels of `own_channels` at n instants, one column each."""
        return np.zeros((len(time_s), len(self.own_channels)))

    def soft_tissue(self, strides: Strides) -> tuple[Jet, Jet]:
        """What it follows, in cycles, and how much: the strides."""
        return strides.phase, strides.amplitude

    def description(self, session: str = "synthetic", started_unix_ns: int = 0) -> SessionDescription:
        """The session as it would be served live."""
        parameters = self.parameters
        return SessionDescription(
            session=session,
            title=self.title + self._worn_and_seen,
            started_unix_ns=started_unix_ns,
            origin="synthetic",
            protocol=self.protocol,
            task=self.task,
            walkway_m=self.walkway_m,
            conditions=UNSAID,
            estimator=self._estimator,
            walk_path="turning" if self.camera is None else "straight",
            hubs=self._hubs,
            cameras=[] if self.camera is None else [self.camera.camera_description()],
            anthropometry=self._measured_body,
            standing=[],
            reference=reference_channels(self.own_channels, self._seen_channels) if parameters.truth else [],
            duration_s=(self.sample_count - 1) / parameters.rate,
            known_rhythms=[],
        )

    @property
    def _measured_body(self) -> Anthropometry:
        """What a tape says of the body."""
        rng = np.random.default_rng([self.parameters.seed, 8])
        wrong = 1.0 + self.parameters.tape * np.clip(rng.standard_normal(3), -2.5, 2.5)
        true = np.array([self.gait.thigh_length, self.gait.shank_length, self.gait.hip_width])
        thigh, shank, hips = (float(length) for length in true * wrong)
        return Anthropometry(
            height_m=None if self.camera is None else self.camera.stature,
            mass_kg=None,
            thigh_length_m=thigh,
            shank_length_m=shank,
            hip_width_m=hips,
            source="measured",
        )

    @property
    def _worn_and_seen(self) -> str:
        if not self.mounts:
            return ", before a camera alone"
        worn = _WORN_IN_WORDS.get(self.parameters.worn, "") + _MISWORN_IN_WORDS.get(self.parameters.misworn, "")
        return worn if self.camera is None else f"{worn}, before a camera"

    @property
    def _hubs(self) -> list[HubDescription]:
        sensors = [mount.description for mount in self.mounts]
        return [HubDescription(name=HUB, sensors=sensors)] if sensors else []

    @property
    def _estimator(self) -> str:
        if self.camera is not None:
            return "fusion" if self.mounts else "body_cekf"
        return "knee_axis" if self.parameters.worn in (LEFT_LEG, RIGHT_LEG) else "rhythmic_ekf"

    @property
    def _seen_channels(self) -> tuple[str, ...]:
        return () if self.camera is None else self.camera.own_channels

    def strides(self, time_s: Array) -> Strides:
        """Where the person is at any instants."""
        posture = {} if self.camera is None else self.camera.posture
        away = {name: Jet.constant(angle, time_s) for name, angle in posture.items()}
        return Strides(self.timeline.phase(time_s), self.amplitude(time_s), self.timeline.heading(time_s), away)

    def body(self, time_s: Array) -> WalkingBody:
        """The moving body at increasing instants; its path starts at the first of them."""
        return self.moved(self.strides(time_s), time_s)

    def moved(self, strides: Strides, time_s: Array) -> WalkingBody:
        """The body at increasing instants, given where it is in its strides."""
        return self.gait.body(strides, time_s)

    def walking_speed(self, _time_s: Array, strides: Strides) -> Array:
        """m/s (n,), mean over a stride."""
        return np.asarray(self.stride_length(strides.amplitude.value)) * strides.phase.rate

    def samples(self) -> Iterator[Block]:
        """The session from its first sample to its last."""
        start = np.zeros(3)
        for index, first in enumerate(range(0, self.sample_count, BLOCK_SAMPLES)):
            count = min(BLOCK_SAMPLES, self.sample_count - first)
            # One instant more than is delivered tells where the next block's path begins.
            numbers = np.arange(first, first + count + 1)
            time_s = numbers / self.parameters.rate
            captured_ns = np.round(time_s * 1e9).astype(np.int64)[:-1]
            strides = self.strides(time_s)
            body = self.moved(strides, time_s)
            sensors = [self._track(mount, index, body, strides, captured_ns) for mount in self.mounts]
            truth = ReferenceTrack(captured_ns, self._truth(body, strides, start, time_s)[:-1])
            next_ns = round(time_s[-1] * 1e9) if first + count < self.sample_count else captured_ns[-1] + 1
            seen = None if self._skeleton is None else self._skeleton.between(int(captured_ns[0]), int(next_ns))
            yield Block(sensors, truth, seen)
            start = start + body.pelvis.position[-1] * [1, 0, 1]

    def _track(
        self, mount: Mount, block: int, body: WalkingBody, strides: Strides, captured_ns: "np.typing.NDArray[np.int64]"
    ) -> ImuTrack:
        truth = measure(mount, body.segments[mount.segment], *self.soft_tissue(strides))
        rng = np.random.default_rng([self.parameters.seed, 3, mount.number, block])
        rate, force = spoiled(mount, truth, self.parameters, rng)
        drifted = (captured_ns / 1e9)[:, None] * mount.gyro_drift
        there = np.ones(len(captured_ns), dtype=bool) if self.camera is None else self.camera.worn_at(captured_ns)
        return ImuTrack(captured_ns[there], (rate[:-1] + drifted)[there], force[:-1][there])

    @cached_property
    def _skeleton(self) -> SeenFrames | None:
        duration_s = (self.sample_count - 1) / self.parameters.rate
        return None if self.camera is None else self.camera.track(self.body, duration_s)

    def _truth(self, body: WalkingBody, strides: Strides, start: Array, time_s: Array) -> Array:
        walking = strides.phase.rate
        speed = self.walking_speed(time_s, strides)
        columns = [body.angles[dof.name].value for dof in LOWER_BODY]
        columns += [body.contact[side] for side in Side]
        columns += [speed, 2 * math.pi * strides.phase.value, 2 * math.pi * walking]
        points: list[PointMotion] = [body.pelvis, *(body.ankle(side) for side in Side)]
        seen = [] if self.camera is None else [self.camera.truth(body)]
        return np.column_stack([*columns, *(point.position + start for point in points), self.own_truth(time_s), *seen])


def _camera(parameters: SessionParameters) -> "SeenWalker | None":
    if not isinstance(parameters, BeforeCameraParameters) or parameters.camera == NO_CAMERA:
        return None
    # The body's kinematics bring a compiler along, which an ingest without such a session does without.
    from services.ingest.synthetic.whole_body.walker import SeenWalker

    return SeenWalker(parameters)


def reference_channels(own: Iterable[str] = (), angles: Iterable[str] = ()) -> list[ReferenceChannel]:
    """The truth that travels beside the samples; `own` names what only one motion has, `angles` what a camera sees."""
    channels = [(dof.name, "rad") for dof in LOWER_BODY]
    channels += [(f"foot_contact_{side}", "1") for side in Side]
    channels += [("walking_speed", "m/s"), ("stride_phase", "rad"), ("stride_frequency", "rad/s")]
    channels += [(f"{point}_{axis}", "m") for point in ("pelvis", "ankle_left", "ankle_right") for axis in "xyz"]
    channels += [(name, "1") for name in own] + [(name, "rad") for name in angles]
    return [ReferenceChannel(name=name, unit=unit) for name, unit in channels]
