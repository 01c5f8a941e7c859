"""Which way the knee bends: the sense of the axis, from posture and from how the sensors were declared to be worn."""

from math import sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.flexion import angle_of_verticals, arm_length
from services.biomech.two_sensor_knee.memory import SHANK, THIGH, Bench, FloatArray, Memory, Record
from services.biomech.two_sensor_knee.turns import low_pass_gain, wrapped

POSTURE_MEMORY_S = 30.0
SIGN_WEIGHT_S = 2.0
MOUNTING_WEIGHT_S = 3.0
"""s of motion after which what was declared decides, where posture has not."""
SIGN_SPREAD = 0.15
"""rad. Deviation of the angle below which nothing is said about its sign."""
CLEARLY_BENT = 0.35
"""rad from the declared straight leg: straps are not put on better than this."""
CLEARLY_SKEWED = 0.5
"""Skewness of the angle; a walking knee has 0.9 to 1."""
MOST_BENT = 2.6
"""rad. No knee bends farther while it moves."""
CLEARLY_LEFT = 0.5
"""Share of an axis that must lie along the declared direction: 60 degrees."""


@compiled
def follow_posture(memory: Memory, bench: Bench, dt_s: float) -> None:
    """Running moments of angle and height, forgotten over half a minute of motion."""
    posture, angle = memory.posture, memory.knee.angle
    up_thigh, up_shank = bench.R[THIGH, 1], bench.R[SHANK, 1]
    height, upright = 0.0, 0.0
    for i in range(3):
        upright -= up_thigh[i] * memory.arms[THIGH, i]
        height += up_shank[i] * memory.arms[SHANK, i]
    height += upright
    keep = 1.0 - low_pass_gain(POSTURE_MEMORY_S, dt_s)
    posture.weight = keep * posture.weight + dt_s
    posture.angle = keep * posture.angle + dt_s * angle
    posture.height = keep * posture.height + dt_s * height
    posture.upright = keep * posture.upright + dt_s * upright
    posture.angle_height = keep * posture.angle_height + dt_s * angle * height
    posture.angle2 = keep * posture.angle2 + dt_s * angle * angle
    posture.angle3 = keep * posture.angle3 + dt_s * angle * angle * angle
    posture.height2 = keep * posture.height2 + dt_s * height * height


@compiled
def settle_sign(memory: Memory, parameters: Record) -> None:
    """Turn both axes round when what was seen so far, or else what was declared, speaks against them."""
    posture, knee = memory.posture, memory.knee
    if parameters.sign_evidence == 0.0:
        knee.is_sign_known = 1.0
        return
    evidence = evidence_of_motion(memory, parameters)
    # What was declared never overrules a sense that motion has shown.
    if abs(evidence) <= parameters.sign_evidence and knee.is_sign_known == 0.0 and posture.weight >= MOUNTING_WEIGHT_S:
        evidence = evidence_of_mounting(memory)
    if evidence < -parameters.sign_evidence:
        turn_round(memory)
    if abs(evidence) > parameters.sign_evidence:
        knee.is_sign_known = 1.0


@compiled
def evidence_of_motion(memory: Memory, parameters: Record) -> float:
    """Three witnesses, each within +-1; 0 where there are none.

    Over an upright thigh flexion brings the sensors' heights together, so the angle falls with the height, and the
    knee is nearly straight for most of the time and bends far for some. From standing a knee can only bend, so the
    moving knee's mean lies on the positive side of a standing zero. A seated leg shows none of this.
    """
    posture, knee = memory.posture, memory.knee
    if posture.weight < SIGN_WEIGHT_S:
        return 0.0
    angle, height = posture.angle / posture.weight, posture.height / posture.weight
    angle_variance = posture.angle2 / posture.weight - angle * angle
    height_variance = posture.height2 / posture.weight - height * height
    if angle_variance < SIGN_SPREAD**2 or height_variance < 1e-6:
        return 0.0
    evidence = 0.0
    arm = arm_length(memory, THIGH)
    if arm >= parameters.shortest_arm and posture.upright >= parameters.upright_share * arm * posture.weight:
        covariance = posture.angle_height / posture.weight - angle * height
        evidence = -covariance / sqrt(angle_variance * height_variance)
        third = posture.angle3 / posture.weight - 3.0 * angle * angle_variance - angle**3
        skewness = third / angle_variance**1.5
        if abs(skewness) > CLEARLY_SKEWED:
            evidence += min(max(skewness, -1.0), 1.0)
    if knee.is_standing > 0.0:
        evidence += min(max((angle - knee.standing_angle) / sqrt(angle_variance), -1.0), 1.0)
    return evidence


@compiled
def declared_share(memory: Memory, segment: int) -> float:
    """Share of a segment's axis along the declared left, -1 to 1; 0 where it is not clear."""
    share = 0.0
    for i in range(3):
        share += memory.axes[segment, i] * memory.leftward[segment, i]
    return share if abs(share) >= CLEARLY_LEFT else 0.0


@compiled
def declared_bend(memory: Memory) -> float:
    """Mean angle of the moving knee from the declared straight leg, rad; 0 where it is not clear."""
    if length_of(memory.upward[THIGH]) == 0.0 or length_of(memory.upward[SHANK]) == 0.0:
        return 0.0
    straight = angle_of_verticals(memory.upward, memory.axes, memory.across)
    bent = wrapped(memory.posture.angle / memory.posture.weight - straight)
    return bent if abs(bent) > CLEARLY_BENT else 0.0


@compiled
def evidence_of_mounting(memory: Memory) -> float:
    """What the declared directions say, each within +-1; they must not contradict each other.

    The flexion axis points to the person's left. And a knee bends to one side of the straight leg only, in which the
    declared directions up the segments are one: that holds for a seated leg as for any.
    """
    evidence = min(max(declared_share(memory, THIGH) + declared_share(memory, SHANK), -1.0), 1.0)
    bent = declared_bend(memory)
    return evidence + (1.0 if bent > 0.0 else 0.0) - (1.0 if bent < 0.0 else 0.0)


@compiled
def faces_the_other_way(memory: Memory) -> bool:
    """Whether the shank was taken to face backwards, where that stayed open.

    The axis would then point left in one sensor and right in the other; or a knee bent to its left side would turn
    about an axis to the right, as the shank has it; or it would bend farther than a knee can.
    """
    knee, posture = memory.knee, memory.posture
    if knee.is_half_turn_open == 0.0 or posture.weight < SIGN_WEIGHT_S:
        return False
    thigh, shank, bent = declared_share(memory, THIGH), declared_share(memory, SHANK), declared_bend(memory)
    if thigh * shank != 0.0:
        return bool(thigh * shank < 0.0)
    if shank * bent != 0.0:
        return bool(shank * bent < 0.0)
    angle = posture.angle / posture.weight
    spread = sqrt(max(posture.angle2 / posture.weight - angle * angle, 0.0))
    # A sine reaches 1.4 deviations to either side of its mean.
    return bool(abs(bent) + 1.4 * spread > MOST_BENT)


@compiled
def length_of(direction: FloatArray) -> float:
    """Norm of a direction (3,); 0 where none was declared."""
    return sqrt(direction[0] ** 2 + direction[1] ** 2 + direction[2] ** 2)


@compiled
def turn_round(memory: Memory) -> None:
    """Give both axes, and all that is measured about them, the other sense."""
    posture, knee = memory.posture, memory.knee
    for s in range(2):
        for i in range(3):
            memory.axes[s, i] *= -1.0
    knee.angle *= -1.0
    knee.zero *= -1.0
    knee.standing_angle *= -1.0
    posture.angle *= -1.0
    posture.angle_height *= -1.0
    posture.angle3 *= -1.0
