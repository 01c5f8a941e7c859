"""Knee flexion from two sensors that nobody calibrated: our form of McGrath's self-finding axis.

Steps of one sample, in the order of `sample.py`:

1. bounds and gaps of the input                      sample.py
2. orientation of each sensor, bias, rest            levelling.py
3. the knee as shared point: heading, arms           joint_centre.py
4. axis by principal components, with forgetting     hinge_axis.py
5. heading held by the hinge                         heading.py
6. angle, zero, uncertainty                          flexion.py
7. which way the knee bends                          bending.py
8. whether a sensor has slipped                      slip.py
"""

from enum import StrEnum
from math import radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.biomech.two_sensor_knee.flexion import angle_of_verticals
from services.biomech.two_sensor_knee.memory import (
    OUTPUTS,
    allocate_memory,
    pack_memory,
    prepare_bench,
    unpack_memory,
)
from services.biomech.two_sensor_knee.parameters import KneeAxisParameters
from services.biomech.two_sensor_knee.sample import advance_many
from services.biomech.two_sensor_knee.turns import wrapped
from services.flow.node import State


class Datum(StrEnum):
    """What 0 means."""

    START = "start"  # the pose in which the axis was first seen
    STANDING = "standing"  # quiet standing
    SET = "set"  # the pose that was declared


DATUMS = (Datum.START, Datum.STANDING, Datum.SET)
DATUM_STD = {Datum.STANDING: radians(5.0), Datum.SET: 0.0}
"""rad, beside `flexion_std`: how far a standing knee is from what a laboratory calls straight (-10 to 3 deg on three
people). A pose that was declared is 0 by definition; START has no deviation, its angles are right as changes."""


class KneeReading(NamedTuple):
    """Flexion of one sample, rad and rad/s; positive when the knee bends. `flexion_std` is that of its changes: the
    datum has a deviation of its own (DATUM_STD)."""

    flexion: float
    flexion_std: float
    is_valid: bool
    flexion_rate: float
    axis_std: float  # rad
    is_sign_known: bool
    datum: Datum


class KneeAxis:
    """Knee flexion of one leg (see the head of this file).

    Sensor 0 is worn on the thigh, sensor 1 on the shank, each in any orientation. Intervals between samples may vary.
    """

    def __init__(self, parameters: KneeAxisParameters = KneeAxisParameters()) -> None:  # noqa: B008 (frozen)
        self.parameters = parameters
        self._memory = allocate_memory(parameters)
        self._bench = prepare_bench(parameters)
        # One sample's room, reused: what is compiled for many takes one, too, so that both agree to the last bit.
        self._rate, self._force, self._interval_s = np.zeros((1, 2, 3)), np.zeros((1, 2, 3)), np.zeros(1)
        self._out = np.zeros((1, len(OUTPUTS)))

    def step(self, rate: NDArray[np.float64], force: NDArray[np.float64], dt_s: float) -> KneeReading:
        """Take one sample: rate (2, 3) rad/s, specific force (2, 3) m/s^2, dt_s after the sample before."""
        self._rate[0], self._force[0], self._interval_s[0] = rate, force, dt_s
        advance_many(self._memory, self._bench, self._rate, self._force, self._interval_s, self._out)
        return _reading(self._out[0].tolist())

    def run(
        self, rate: NDArray[np.float64], force: NDArray[np.float64], dt_s: float | NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Take samples, rate and force (n, 2, 3), dt_s for each (n,) or for all; OUTPUTS of each as (n, 8)."""
        out = np.zeros((rate.shape[0], len(OUTPUTS)))
        intervals_s = _plain(np.broadcast_to(np.asarray(dt_s, dtype=np.float64), len(out)))
        advance_many(self._memory, self._bench, _plain(rate), _plain(force), intervals_s, out)
        return out

    def reading(self) -> KneeReading:
        """The reading of the last sample."""
        return _reading(self._memory["output"][0].tolist())

    def declare_zero(self) -> None:
        """The pose of the last sample is 0 from now on."""
        knee = self._memory["knee"][0]
        knee["zero"], knee["is_zero_set"] = knee["angle"], 1.0
        self._memory["output"][0, OUTPUTS.index("datum")] = DATUMS.index(Datum.SET)

    def declare_standing(self, up: NDArray[np.float64]) -> None:
        """0 is where both verticals, up (2, 3) in the frame of each sensor, are one; nothing before there is an angle.

        Unlike `declare_zero` it may be told of a pose long ago, and again when the axes have become better.
        """
        knee = self._memory["knee"][0]
        if knee["has_angle"] == 0.0:
            return
        standing = angle_of_verticals(_plain(up), self.axes, np.array(self._memory["across"][0]))
        knee["zero"] = knee["angle"] + wrapped(standing - knee["angle"])
        knee["is_zero_set"] = 1.0
        self._memory["output"][0, OUTPUTS.index("datum")] = DATUMS.index(Datum.SET)

    def declare_mounting(self, leftward: NDArray[np.float64], upward: NDArray[np.float64]) -> None:
        """Say roughly how the sensors are worn, for legs that do not show which way they bend, as a seated one.

        Args:
            leftward: (2, 3) the person's left in each sensor; a row of zeros where it is not known.
            upward: (2, 3) up the segment, towards the hip, in each sensor; likewise.
        """
        self._memory["leftward"][0], self._memory["upward"][0] = leftward, upward

    def rewind(self, rate: NDArray[np.float64], force: NDArray[np.float64], dt_s: float | NDArray[np.float64]) -> None:
        """Go back to before these samples, the last ones that were taken, with all that has been found by now.

        Taking them once more then gives their angles with the axis, arms, biases, sense and zero that were found later.
        Both sensors are levelled and tied backwards through the samples, so that the first ones have their
        inclination, too; nothing is learned from them a second time.

        Args:
            rate, force, dt_s: as of `run`.

        Raises:
            ValueError: no axis has been found yet.
        """
        knee, levels = self._memory["knee"][0], self._memory["levels"][0]
        if knee["has_angle"] == 0.0:
            raise ValueError("no axis has been found yet: take samples until a reading is valid, then rewind")
        intervals_s = np.broadcast_to(np.asarray(dt_s, dtype=np.float64), len(rate))
        known_s = float(intervals_s.sum())
        # From the time of sample k back to that of k - 1 its turn is undone; there the force of k - 1 is felt.
        backwards = (2.0 * levels["bias"] - rate)[::-1]
        felt = np.concatenate([force[-2::-1], force[:1]])
        knee["unused_s"], knee["known_s"] = 0.0, np.inf
        self.run(backwards, felt, intervals_s[::-1])
        knee["unused_s"], knee["known_s"], knee["has_sample"] = 0.0, known_s, 0.0
        levels["rest_s"] = 0.0
        self._memory["joint_fast"], self._memory["joint"] = 0.0, 0.0

    @property
    def has_angle(self) -> bool:
        """Whether the reading is of the last sample: the axis has been found, however well."""
        return bool(self._memory["knee"][0]["has_angle"] > 0.0)

    @property
    def is_joint_known(self) -> bool:
        """Whether the arms can be believed: enough of the knee's motion was seen, and both sensors agree on it."""
        knee, parameters = self._memory["knee"][0], self.parameters
        has_moved = knee["joint_moving_s"] >= parameters.joint_motion_s
        return bool(has_moved and knee["joint_coherence"] >= parameters.joint_coherence)

    @property
    def slips(self) -> int:
        """How often a sensor was found to have slipped: each time axis, arms, standing and zero were given up."""
        return int(self._memory["slip"][0]["count"])

    @property
    def axes(self) -> NDArray[np.float64]:
        """Flexion axis in the frame of each sensor, (2, 3); zeros before any motion."""
        return np.array(self._memory["axes"][0])

    @property
    def arms(self) -> NDArray[np.float64]:
        """From each sensor to the knee, m, in the frame of the sensor, (2, 3); zeros before any motion."""
        return np.array(self._memory["arms"][0])

    @property
    def up(self) -> NDArray[np.float64]:
        """The vertical in the frame of each sensor, (2, 3), at the last sample."""
        w, x, y, z = self._memory["levels"]["quat"][0].T
        return np.stack([2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)], axis=1)

    @property
    def standing(self) -> NDArray[np.float64]:
        """The vertical in the frame of each sensor at the tallest rest, (2, 3); zeros without one."""
        return np.array(self._memory["standing"][0])

    @property
    def gyro_bias(self) -> NDArray[np.float64]:
        """Of each sensor, (2, 3) rad/s."""
        return np.array(self._memory["levels"]["bias"][0])

    @property
    def R_thigh_from_shank(self) -> NDArray[np.float64]:
        """Relative orientation of the sensors at the last sample, (3, 3); zeros before the headings are tied."""
        return np.array(self._memory["relative"][0])

    def snapshot(self) -> State:
        """Everything that changes, as JSON values."""
        return pack_memory(self._memory)

    def restore(self, state: State) -> None:
        """Go on from a snapshot."""
        unpack_memory(state, self._memory)


def _reading(output: list[float]) -> KneeReading:
    flexion, std, is_valid, rate, axis_std, _, is_sign_known, datum = output
    return KneeReading(flexion, std, is_valid > 0.0, rate, axis_std, is_sign_known > 0.0, DATUMS[int(datum)])


def _plain(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    """The one layout that is compiled for: another would be compiled anew."""
    return np.ascontiguousarray(samples, dtype=np.float64)
