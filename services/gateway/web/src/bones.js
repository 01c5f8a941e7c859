// The bones and joints that are drawn, between points by name. What is not there is left out.
// Radii in m at the upper and lower end. `bone` names the segment whose validity counts; null is not measured.
import { GHOST, PELVIS, SIDE_COLOUR } from "./palette.js";
import { SIDES } from "./vectors.js";

export const HEAD_RADIUS_M = 0.095;

const limb = (side, bone, from, to, radii) => ({
  from: `${from}_${side}`,
  to: `${to}_${side}`,
  radii,
  bone: bone && `${bone}_${side}`,
  side: bone && side,
  colour: bone ? SIDE_COLOUR[side] : GHOST,
});
const core = (bone, from, to, radii) => ({ from, to, radii, bone, side: null, colour: bone ? PELVIS : GHOST });
const joint = (side, bone, name, radius) => ({
  at: `${name}_${side}`,
  radius,
  bone: bone && `${bone}_${side}`,
  colour: bone ? SIDE_COLOUR[side] : GHOST,
});
const node = (bone, at, radius) => ({ at, radius, bone, colour: bone ? PELVIS : GHOST });

/** Trunk, collar bones and arms of a body that a camera sees. */
export const UPPER_BONES = [
  core("pelvis", "spine_base", "spine_mid", [0.07, 0.066]),
  core("trunk", "spine_mid", "spine_shoulder", [0.066, 0.054]),
  core(null, "spine_shoulder", "head", [0.03, 0.03]),
  ...SIDES.flatMap((side) => [
    core("trunk", "spine_shoulder", `shoulder_${side}`, [0.05, 0.04]),
    limb(side, "upper_arm", "shoulder", "elbow", [0.042, 0.034]),
    limb(side, "forearm", "elbow", "wrist", [0.034, 0.024]),
    limb(side, null, "wrist", "hand", [0.024, 0.028]),
  ]),
];

export const BONES = [
  ...SIDES.flatMap((side) => [
    limb(side, "thigh", "hip", "knee", [0.058, 0.042]),
    limb(side, "shank", "knee", "ankle", [0.044, 0.026]),
    limb(side, null, "ankle", "toe", [0.026, 0.02]),
    core("pelvis", "pelvis_top", `hip_${side}`, [0.048, 0.048]),
  ]),
  core("pelvis", "hip_left", "hip_right", [0.048, 0.048]),
  core(null, "neck", "pelvis_top", [0.085, 0.06]),
  ...UPPER_BONES,
];

export const JOINTS = [
  ...SIDES.flatMap((side) => [
    joint(side, "thigh", "hip", 0.058),
    joint(side, "shank", "knee", 0.0445),
    joint(side, "shank", "ankle", 0.027),
    joint(side, null, "toe", 0.02),
    joint(side, "upper_arm", "shoulder", 0.042),
    joint(side, "forearm", "elbow", 0.034),
    joint(side, "forearm", "wrist", 0.024),
    joint(side, null, "hand", 0.03),
  ]),
  node("pelvis", "spine_base", 0.07),
  node("trunk", "spine_mid", 0.066),
  node("trunk", "spine_shoulder", 0.054),
  node("pelvis", "pelvis_top", 0.049),
  node(null, "neck", 0.085),
];
