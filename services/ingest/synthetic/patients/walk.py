"""A patient's walk as a session: footfalls are planned, the body follows them, sensors feel it."""

from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from schemas.conditions import UNSAID, Conditions
from schemas.session import SessionDescription
from schemas.vocabulary import LOWER_BODY, PELVIS_ROTATIONS, Segment, Side
from services.ingest.errors import InvalidOption
from services.ingest.synthetic.curves import JOINT_CURVES
from services.ingest.synthetic.gait import Gait, Strides, WalkingBody, hung_legs
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.kinds import HEALTHY, HEMIPARETIC, KINDS
from services.ingest.synthetic.parameters import WalkParameters
from services.ingest.synthetic.patients.foot_path import FootPath, foot_path, heel_rise
from services.ingest.synthetic.patients.footfalls import Footfalls, plan_footfalls
from services.ingest.synthetic.patients.limbs import LegAngles, leg_angles
from services.ingest.synthetic.patients.manners import Manner, manner
from services.ingest.synthetic.patients.pelvis_path import LegLengths, PelvisPath, pelvis_path
from services.ingest.synthetic.rigid import BodyMotion, PointMotion, at_rest
from services.ingest.synthetic.session import SyntheticSession
from services.ingest.synthetic.tempo import jet_of
from services.ingest.synthetic.timeline import Timeline

PLANNED_HZ = 250.0
"""At which the body's posture is solved; between, splines that are smooth to the second derivative."""
LONGEST_S = 1800.0
"""s of a session: its plan is held in memory."""
STATURE_SPREAD, PROPORTION_SPREAD = 0.06, 0.025
"""Relative standard deviations of a person's size, and of each segment at that size."""
LIFTS_M = (0.0, 0.35)
"""m between which a foot's lift is looked for."""
CLEARANCE_M = 0.01
"""m above the floor that heel and ball keep in swing at least, once they have left it."""


def body_of(parameters: WalkParameters) -> LegLengths:
    """Of one person: the dials' lengths times what the seed draws."""
    rng = np.random.default_rng([parameters.seed, 7])
    size = 1.0 + float(np.clip(rng.normal(0.0, STATURE_SPREAD), -0.15, 0.15))
    own = 1.0 + np.clip(rng.normal(0.0, PROPORTION_SPREAD, 3), -0.06, 0.06)
    nominal = np.array([parameters.thigh_length, parameters.shank_length, parameters.hip_width])
    return LegLengths(*(float(length) for length in nominal * size * own))


class PatientWalk(SyntheticSession):
    """Quiet standing, then walking straight on in one of the manners of KINDS."""

    protocol = "quiet standing, then walking straight on"

    def __init__(self, parameters: WalkParameters) -> None:
        refused = {name: getattr(parameters, name) for name in ("camera", "turn_every", "asymmetry")}
        if any(refused.values()):
            raise InvalidOption(f"patient: {', '.join(refused)} are of the plain walker; leave them or patient out")
        if parameters.duration > LONGEST_S:
            raise InvalidOption(f"duration: a patient walks for {LONGEST_S:g} s at most")
        self.affected = Side.LEFT if parameters.affected == 1 else Side.RIGHT
        self.manner: Manner = manner(parameters.patient, self.affected, parameters.speed, parameters.seed)
        self.speed = parameters.speed
        self.lengths = body_of(parameters)
        super().__init__(parameters, Timeline.plan(parameters), Gait(*self.lengths))
        self.kind = KINDS[parameters.patient]
        who = "Synthetic walker" if parameters.patient == HEALTHY else f"Synthetic patient, {self.kind}"
        self.title = f"{who}, at {parameters.speed:g} m/s (seed {parameters.seed})"
        self.footfalls: Footfalls = plan_footfalls(
            self.manner, parameters.speed, self.lengths.hip_width, self.lengths.thigh + self.lengths.shank,
            self.timeline.bouts, parameters.seed,
        )  # fmt: skip

    def description(self, session: str = "synthetic", started_unix_ns: int = 0) -> SessionDescription:
        """With the paretic side of somebody who has one."""
        described = super().description(session, started_unix_ns)
        side = self.affected if self.kind == KINDS[HEMIPARETIC] else None
        conditions = Conditions.model_validate({**UNSAID.model_dump(), "paretic_side": side})
        return described.model_copy(update={"conditions": conditions})

    def amplitude(self, time_s: Array) -> Jet:
        """0 standing, 1 walking."""
        return jet_of(self._plan.amplitude, time_s)

    def strides(self, time_s: Array) -> Strides:
        """Whole strides at the contacts of the right foot."""
        return Strides(jet_of(self._plan.phase, time_s), self.amplitude(time_s), Jet.constant(0.0, time_s))

    def walking_speed(self, time_s: Array, _strides: Strides) -> Array:
        """m/s of the pelvis forward, over the steps between contacts."""
        return self._plan.mean_speed(time_s)

    def moved(self, _strides: Strides, time_s: Array) -> WalkingBody:
        """The body as planned; its path starts at the first of the instants."""
        plan = self._plan
        angles = {name: jet_of(spline, time_s) for name, spline in plan.angles.items()}
        feet = {
            side: at_rest(len(time_s)).turned((0, 0, 1), jet_of(spline, time_s)) for side, spline in plan.pitch.items()
        }
        hung = hung_legs(self.gait, angles, feet)
        axes = [jet_of(spline, time_s) for spline in plan.pelvis]
        position, velocity, acceleration = (
            np.column_stack([getattr(jet, part) for jet in axes]) for part in ("value", "rate", "acceleration")
        )
        pelvis = PointMotion(position - position[0] * [1.0, 0.0, 1.0], velocity, acceleration)
        segments: dict[Segment, BodyMotion] = {name: one.moved(one.origin + pelvis) for name, one in hung.items()}
        return WalkingBody(angles, segments, {side: self._contact(side, time_s) for side in Side})

    def _contact(self, side: Side, time_s: Array) -> Array:
        falls = self.footfalls.by_side[side]
        down = [(time_s >= fall.contact_s) & (time_s < fall.toe_off_s) for fall in falls]
        contact: Array = np.any(down, axis=0).astype(np.float64)
        return contact

    @cached_property
    def _plan(self) -> "_Plan":
        return _Plan(self)


class _Plan:
    """Posture over the whole session, as splines over time."""

    def __init__(self, walk: PatientWalk) -> None:
        self._walk = walk
        self.time_s = np.arange(0.0, walk.parameters.duration + 2.0 / PLANNED_HZ, 1.0 / PLANNED_HZ)
        self._rise = {side: self._heel_rise(side) for side in Side}
        lift = {side: self._lift(side, self._within(12.0)) for side in Side}
        feet, path = self._posed(lift, self.time_s)
        self.angles = self._splines(feet, path)
        self.pitch = {side: CubicSpline(self.time_s, foot.pitch) for side, foot in feet.items()}
        self.pelvis = [CubicSpline(self.time_s, column) for column in path.position.T]
        self.phase = CubicSpline(self.time_s, path.phase)
        self.amplitude = CubicSpline(self.time_s, path.amplitude)

    def mean_speed(self, time_s: Array) -> Array:
        """m/s of the pelvis from half a stride before to half a stride after."""
        half = 1.0 / (2.0 * self._walk.timeline.frequency_hz)
        ends = [np.clip(time_s + way * half, self.time_s[0], self.time_s[-1]) for way in (-1.0, 1.0)]
        gone = self.pelvis[0](ends[1]) - self.pelvis[0](ends[0])
        speed: Array = gone / (ends[1] - ends[0])
        return speed

    def _heel_rise(self, side: Side) -> float:
        """rad, for the usual stance and swing of this leg."""
        falls = self._walk.footfalls.by_side[side]
        stances = [fall.toe_off_s - fall.contact_s for fall in falls[1:-1]]
        swings = [then.contact_s - now.toe_off_s for now, then in pairwise(falls)]
        if not stances:
            return 0.0
        leg, speed = self._walk.manner.legs[side], self._walk.speed
        return leg.push * heel_rise(leg, speed, float(np.median(stances)), float(np.median(swings)))

    def _within(self, seconds: float) -> Array:
        """The first seconds of walking, in which how high the feet swing is found."""
        bouts = self._walk.timeline.bouts
        if not bouts:
            return self.time_s
        return self.time_s[self.time_s < bouts[0].start_s + seconds]

    def _posed(self, lift: dict[Side, float], time_s: Array) -> tuple[dict[Side, FootPath], PelvisPath]:
        walk, how = self._walk, self._walk.manner
        speed = walk.speed
        feet = {
            side: foot_path(falls, how.legs[side], lift[side], self._rise[side], speed, time_s)
            for side, falls in walk.footfalls.by_side.items()
        }
        return feet, pelvis_path(walk.footfalls, walk.timeline.bouts, how, walk.lengths, feet, time_s)

    def _lift(self, side: Side, time_s: Array) -> float:
        """m by which this foot is lifted so that its knee bends as the manner says."""
        wanted = self._walk.manner.legs[side].knee_in_swing

        def missing(lift: float) -> float:
            feet, path = self._posed(dict.fromkeys(Side, lift), time_s)
            knee = self._leg(side, feet[side], path).knee_flexion
            swing = feet[side].swing
            peaks = [float(knee[part].max()) for part in _runs(swing > 0)]
            return float(np.median(peaks)) - wanted if peaks else 0.0

        low, high = LIFTS_M
        if missing(low) >= 0.0:
            return low
        return float(brentq(missing, low, high, xtol=1e-4)) if missing(high) > 0.0 else high

    def _leg(self, side: Side, foot: FootPath, path: PelvisPath) -> LegAngles:
        return leg_angles(path, side, foot.ankle, self._internal(side, path), self._walk.lengths)

    def _internal(self, side: Side, path: PelvisPath) -> Array:
        leg_phase = path.phase if side is Side.RIGHT else path.phase - 0.5
        return np.asarray(JOINT_CURVES["hip_internal_rotation"](leg_phase % 1.0)[0] * path.amplitude)

    def _splines(self, feet: dict[Side, FootPath], path: PelvisPath) -> dict[str, CubicSpline]:
        values = {dof.name: np.zeros_like(self.time_s) for dof in LOWER_BODY}
        for dof, turned in zip(PELVIS_ROTATIONS, (path.rotation, path.tilt, path.obliquity), strict=True):
            values[dof.name] = turned
        for side, foot in feet.items():
            leg = self._leg(side, foot, path)
            values |= {f"{name}_{side}": angle for name, angle in leg._asdict().items()}
            values[f"hip_internal_rotation_{side}"] = self._internal(side, path)
        return {name: CubicSpline(self.time_s, value) for name, value in values.items()}


def _runs(true: "np.typing.NDArray[np.bool_]") -> list[slice]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], true, [False]]).astype(int)))
    return [slice(int(a), int(b)) for a, b in zip(edges[::2], edges[1::2], strict=True)]
