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
    CAMERA = "camera"
    NOTHING = "nothing"


class Task(StrEnum):
    """What a person is asked to do; decides what is looked for beside gait."""

    WALK = "walk"
    TIMED_UP_AND_GO = "timed_up_and_go"
    SIX_MINUTE_WALK = "six_minute_walk"
    TEN_METRE_WALK = "ten_metre_walk"
    MARCHING = "marching"
    KNEE_FLEXION = "knee_flexion"
    SQUAT = "squat"
    STEPPING = "stepping"
    TRUNK_TILT_SAGITTAL = "trunk_tilt_sagittal"
    TRUNK_TILT_FRONTAL = "trunk_tilt_frontal"


class TaskPhaseKind(StrEnum):
    """Parts of timed tests; `TASK_PHASES` says of which."""

    SIT_TO_STAND = "sit_to_stand"
    WALK_OUT = "walk_out"
    TURN = "turn"
    WALK_BACK = "walk_back"
    TURN_TO_SIT = "turn_to_sit"
    WALK = "walk"
    REST = "rest"
    RUN_UP = "run_up"
    TIMED_ZONE = "timed_zone"
    RUN_OUT = "run_out"


TASK_PHASES: dict[Task, tuple[TaskPhaseKind, ...]] = {
    Task.TIMED_UP_AND_GO: (
        TaskPhaseKind.SIT_TO_STAND,
        TaskPhaseKind.WALK_OUT,
        TaskPhaseKind.TURN,
        TaskPhaseKind.WALK_BACK,
        TaskPhaseKind.TURN_TO_SIT,
    ),
    Task.SIX_MINUTE_WALK: (TaskPhaseKind.WALK, TaskPhaseKind.TURN, TaskPhaseKind.REST),
    Task.TEN_METRE_WALK: (TaskPhaseKind.RUN_UP, TaskPhaseKind.TIMED_ZONE, TaskPhaseKind.RUN_OUT),
}
"""Parts of each timed test. Those of a timed up and go and of a ten-metre walk in the order in which they are done;
those of a six-minute walk follow each other as the person likes."""


class Misplacement(StrEnum):
    """How a sensor is worn otherwise than declared."""

    SWAPPED = "swapped"
    THIGH_UPSIDE_DOWN = "thigh_upside_down"
    SHANK_UPSIDE_DOWN = "shank_upside_down"
    OTHER_LEG = "other_leg"


class JointCentre(StrEnum):
    """Joint centres that a depth camera sees and the whole body is fitted to, in the order of every list of them."""

    SPINE_BASE = "spine_base"
    SPINE_MID = "spine_mid"
    SPINE_SHOULDER = "spine_shoulder"
    SHOULDER_RIGHT = "shoulder_right"
    ELBOW_RIGHT = "elbow_right"
    WRIST_RIGHT = "wrist_right"
    SHOULDER_LEFT = "shoulder_left"
    ELBOW_LEFT = "elbow_left"
    WRIST_LEFT = "wrist_left"
    HIP_RIGHT = "hip_right"
    KNEE_RIGHT = "knee_right"
    ANKLE_RIGHT = "ankle_right"
    HIP_LEFT = "hip_left"
    KNEE_LEFT = "knee_left"
    ANKLE_LEFT = "ankle_left"


class SkeletonJoint(StrEnum):
    """Every joint that a depth camera may deliver: the centres that the body is fitted to, then the others.

    What a camera calls otherwise is renamed in ingest; what it lacks of the centres is interpolated there.
    """

    SPINE_BASE = "spine_base"
    SPINE_MID = "spine_mid"
    SPINE_SHOULDER = "spine_shoulder"
    SHOULDER_RIGHT = "shoulder_right"
    ELBOW_RIGHT = "elbow_right"
    WRIST_RIGHT = "wrist_right"
    SHOULDER_LEFT = "shoulder_left"
    ELBOW_LEFT = "elbow_left"
    WRIST_LEFT = "wrist_left"
    HIP_RIGHT = "hip_right"
    KNEE_RIGHT = "knee_right"
    ANKLE_RIGHT = "ankle_right"
    HIP_LEFT = "hip_left"
    KNEE_LEFT = "knee_left"
    ANKLE_LEFT = "ankle_left"
    FOOT_RIGHT = "foot_right"
    FOOT_LEFT = "foot_left"
    NECK = "neck"
    HEAD = "head"
    HAND_RIGHT = "hand_right"
    HAND_LEFT = "hand_left"
    HAND_TIP_RIGHT = "hand_tip_right"
    HAND_TIP_LEFT = "hand_tip_left"
    THUMB_RIGHT = "thumb_right"
    THUMB_LEFT = "thumb_left"
    SPINE_NAVEL = "spine_navel"
    SPINE_CHEST = "spine_chest"
    CLAVICLE_RIGHT = "clavicle_right"
    CLAVICLE_LEFT = "clavicle_left"
    NOSE = "nose"
    EYE_RIGHT = "eye_right"
    EYE_LEFT = "eye_left"
    EAR_RIGHT = "ear_right"
    EAR_LEFT = "ear_left"


class CameraKind(StrEnum):
    """Depth cameras by the skeleton they deliver."""

    KINECT_V2 = "kinect_v2"
    AZURE_KINECT = "azure_kinect"
    OTHER = "other"


class TrackingState(StrEnum):
    """How a depth camera knows where a joint centre is."""

    NOT_TRACKED = "not_tracked"
    INFERRED = "inferred"
    TRACKED = "tracked"


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


def _mirrored(side: Side) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
    # Ab/adduction and axial rotation mirror between the sides; flexion does not, since z points right for both.
    return (FORWARD, UP) if side is Side.RIGHT else (BACKWARD, DOWN)


def _leg(side: Side) -> tuple[DegreeOfFreedom, ...]:
    frontal, axial = _mirrored(side)
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


def _arm(side: Side) -> tuple[DegreeOfFreedom, ...]:
    frontal, axial = _mirrored(side)
    raising = BACKWARD if side is Side.RIGHT else FORWARD
    return (
        DegreeOfFreedom(f"clavicle_elevation_{side}", raising, "shoulder up"),
        DegreeOfFreedom(f"shoulder_flexion_{side}", RIGHT, "upper arm forward"),
        DegreeOfFreedom(f"shoulder_adduction_{side}", frontal, "upper arm towards the midline"),
        DegreeOfFreedom(f"shoulder_internal_rotation_{side}", axial, "front of the upper arm towards the midline"),
        DegreeOfFreedom(f"elbow_flexion_{side}", RIGHT, "forearm forward"),
    )


WHOLE_BODY: tuple[DegreeOfFreedom, ...] = (
    *PELVIS_ROTATIONS,
    *_leg(Side.RIGHT)[:4],
    *_leg(Side.LEFT)[:4],
    DegreeOfFreedom("trunk_flexion", LEFT, "chest forward"),
    *_arm(Side.RIGHT),
    *_arm(Side.LEFT),
)
"""Rotational coordinates of the whole body (Colombel et al. 2020, figure 1: 22 angles, here numbered from 1 as there,
but the pelvis turns before it tilts and lists, as in LOWER_BODY, and trunk and pelvis flex forward).

Zero is upright, facing world x, arms hanging, collar bones level. Knees and elbows are hinges. A shared name has the
same axis and sign in every model.
"""

ANKLES: tuple[DegreeOfFreedom, ...] = tuple(
    DegreeOfFreedom(f"ankle_dorsiflexion_{side}", RIGHT, "toes up") for side in (Side.RIGHT, Side.LEFT)
)
"""Told only while the foot is flat on the floor: no camera sees feet well enough."""

MOVEMENTS: dict[str, str] = {
    "squat_depth": "mean flexion of both knees",
    "trunk_lean_forward": "inclination of the trunk in the sagittal plane of the pelvis, positive forward",
    "trunk_lean_right": "inclination of the trunk in the frontal plane of the pelvis, positive to the right",
    "hip_flexion_right": "flexion of the right hip",
    "hip_flexion_left": "flexion of the left hip",
}
"""What repetitions of the whole body are counted on, by name; rad."""

BODY_MODELS: dict[str, tuple[DegreeOfFreedom, ...]] = {"lower_body": LOWER_BODY, "whole_body": (*WHOLE_BODY, *ANKLES)}
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

CAMERA_ESTIMATORS: dict[str, str] = {
    "body_cekf": "whole body from a depth camera, within the limits of joints and bones",
    "body_cekf_colombel": "as published: constraint and covariance as printed (Colombel eq. 1-5)",
}
"""Estimators of the whole body from a depth camera, by name: ours before the published one."""

FUSION_ESTIMATORS: dict[str, str] = {
    "fusion": "whole body from inertial sensors and a depth camera, either of which may be away for a while",
}
"""Estimators that need both an inertial sensor and a camera, by name."""

ESTIMATORS: dict[str, str] = LOWER_BODY_ESTIMATORS | KNEE_ESTIMATORS | CAMERA_ESTIMATORS | FUSION_ESTIMATORS
"""All selectable estimators, by name."""
