"""The words of the field as Ambula uses them: segments, degrees of freedom with their positive direction, events.

Frames are ISB for the world and for every segment, never mirrored: x forward, y up, z right
(clinical conventions: Wu et al. 2002; the same axes as OpenSim).
"""

from dataclasses import dataclass
from enum import StrEnum


class Side(StrEnum):
    """Body side."""

    LEFT = "left"
    RIGHT = "right"

    @property
    def other(self) -> "Side":
        """The opposite side."""
        return Side.RIGHT if self is Side.LEFT else Side.LEFT


class Segment(StrEnum):
    """Body segments that can carry a sensor."""

    PELVIS = "pelvis"
    TORSO = "torso"
    THIGH_LEFT = "thigh_left"
    THIGH_RIGHT = "thigh_right"
    SHANK_LEFT = "shank_left"
    SHANK_RIGHT = "shank_right"
    FOOT_LEFT = "foot_left"
    FOOT_RIGHT = "foot_right"


class GaitEventKind(StrEnum):
    """Contact events of one foot."""

    INITIAL_CONTACT = "initial_contact"
    TOE_OFF = "toe_off"


class EventSource(StrEnum):
    """What tells the gait events of a leg, best first."""

    FULL_LEG = "full_leg"
    SHANK = "shank"
    FOOT = "foot"
    LOWER_BACK = "lower_back"
    NOTHING = "nothing"


class Task(StrEnum):
    """What a person is asked to do; decides what is looked for beside gait."""

    WALK = "walk"
    TIMED_UP_AND_GO = "timed_up_and_go"
    KNEE_FLEXION = "knee_flexion"


class TaskPhaseKind(StrEnum):
    """Parts of a timed up and go, in the order in which they are done."""

    SIT_TO_STAND = "sit_to_stand"
    WALK_OUT = "walk_out"
    TURN = "turn"
    WALK_BACK = "walk_back"
    TURN_TO_SIT = "turn_to_sit"


class Misplacement(StrEnum):
    """How a sensor is worn otherwise than declared."""

    SWAPPED = "swapped"
    THIGH_UPSIDE_DOWN = "thigh_upside_down"
    SHANK_UPSIDE_DOWN = "shank_upside_down"
    OTHER_LEG = "other_leg"


class SensorState(StrEnum):
    """What a therapist is told about a sensor."""

    OK = "ok"
    CALIBRATING = "calibrating"
    MISSING = "missing"
    STUCK = "stuck"
    REJECTED = "rejected"
    UNUSED = "unused"


@dataclass(frozen=True, slots=True)
class DegreeOfFreedom:
    """One joint coordinate.

    `axis` is the unit rotation axis in the parent frame (after the joint's earlier rotations) for which a
    positive angle moves the body in the direction that `positive` states.
    """

    name: str
    axis: tuple[int, int, int]
    positive: str


FORWARD, UP, RIGHT = (1, 0, 0), (0, 1, 0), (0, 0, 1)
BACKWARD, DOWN, LEFT = (-1, 0, 0), (0, -1, 0), (0, 0, -1)


def _leg(side: Side) -> tuple[DegreeOfFreedom, ...]:
    # Ab/adduction and axial rotation mirror between the legs; flexion does not, since z points right for both.
    frontal, axial = (FORWARD, UP) if side is Side.RIGHT else (BACKWARD, DOWN)
    return (
        DegreeOfFreedom(f"hip_flexion_{side}", RIGHT, "thigh forward"),
        DegreeOfFreedom(f"hip_adduction_{side}", frontal, "thigh towards the midline"),
        DegreeOfFreedom(f"hip_internal_rotation_{side}", axial, "toes towards the midline"),
        DegreeOfFreedom(f"knee_flexion_{side}", LEFT, "shank backward"),
        DegreeOfFreedom(f"knee_adduction_{side}", frontal, "shank towards the midline"),
        DegreeOfFreedom(f"knee_internal_rotation_{side}", axial, "toes towards the midline"),
    )


PELVIS_ROTATIONS = (
    DegreeOfFreedom("pelvis_rotation", UP, "turned to the left"),
    DegreeOfFreedom("pelvis_tilt", LEFT, "anterior: the front goes down"),
    DegreeOfFreedom("pelvis_obliquity", BACKWARD, "the right side goes up"),
)

LOWER_BODY: tuple[DegreeOfFreedom, ...] = (*PELVIS_ROTATIONS, *_leg(Side.RIGHT), *_leg(Side.LEFT))
"""Rotational coordinates of the lower body, in the order of every joint_state message of that model.

Zero is the anatomical posture: pelvis level and facing world x, thighs and shanks vertical.
The three translations of the pelvis are not observable from inertial sensors and are not reported.
"""

BODY_MODELS: dict[str, tuple[DegreeOfFreedom, ...]] = {"lower_body": LOWER_BODY}
"""Model name (as in a joint_state message) -> its degrees of freedom, in order."""

LOWER_BODY_ESTIMATORS: dict[str, str] = {
    "ekf": "EKF on joint position, velocity and acceleration",
    "rhythmic_ekf": "the same with the jerk of a rhythm model that knows whether it is locked",
    "rhythmic_ekf_joukov": "the same with the canonical dynamical system as printed (Joukov eq. 15-21)",
    "joukov_published": "as published throughout: that system, and the measurement model as printed (Joukov eq. 10-22)",
}
"""Estimators of the lower body, by name: from the plain filter up to ours, then back to the published one part by
part."""

KNEE_ESTIMATORS: dict[str, str] = {
    "knee_axis": "one knee whose axis is found and followed while it moves",
    "knee_axis_mcgrath": "as published: the axis by principal components of the first motion (McGrath 2018)",
    "knee_band": "one knee of a band worn in one plane, its bias followed while it moves",
    "knee_band_grover": "as published: bias from the first 1000 samples, then a one-state filter at 20 Hz (Grover)",
}
"""Estimators of single knees, each from a thigh and a shank sensor, by name: ours before the published one."""

ESTIMATORS: dict[str, str] = LOWER_BODY_ESTIMATORS | KNEE_ESTIMATORS
"""All selectable estimators, by name."""
