"""The four tasks before a camera, as sessions. Pure."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from schemas.conditions import UNSAID
from schemas.session import Anthropometry, ReferenceChannel, SessionDescription
from schemas.vocabulary import ANKLES, WHOLE_BODY, Task
from services.biomech.whole_body.model import LENGTH_NAMES, WholeBodyModel
from services.biomech.whole_body.parameters import lengths_of
from services.ingest.synthetic.block import Block, SeenFrames
from services.ingest.synthetic.whole_body.body import Placed, foothold, place
from services.ingest.synthetic.whole_body.manners import SQUAT, STEPS, TILT_ASIDE, TILT_FORWARD
from services.ingest.synthetic.whole_body.outline import ANKLE_HEIGHT_M, dorsiflexions
from services.ingest.synthetic.whole_body.parameters import SidedParameters, TaskParameters
from services.ingest.synthetic.whole_body.people import Person, person
from services.ingest.synthetic.whole_body.programme import RATE_HZ, Performance, Programme, perform, slow_noise
from services.ingest.synthetic.whole_body.view import Absence, Key, camera_description, frame_times, viewed
from services.ingest.tracks import ReferenceTrack

Array = NDArray[np.float64]

BLOCK_FRAMES = 1000
TRUNK_DRIFT_DEG = 2.0
"""By which the trunk bends aside and twists."""
SWAY_M = 0.006
"""Of a standing body, forward and sideways."""

TASKS = {
    "squat": (SQUAT, Task.SQUAT, "squats with the arms raised"),
    "steps": (STEPS, Task.STEPPING, "steps on the spot"),
    "tilt_forward": (TILT_FORWARD, Task.TRUNK_TILT_SAGITTAL, "bows"),
    "tilt_aside": (TILT_ASIDE, Task.TRUNK_TILT_FRONTAL, "leaning aside"),
}
"""Motion -> the paper's number of the task, the task, and in words."""


class Truth(NamedTuple):
    """What was truly there at n instants."""

    time_s: Array
    q: Array  # (n, 25) m and rad
    placed: Placed
    dorsiflexion: Array  # (n, 2) rad
    repetition: Array  # (n,)
    side: Array  # (n,)


class SyntheticTask:
    """A person who does one of TASKS before a camera."""

    def __init__(self, parameters: TaskParameters) -> None:
        self.parameters = parameters
        self.number, self.task, self.protocol = TASKS[parameters.motion]
        self.title = f"Synthetic {self.protocol}, person {parameters.person} (seed {parameters.seed})"
        self.reference_hz = parameters.frame_rate
        self.key = Key(parameters.seed, parameters.person)

    @cached_property
    def who(self) -> Person:
        """The person."""
        who = person(self.parameters.person)
        return replace(who, amplitude=self.parameters.amplitude) if self.parameters.amplitude else who

    @cached_property
    def performance(self) -> Performance:
        """What the person does, at 30 Hz."""
        rng = np.random.default_rng([*self.key, self.number, 7])
        return perform(self.who, self.number, rng, _programme(self.parameters))

    @property
    def duration_s(self) -> float:
        """s."""
        return (len(self.performance.angles) - 1) / RATE_HZ

    @cached_property
    def truth(self) -> Truth:
        """At the time of every frame, whether it comes or not."""
        angles, repetition, side = self.performance
        rng, n = np.random.default_rng([*self.key, self.number, 8]), len(angles)
        bends, sway = np.radians(TRUNK_DRIFT_DEG * slow_noise(rng, n, 2, 0.3)), SWAY_M * slow_noise(rng, n, 2)
        body = WholeBodyModel(self.who.trunk_joint)
        q = np.concatenate([np.zeros((n, 3)), angles], axis=1)
        floor_m = -self.parameters.camera_height
        hung = place(body, q, self.who.lengths, bends)
        stands = np.array([-self.parameters.distance, floor_m + ANKLE_HEIGHT_M, 0.0])
        q[:, :3] = stands - foothold(hung.centres, lowest=self.number == STEPS)
        q[:, [0, 2]] += sway
        time_s = frame_times(self.parameters, self.key, self.duration_s)
        smooth = CubicSpline(np.arange(n) / RATE_HZ, np.concatenate([q, bends], axis=1))(time_s)
        q, bends = smooth[:, :25], smooth[:, 25:]
        placed = place(body, q, self.who.lengths, bends)
        frames = np.minimum((time_s * RATE_HZ).astype(int), n - 1)
        return Truth(time_s, q, placed, dorsiflexions(placed, floor_m), repetition[frames], side[frames])

    @cached_property
    def seen(self) -> SeenFrames:
        """What the camera delivers."""
        truth, absence = self.truth, Absence(self.parameters.away_at, self.parameters.away_for)
        return viewed(truth.placed, truth.dorsiflexion, truth.time_s, self.parameters, self.key, absence)

    def description(self, session: str = "synthetic", started_unix_ns: int = 0) -> SessionDescription:
        """The session as it would be served live. Of the body only the stature is measured."""
        stature = self.who.stature
        length = dict(zip(LENGTH_NAMES, lengths_of(stature).tolist(), strict=True))
        return SessionDescription(
            session=session,
            title=self.title,
            started_unix_ns=started_unix_ns,
            origin="synthetic",
            protocol=self.protocol,
            task=self.task,
            walkway_m=None,
            conditions=UNSAID,
            estimator="body_cekf",
            walk_path="turning",
            hubs=[],
            cameras=[camera_description(self.parameters)],
            anthropometry=Anthropometry(
                height_m=stature,
                mass_kg=None,
                thigh_length_m=length["thigh_right"],
                shank_length_m=length["shank_right"],
                hip_width_m=2.0 * length["half_pelvis"],
                source="regression",
            ),
            standing=[],
            reference=reference_channels() if self.parameters.truth else [],
            duration_s=self.duration_s,
            known_rhythms=[],
        )

    def samples(self) -> Iterator[Block]:
        """The session, some frames at a time."""
        truth, seen = self.truth, self.seen
        values = np.column_stack(
            [truth.q[:, 3:], truth.dorsiflexion, truth.repetition, truth.side, truth.q[:, :3]],
        )
        captured_ns = np.round(truth.time_s * 1e9).astype(np.int64)
        for first in range(0, len(captured_ns), BLOCK_FRAMES):
            part = slice(first, first + BLOCK_FRAMES)
            times = captured_ns[part]
            frames = seen.between(int(times[0]), int(times[-1]) + 1)
            yield Block([], ReferenceTrack(times, values[part]), frames)


def reference_channels() -> list[ReferenceChannel]:
    """Truth of a task: `repetition` counts from 1, negative where partial, 0 in none; `repetition_side` is 1 to the
    right, -1 to the left, 0 where both sides or none move; `pelvis` is spine_base in the room."""
    channels = [(dof.name, "rad") for dof in (*WHOLE_BODY, *ANKLES)] + [("repetition", "1"), ("repetition_side", "1")]
    return [
        ReferenceChannel(name=name, unit=unit)
        for name, unit in [*channels, *((f"pelvis_{axis}", "m") for axis in "xyz")]
    ]


def _programme(parameters: TaskParameters) -> Programme:
    return Programme(
        repetitions=parameters.repetitions,
        standing_s=parameters.standing,
        period_s=60.0 / parameters.tempo if parameters.tempo else None,
        hold_s=parameters.hold,
        pause_s=parameters.pause,
        set_of=parameters.set_of,
        rest_s=parameters.rest,
        asymmetry=parameters.asymmetry if isinstance(parameters, SidedParameters) else 0.0,
        fatigue=parameters.fatigue,
        slowing=parameters.slowing,
        partials=parameters.partials,
    )
