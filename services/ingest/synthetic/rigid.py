"""Rigid bodies in motion: orientation, angular velocity and acceleration down a chain, and points fixed to them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.ingest.synthetic.jets import Array, Jet


@dataclass(frozen=True, slots=True)
class PointMotion:
    """A point over n instants in world axes: position n x 3 m, velocity m/s, acceleration m/s^2."""

    position: Array
    velocity: Array
    acceleration: Array

    def __add__(self, other: "PointMotion") -> "PointMotion":
        return PointMotion(
            self.position + other.position, self.velocity + other.velocity, self.acceleration + other.acceleration
        )


@dataclass(frozen=True, slots=True)
class BodyMotion:
    """A rigid body over n instants: R_world_from_body n x 3 x 3; angular_velocity rad/s and angular_acceleration
    rad/s^2, n x 3, in world axes; its origin."""

    R_world_from_body: Array
    angular_velocity: Array
    angular_acceleration: Array
    origin: PointMotion

    def turned(self, axis_in_body: tuple[float, float, float], angle: Jet) -> "BodyMotion":
        """The body beyond a hinge at the origin, `axis_in_body` a unit vector.

        w' = w + a dq and dw' = dw + a ddq + w x (a dq), with a the axis in world axes (w before the hinge).
        """
        axis = self.R_world_from_body @ np.array(axis_in_body)
        spin = axis * angle.rate[:, None]
        return BodyMotion(
            self.R_world_from_body @ rotation_about(axis_in_body, angle.value),
            self.angular_velocity + spin,
            self.angular_acceleration + axis * angle.acceleration[:, None] + np.cross(self.angular_velocity, spin),
            self.origin,
        )

    def point(self, position_in_body: NDArray[np.float64]) -> PointMotion:
        """A point fixed to the body: v = v0 + w x r, a = a0 + dw x r + w x (w x r)."""
        lever = self.R_world_from_body @ position_in_body
        swirl = np.cross(self.angular_velocity, lever)
        fixed = PointMotion(
            lever, swirl, np.cross(self.angular_acceleration, lever) + np.cross(self.angular_velocity, swirl)
        )
        return self.origin + fixed

    def moved(self, origin: PointMotion) -> "BodyMotion":
        """The same rotation about another origin."""
        return BodyMotion(self.R_world_from_body, self.angular_velocity, self.angular_acceleration, origin)


def at_rest(instants: int) -> BodyMotion:
    """A body at the origin of the world, in its axes."""
    zero = np.zeros((instants, 3))
    return BodyMotion(np.broadcast_to(np.eye(3), (instants, 3, 3)), zero, zero, PointMotion(zero, zero, zero))


def rotation_about(axis: tuple[float, float, float], angle: Array) -> Array:
    """n x 3 x 3 by Rodrigues' formula: 1 + sin q [a] + (1 - cos q) [a]^2."""
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sine, versine = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    return np.asarray(np.eye(3) + sine * skew + versine * (skew @ skew))
