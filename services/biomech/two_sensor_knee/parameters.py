"""Tunables of the two-sensor knee.

Sources: [L] Laidig and Seel 2023 (VQF), whose choices for the same quantity are taken; [T] chosen on weygers_hinge 02
and on synthetic legs, and on others where it says so. The gates of the first tie, of sign, zero and slip were set with
the worn recordings in view, too: they decide when an angle is believed, not how good it then is.
"""

from dataclasses import dataclass
from math import radians


@dataclass(frozen=True)
class LevelParameters:
    """Orientation of one sensor without magnetometer (`levelling.py`)."""

    level_time_s: float = 2.1
    """s. Each of two low-passes of the specific force in the levelled frame. [L] has a Butterworth of 3 s, whose
    corner is that of two poles of 2.1 s."""
    tilt_rate: float = 0.15
    """1/s. How fast the force of the instant turns the world upright, beside its mean. weygers_hinge 02, landings and
    single steps agree on 0.1 to 0.2; 0 is the mean alone, as in [L]."""
    start_bias_std: float = radians(0.5)
    """rad/s. [L]"""
    bias_wander: float = radians(0.1)
    """rad/s that a bias may wander in `bias_time_s`. [L]"""
    bias_time_s: float = 100.0
    """s. [L]"""
    bias_std_in_motion: float = radians(0.1)
    """rad/s. What levelling tells about the bias in the long run. [L]"""
    bias_std_at_rest: float = radians(0.03)
    """rad/s. What rest tells. [L]"""
    largest_bias: float = radians(2.0)
    """rad/s. Larger is taken for slow motion. [L]"""
    calm_time_s: float = 0.5
    """s. Low-pass that rest is measured against. [L]"""
    calm_rate: float = radians(2.0)
    """rad/s. Largest deviation of the rate at rest. [L]"""
    calm_force: float = 0.5
    """m/s^2. Largest deviation of the specific force at rest. [L]"""
    calm_s: float = 1.5
    """s that calm must last to be rest. [L]"""


@dataclass(frozen=True)
class JointParameters:
    """The point that both segments share (`joint_centre.py`)."""

    joint_cutoff_hz: float = 8.0
    """Hz of each of two low-passes. Above, soft tissue rings. [T]"""
    joint_interval_s: float = 0.04
    """s between products."""
    joint_memory_s: float = 20.0
    """s. [T]"""
    arm_std: float = 0.3
    """m. Prior deviation of a sensor's distance from the knee in each direction."""
    joint_noise: float = 1.0
    """m/s^2. Disagreement of the two accelerations of the joint against which `arm_std` is weighed. [T]"""
    joint_solve_s: float = 0.5
    """s between solutions."""
    joint_motion_s: float = 1.5
    """s of motion before a first solution is believed. [T]"""
    joint_power: float = 0.05
    """(m/s^2)^2. Mean square horizontal acceleration of the joint that counts as motion. [T]"""
    joint_coherence: float = 0.5
    """Share of the acceleration that both sensors must agree on. [T]"""


@dataclass(frozen=True)
class HingeParameters:
    """Axis, heading and angle (`hinge_axis.py`, `heading.py`, `knee_axis.py`)."""

    axis_memory_s: float = 60.0
    """s of motion after which the axis is forgotten."""
    moving_rate: float = 0.3
    """rad/s. A relative rate above counts as motion."""
    gathering_s: float = 1.0
    """s of motion before the axis ties the headings and the angle begins."""
    axis_correlation_s: float = 0.3
    """s after which off-axis motion is new information. [T]"""
    axis_systematic_share: float = 0.3
    """Share of the off-axis motion that never averages out: soft tissue moves with the knee. [T]"""
    axis_floor: float = radians(0.7)
    """rad. Below, sensors' own axes are not square."""
    axis_to_tie: float = radians(40.0)
    """rad. Uncertainty of the axis at which it begins to tie the headings."""
    axis_to_believe: float = radians(25.0)
    """rad. Uncertainty of the axis at which the angle becomes valid."""
    untied_s: float = 3.0
    """s of motion after which the headings are tied without the joint."""
    heading_time_s: float = 3.0
    """s. Averaging of the heading told by a horizontal axis; longer as the axis becomes upright. [T]"""
    heading_drift: float = radians(0.3)
    """rad in one second that the headings may part. Sets the deviation of the heading, not its averaging."""
    heading_error: float = 1.0
    """rad. Difference from the joint's heading at which the tie is taken for a wrong one."""
    heading_contradictions: int = 6
    """Solutions in a row that must contradict."""
    level_std: float = radians(1.0)
    """rad. Inclination of one sensor. [T]"""
    level_start_std: float = radians(6.0)
    """rad. Inclination told by one second of accelerometer in motion. [T]"""
    sign_evidence: float = 0.5
    """Evidence from which the sign is known; 0 takes the sign as it comes."""
    sample_delay_s: float = 0.005
    """s by which a sample's meaning is older than its time stamp, beyond the interval it is the mean of. [T]"""
    taller: float = 0.03
    """m by which a later rest must be taller to become the standing datum."""
    upright_share: float = 0.6
    """Share of a sensor's arm to the knee that must be vertical for a rest to be standing."""
    shortest_arm: float = 0.08
    """m. A shorter arm to the knee was not seen well: nothing is concluded from its direction."""
    one_sided: float = 0.5
    """Deviations of the moving angle by which its mean must differ from that of a rest for it to be standing."""
    slip_time_s: float = 3.0
    """s of motion that tell the axis of late."""
    slip_settled_s: float = 6.0
    """s of motion after which a slip can be told."""
    slip_axis: float = radians(7.0)
    """rad, beside its own deviation, by which the axis of late must differ. [T]; 5.6 on walking people"""
    slip_arm: float = 0.3
    """Share of an arm to the knee by which it must have moved: 17 degrees of turn. [T]; 0.26 on a person who lands"""
    slip_suspected_s: float = 1.0
    """s of motion in which either must differ without a break."""
    gap_s: float = 0.5
    """s. After a longer interval without samples both sensors are levelled anew."""
    largest_rate: float = 70.0
    """rad/s. Larger is no leg."""
    largest_force: float = 400.0
    """m/s^2. Larger is no leg."""


@dataclass(frozen=True)
class KneeAxisParameters(LevelParameters, JointParameters, HingeParameters):
    """All tunables of `KneeAxis`."""
