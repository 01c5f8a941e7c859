"""What inertial sensors strapped to the walking body would say, and what spoils it."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from schemas.session import Placement, SensorDescription
from schemas.vocabulary import Segment
from services.ingest.synthetic.jets import Array, Jet
from services.ingest.synthetic.parameters import SessionParameters
from services.ingest.synthetic.rigid import BodyMotion, PointMotion
from services.ingest.units import LOCAL_GRAVITY

UP = np.array([0.0, 1.0, 0.0])

SHANK_WOBBLE_SHARE = 0.4
"""Soft tissue moves less over the shin than over the thigh."""


DRIFT_TIME_S = 600.0
"""Over which the drift of a bias is stated."""

LEFT_LEG, RIGHT_LEG, PELVIS = 1, 2, 3
SWAPPED, THIGH_UPSIDE_DOWN, SHANK_UPSIDE_DOWN = 1, 2, 3
_WORN: dict[int, tuple[Segment, ...]] = {
    LEFT_LEG: (Segment.THIGH_LEFT, Segment.SHANK_LEFT),
    RIGHT_LEG: (Segment.THIGH_RIGHT, Segment.SHANK_RIGHT),
    PELVIS: (Segment.PELVIS,),
}
"""Segments that wear a sensor, by the dial `worn`; all do where it is not listed. Shoes have a dial of their own."""


@dataclass(frozen=True)
class Mount:
    """One sensor: where it sits and how it is turned. Axes of the case: x up the limb, z out of the skin."""

    description: SensorDescription  # as declared
    segment: Segment  # that it is truly worn on
    position: Array  # (3,) m, in that segment
    number: int  # of the place, whatever else is worn: a person's noise is drawn by it
    R_segment_from_sensor: NDArray[np.float64]
    gyro_bias: NDArray[np.float64]  # rad/s at time 0
    gyro_drift: NDArray[np.float64]  # rad/s^2
    accel_bias: NDArray[np.float64]
    wobble_axis: NDArray[np.float64]  # unit vector, segment frame
    wobble: float  # rad
    wobble_phase: float  # rad


# fmt: off
_PLACES: tuple[tuple[str, Segment, Placement, tuple[float, float, float], tuple[float, float, float]], ...] = (
    # name, segment, placement, position in the segment in m, direction out of the skin in the segment
    ("pelvis", Segment.PELVIS, Placement.POSTERIOR, (-0.10, 0.08, 0.0), (-1.0, 0.0, 0.0)),
    ("thigh_right", Segment.THIGH_RIGHT, Placement.ANTERIOR, (0.06, -0.22, 0.02), (1.0, 0.0, 0.0)),
    ("shank_right", Segment.SHANK_RIGHT, Placement.ANTERIOR, (0.04, -0.15, 0.01), (1.0, 0.0, 0.0)),
    ("thigh_left", Segment.THIGH_LEFT, Placement.ANTERIOR, (0.06, -0.22, -0.02), (1.0, 0.0, 0.0)),
    ("shank_left", Segment.SHANK_LEFT, Placement.ANTERIOR, (0.04, -0.15, -0.01), (1.0, 0.0, 0.0)),
    ("foot_right", Segment.FOOT_RIGHT, Placement.UNKNOWN, (0.08, -0.02, 0.0), (0.0, 1.0, 0.0)),
    ("foot_left", Segment.FOOT_LEFT, Placement.UNKNOWN, (0.08, -0.02, 0.0), (0.0, 1.0, 0.0)),
)
# fmt: on


def mounts(parameters: SessionParameters) -> list[Mount]:
    """The sensors of a session, turned and biased at random by its seed."""
    places = [(number, place) for number, place in enumerate(_PLACES) if _is_worn(place[1], parameters)]
    declared = [_mount(parameters, number, *place) for number, place in places]
    return [_misworn(mount, declared, parameters.misworn) for mount in declared]


def _misworn(mount: Mount, declared: list[Mount], how: int) -> Mount:
    """The sensor as it is truly worn."""
    part, _, side = mount.segment.partition("_")
    if how == SWAPPED and part in ("thigh", "shank"):
        other = f"{'shank' if part == 'thigh' else 'thigh'}_{side}"
        return replace(next(each for each in declared if each.segment == other), description=mount.description)
    if (how, part) in ((THIGH_UPSIDE_DOWN, "thigh"), (SHANK_UPSIDE_DOWN, "shank")):
        return replace(mount, R_segment_from_sensor=mount.R_segment_from_sensor @ np.diag([-1.0, -1.0, 1.0]))
    return mount


def _is_worn(segment: Segment, parameters: SessionParameters) -> bool:
    if segment in (Segment.FOOT_LEFT, Segment.FOOT_RIGHT):
        return bool(parameters.feet)
    return parameters.worn not in _WORN or segment in _WORN[parameters.worn]


def _mount(
    parameters: SessionParameters,
    number: int,
    name: str,
    segment: Segment,
    placement: Placement,
    position: tuple[float, float, float],
    outward: tuple[float, float, float],
) -> Mount:
    rng = np.random.default_rng([parameters.seed, 2, number])
    twist = Rotation.from_rotvec(_direction(rng) * rng.uniform(0.0, parameters.mounting)).as_matrix()
    warming = np.random.default_rng([parameters.seed, 4, number])
    share = {"thigh": 1.0, "shank": SHANK_WOBBLE_SHARE}.get(name.partition("_")[0], 0.0)
    return Mount(
        SensorDescription(
            name=name,
            segment=segment,
            rate_hz=parameters.rate,
            outward_axis=[0.0, 0.0, 1.0],
            upward_axis=[1.0, 0.0, 0.0] if _is_upright(np.array(outward)) else None,
            placement=placement,
            position_in_segment=list(position),
        ),
        segment,
        np.array(position),
        number,
        twist @ _nominal(np.array(outward)),
        rng.normal(0.0, parameters.gyro_bias, 3),
        warming.normal(0.0, parameters.gyro_drift / DRIFT_TIME_S, 3),
        rng.normal(0.0, parameters.accel_bias, 3),
        _direction(rng),
        share * parameters.soft_tissue,
        rng.uniform(0.0, 2 * math.pi),
    )


def _direction(rng: np.random.Generator) -> NDArray[np.float64]:
    vector = rng.normal(size=3)
    return np.asarray(vector / np.linalg.norm(vector))


def _is_upright(outward: NDArray[np.float64]) -> bool:
    """Whether a sensor on this side of a standing segment has an axis along it."""
    return bool(abs(outward @ UP) < 0.5)


def _nominal(outward: NDArray[np.float64]) -> NDArray[np.float64]:
    """R_segment_from_sensor with z out of the skin and x up the segment, or backward where the skin faces up."""
    along = UP if _is_upright(outward) else np.array([-1.0, 0.0, 0.0])
    return np.column_stack([along, np.cross(outward, along), outward])


def measure(mount: Mount, body: BodyMotion, phase: Jet, amplitude: Jet) -> tuple[Array, Array]:
    """Perfect angular_velocity rad/s and specific_force m/s^2 of a sensor on a segment, sensor axes, n x 3.

    f = R' (a - g): the acceleration of the sensor's own place, with the centripetal and tangential terms, minus
    gravity. Soft tissue turns the case about an axis of the segment in place.
    """
    cased = _wobbling(mount, body, phase, amplitude)
    spot: PointMotion = body.point(mount.position)
    R_world_from_sensor = cased.R_world_from_body @ mount.R_segment_from_sensor
    return (
        _in_sensor(R_world_from_sensor, cased.angular_velocity),
        _in_sensor(R_world_from_sensor, spot.acceleration + LOCAL_GRAVITY * UP),
    )


def _in_sensor(R_world_from_sensor: Array, vectors: Array) -> Array:
    return np.asarray(np.einsum("nji,nj->ni", R_world_from_sensor, vectors))


def _wobbling(mount: Mount, body: BodyMotion, phase: Jet, amplitude: Jet) -> BodyMotion:
    """e = s A (sin(2 pi p + o) + sin(4 pi p + o) / 2): once and twice per stride, as soft tissue follows the steps."""
    if mount.wobble == 0.0:
        return body

    def swing(x: Array) -> tuple[Array, Array, Array]:
        one, two = 2 * math.pi * x + mount.wobble_phase, 4 * math.pi * x + mount.wobble_phase
        k = 2 * math.pi
        return np.sin(one) + np.sin(two) / 2, k * (np.cos(one) + np.cos(two)), -(k**2) * (np.sin(one) + 2 * np.sin(two))

    x, y, z = mount.wobble_axis.tolist()
    return body.turned((x, y, z), (phase.through(swing) * amplitude).scaled(mount.wobble))


def spoiled(
    mount: Mount, truth: tuple[Array, Array], parameters: SessionParameters, rng: np.random.Generator
) -> tuple[Array, Array]:
    """With bias and white noise."""
    rate, force = truth
    noise = rng.standard_normal((2, *rate.shape))
    return (
        rate + mount.gyro_bias + parameters.gyro_noise * noise[0],
        force + mount.accel_bias + parameters.accel_noise * noise[1],
    )
