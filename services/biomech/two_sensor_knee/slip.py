"""A sensor that slips on the leg, or is put on anew: axis or arms of late are not those of before.

A slip round the leg, or one that tilts the sensor sideways, turns the axis in it: told by a few seconds of motion. One
about the flexion axis leaves the axis and only changes the angle's zero: there the arm to the knee points elsewhere.
A slow slide of the axis is followed and needs no alarm.
"""

from math import sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.heading import begin_hinge
from services.biomech.two_sensor_knee.hinge_axis import iterate
from services.biomech.two_sensor_knee.joint_centre import is_joint_trusted
from services.biomech.two_sensor_knee.memory import Bench, FloatArray, Memory, Record

ALIKE = 0.7
"""Cosine from which a new axis is still the old one, turned a little: its sense is known."""

LEVELLED_S = 6.0
"""s of levelling before anything is suspected: after a gap inclinations are wrong at first."""

SHORT_ARM = 0.15
"""m. Shorter arms are known to some cm, whatever their length."""


@compiled
def has_slipped(memory: Memory, bench: Bench, is_moving: bool, dt_s: float) -> bool:
    """Whether axis or arms have differed for long enough; to be asked on the grid of the joint, `dt_s` apart."""
    knee, slip, parameters = memory.knee, memory.slip, bench.parameters
    worst = 1.0
    for s in range(2):
        late, axis = slip.axes[s], memory.axes[s]
        if late[0] == 0.0 and late[1] == 0.0 and late[2] == 0.0:
            for i in range(3):
                late[i] = axis[i]
        iterate(slip.scatter[s], late)
        worst = min(worst, abs(late[0] * axis[0] + late[1] * axis[1] + late[2] * axis[2]))
    if memory.levels[0].elapsed_s < LEVELLED_S:
        slip.suspected_s = 0.0
        return False
    if not is_moving or knee.moving_s < parameters.slip_settled_s:
        return False
    if slip.has_arms == 0.0:
        keep_arms(memory, parameters)
    largest = parameters.slip_axis + knee.axis_std
    differs = slip.moving_s >= 0.5 * parameters.slip_time_s and sqrt(max(1.0 - worst * worst, 0.0)) > largest
    for s in range(2):
        differs = differs or arm_shift(memory, s, parameters.shortest_arm) > parameters.slip_arm
    slip.suspected_s = slip.suspected_s + dt_s if differs else 0.0
    return bool(slip.suspected_s >= parameters.slip_suspected_s)


@compiled
def keep_arms(memory: Memory, parameters: Record) -> None:
    """Remember the arms of the settled axis, once the joint has told them."""
    if not is_joint_trusted(memory.knee, parameters):
        return
    memory.slip.has_arms = 1.0
    for s in range(2):
        for i in range(3):
            memory.slip.arms[s, i] = memory.arms[s, i]


@compiled
def arm_shift(memory: Memory, segment: int, shortest: float) -> float:
    """How far the arm has moved across the axis, as a share of the kept one; 0 where that was too short to tell."""
    axis, kept, arm = memory.axes[segment], memory.slip.arms[segment], memory.arms[segment]
    length = across_length(kept[0], kept[1], kept[2], axis)
    if memory.slip.has_arms == 0.0 or length < shortest:
        return 0.0
    shift = across_length(arm[0] - kept[0], arm[1] - kept[1], arm[2] - kept[2], axis)
    return shift / max(length, SHORT_ARM)


@compiled
def across_length(x: float, y: float, z: float, axis: FloatArray) -> float:
    """Length across the axis of (x, y, z)."""
    along = x * axis[0] + y * axis[1] + z * axis[2]
    return sqrt(max(x * x + y * y + z * z - along * along, 0.0))


@compiled
def begin_again(memory: Memory, bench: Bench) -> None:
    """Forget axis, arms, zero and standing; biases and levels stay, and so does the sense of an axis still alike."""
    knee, slip = memory.knee, memory.slip
    if knee.is_sign_known > 0.0 and is_alike(memory):
        for s in range(2):
            for i in range(3):
                memory.leftward[s, i] = memory.axes[s, i]
    begin_hinge(memory, bench, 0.0, 1.0)
    slip.count += 1.0
    slip.moving_s = slip.has_arms = slip.suspected_s = 0.0
    knee.is_tied = knee.joint_moving_s = knee.joint_coherence = knee.has_standing = 0.0
    knee.untied_moving_s = knee.rates_real = knee.rates_imaginary = 0.0
    for i in range(8):
        for k in range(8):
            memory.vertical[i, k] = memory.horizontal_real[i, k] = memory.horizontal_imaginary[i, k] = 0.0
    for s in range(2):
        for i in range(3):
            memory.arms[s, i] = memory.standing[s, i] = slip.axes[s, i] = 0.0
            for k in range(3):
                slip.scatter[s, i, k] = 0.0
    memory.output[2] = memory.output[6] = memory.output[7] = 0.0


@compiled
def is_alike(memory: Memory) -> bool:
    """Whether both axes of late are still those of before, turned a little."""
    smallest = 1.0
    for s in range(2):
        late, axis = memory.slip.axes[s], memory.axes[s]
        smallest = min(smallest, abs(late[0] * axis[0] + late[1] * axis[1] + late[2] * axis[2]))
    return bool(smallest > ALIKE)
