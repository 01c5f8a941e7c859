"""The walking body: joint angles from phase and amplitude, and a pelvis that goes where the standing foot lets it.

The horizontal velocity of the pelvis is minus that of the supporting points of the feet, seen from the pelvis, and
its height is minus theirs; so the loaded foot neither slides nor sinks. In double support the load moves smoothly
from one foot to the other.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.vocabulary import LOWER_BODY, PELVIS_ROTATIONS, Segment, Side
from services.ingest.synthetic.curves import STANCE, WALKING, GaitCurves, support_curve
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.rigid import BodyMotion, PointMotion, at_rest

HEEL_FROM_ANKLE = np.array([-0.05, -0.08, 0.0])
"""m, foot frame, flat foot: where the heel touches the ground."""
BALL_FROM_ANKLE = np.array([0.13, -0.08, 0.0])
"""m, foot frame: where the forefoot touches the ground."""

OFF_BEAT = 0.08
"""Stride share by which the left foot lands late, per unit of asymmetry."""

_LATERAL = {Side.RIGHT: 1.0, Side.LEFT: -1.0}


class Strides(NamedTuple):
    """Where the walker is: phase in strides of the right leg, amplitude 0 standing .. 1 as drawn, heading rad.

    `posture` adds to joint angles, rad by degree of freedom: how far the body is from upright, beside its striding.
    """

    phase: Jet
    amplitude: Jet
    heading: Jet
    posture: Mapping[str, Jet] = {}


@dataclass(frozen=True)
class WalkingBody:
    """Everything over n instants: angles in rad by degree of freedom, segments, contact by side (0 or 1)."""

    angles: dict[str, Jet]
    segments: dict[Segment, BodyMotion]
    contact: dict[Side, Array]

    @property
    def pelvis(self) -> PointMotion:
        """Midpoint of the hips. Its horizontal position counts from the first instant."""
        return self.segments[Segment.PELVIS].origin

    def ankle(self, side: Side) -> PointMotion:
        """Ankle centre."""
        return self.segments[Segment(f"foot_{side}")].origin


@dataclass(frozen=True)
class Gait:
    """A body and its way of moving. Lengths in m; `asymmetry` as in WalkParameters."""

    thigh_length: float
    shank_length: float
    hip_width: float
    asymmetry: float = 0.0
    curves: GaitCurves = WALKING

    def angles(self, strides: Strides) -> dict[str, Jet]:
        """The 15 coordinates of LOWER_BODY, in order; the heading is part of the pelvis rotation."""
        found: dict[str, Jet] = {}
        curves = self.curves.joints
        for dof in LOWER_BODY:
            name, _, side = dof.name.rpartition("_")
            paired = name in curves
            phase = self._leg_phase(strides.phase, Side(side)) if paired else strides.phase
            amplitude = strides.amplitude
            if paired and name.endswith("flexion"):
                amplitude = amplitude.scaled(self._vigour(Side(side)))
            found[dof.name] = phase.through(curves[name if paired else dof.name]) * amplitude
        found["pelvis_rotation"] = found["pelvis_rotation"] + strides.heading
        return found | {name: found[name] + away for name, away in strides.posture.items()}

    def body(self, strides: Strides, time_s: Array | None = None) -> WalkingBody:
        """The moving body. Without times the pelvis keeps its horizontal position at zero (its velocity is right)."""
        angles = self.angles(strides)
        hung = self._hung_from_pelvis(angles, strides)
        pelvis = self._pelvis(hung, strides)
        if time_s is not None:
            pelvis = _travelled(pelvis, time_s)
        segments = {segment: body.moved(body.origin + pelvis) for segment, body in hung.items()}
        contact = {side: self._contact(strides, side) for side in Side}
        return WalkingBody(angles, segments, contact)

    def stride_length(self, amplitudes: NDArray[np.float64], instants: int = 120) -> NDArray[np.float64]:
        """m per stride of a steady straight walk at each amplitude: the mean of dx/dphase over one stride."""
        phase = np.tile(np.arange(instants) / instants, len(amplitudes))
        steady = Jet(phase, np.ones_like(phase), np.zeros_like(phase))
        held = np.repeat(amplitudes, instants)
        amplitude = Jet(held, np.zeros_like(held), np.zeros_like(held))
        forward = self.body(Strides(steady, amplitude, Jet.constant(0.0, phase))).pelvis.velocity[:, 0]
        return np.asarray(forward.reshape(len(amplitudes), instants).mean(axis=1))

    @property
    def opposite_contact(self) -> float:
        """Phase of the right leg at which the left foot lands."""
        return 0.5 + OFF_BEAT * self.asymmetry

    def _vigour(self, side: Side) -> float:
        return 1.0 - self.asymmetry if side is Side.LEFT else 1.0

    def _leg_phase(self, phase: Jet, side: Side) -> Jet:
        shift = 0.0 if side is Side.RIGHT else -self.opposite_contact
        return Jet((phase.value + shift) % 1.0, phase.rate, phase.acceleration)

    def _contact(self, strides: Strides, side: Side) -> Array:
        down = self._leg_phase(strides.phase, side).value < STANCE
        return np.where(down | (strides.amplitude.value == 0), 1.0, 0.0)

    def _hung_from_pelvis(self, angles: dict[str, Jet], strides: Strides) -> dict[Segment, BodyMotion]:
        return hung_legs(self, angles, {side: self._foot(strides, side) for side in Side})

    def _foot(self, strides: Strides, side: Side) -> BodyMotion:
        """The foot keeps to the heading and pitches against the ground, whatever the shank does above it."""
        pitch = self._leg_phase(strides.phase, side).through(self.curves.foot_pitch) * strides.amplitude
        level = at_rest(len(strides.phase.value)).turned((0, 1, 0), strides.heading)
        return level.turned((0, 0, 1), pitch.scaled(self._vigour(side)))

    def _pelvis(self, hung: dict[Segment, BodyMotion], strides: Strides) -> PointMotion:
        instants = len(strides.phase.value)
        position, velocity, acceleration = np.zeros((instants, 3)), np.zeros((instants, 3)), np.zeros((instants, 3))
        for load, point in self._supports(hung, strides):
            w, dw, ddw = load.value[:, None], load.rate[:, None], load.acceleration[:, None]
            position -= w * point.position
            velocity -= w * point.velocity
            acceleration -= w * point.acceleration + dw * point.velocity
            # The height follows from positions, not velocities, so its derivatives have the load's as well.
            velocity[:, 1:2] -= dw * point.position[:, 1:2]
            acceleration[:, 1:2] -= dw * point.velocity[:, 1:2] + ddw * point.position[:, 1:2]
        position[:, [0, 2]] = 0.0
        return PointMotion(position, velocity, acceleration)

    def _supports(self, hung: dict[Segment, BodyMotion], strides: Strides) -> list[tuple[Jet, PointMotion]]:
        """Heel and ball of each foot with the share of the body that each carries; the shares add up to one."""
        right = self._leg_phase(strides.phase, Side.RIGHT).through(support_curve(self.opposite_contact))
        loads = {Side.RIGHT: right, Side.LEFT: right.scaled(-1.0).shifted(1.0)}
        supports = []
        for side, load in loads.items():
            forefoot = self._leg_phase(strides.phase, side).through(self.curves.onto_forefoot)
            foot = hung[Segment(f"foot_{side}")]
            supports.append((load * forefoot, foot.point(BALL_FROM_ANKLE)))
            supports.append((load * forefoot.scaled(-1.0).shifted(1.0), foot.point(HEEL_FROM_ANKLE)))
        return supports


def hung_legs(body_of: Gait, angles: Mapping[str, Jet], feet: Mapping[Side, BodyMotion]) -> dict[Segment, BodyMotion]:
    """All segments with the pelvis held at the origin; `feet` are turned as they are in the room."""
    body = at_rest(len(angles["pelvis_rotation"].value))
    for dof in PELVIS_ROTATIONS:
        body = body.turned(dof.axis, angles[dof.name])
    found = {Segment.PELVIS: body}
    for side in Side:
        hip = body.point(np.array([0.0, 0.0, _LATERAL[side] * body_of.hip_width / 2]))
        thigh = _through_joint(body.moved(hip), "hip", side, angles)
        knee = thigh.point(np.array([0.0, -body_of.thigh_length, 0.0]))
        shank = _through_joint(thigh.moved(knee), "knee", side, angles)
        ankle = shank.point(np.array([0.0, -body_of.shank_length, 0.0]))
        found[Segment(f"thigh_{side}")] = thigh
        found[Segment(f"shank_{side}")] = shank
        found[Segment(f"foot_{side}")] = feet[side].moved(ankle)
    return found


def _through_joint(parent: BodyMotion, joint: str, side: Side, angles: Mapping[str, Jet]) -> BodyMotion:
    body = parent
    for dof in LOWER_BODY:
        if dof.name.startswith(joint) and dof.name.endswith(side):
            body = body.turned(dof.axis, angles[dof.name])
    return body


def _travelled(pelvis: PointMotion, time_s: Array) -> PointMotion:
    """Horizontal position by quadrature: dp = h (v0 + v1) / 2 + h^2 (a0 - a1) / 12, exact to the fourth order."""
    h = np.diff(time_s)[:, None]
    v, a = pelvis.velocity, pelvis.acceleration
    steps = h * (v[:-1] + v[1:]) / 2 + h**2 * (a[:-1] - a[1:]) / 12
    path = np.vstack([np.zeros(3), np.cumsum(steps, axis=0)])
    path[:, 1] = pelvis.position[:, 1]
    return PointMotion(path, v, a)
