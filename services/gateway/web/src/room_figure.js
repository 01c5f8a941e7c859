// A body that a camera sees, from its joint centres to points: the same names as of a body with sensors, and more.
// Room: x to the camera, y up, z to the right of a person who faces the camera; metres.
import { SIDES, middle, minus, plus, times, unit } from "./vectors.js";

const HEAD_ABOVE_M = 0.25;
const HAND_M = 0.08;
const FOOT = { ahead: 0.17, below: 0.05 };
const LETTER_AHEAD_M = 0.12;

/** Which angle must be known for a bone to be trusted. */
const TOLD_BY = {
  trunk: "trunk_flexion",
  pelvis: "pelvis_tilt",
  ...Object.fromEntries(
    SIDES.flatMap((side) => [
      [`thigh_${side}`, `hip_flexion_${side}`],
      [`shank_${side}`, `knee_flexion_${side}`],
      [`upper_arm_${side}`, `shoulder_adduction_${side}`],
      [`forearm_${side}`, `elbow_flexion_${side}`],
    ]),
  ),
};

/**
 * Points by name, which bones may be trusted, and sides with a whole leg; head, hands and feet are sketched.
 * `floor_m` is the height of the floor where the camera knows it. Null while the trunk is not seen.
 */
export function roomFigureOf({ centres, angles }, floor_m) {
  if (!centres.spine_base || !centres.spine_shoulder) return null;
  const points = { ...centres };
  const along = unit(minus(points.spine_shoulder, points.spine_base));
  points.head = plus(points.spine_shoulder, times(along, HEAD_ABOVE_M));
  const ahead = facing(points);
  for (const side of SIDES) addSketches(points, side, ahead);
  const sides = SIDES.filter((side) => ["hip", "knee", "ankle"].every((joint) => points[`${joint}_${side}`]));
  const valid = Object.fromEntries(Object.entries(TOLD_BY).map(([bone, angle]) => [bone, angle in angles]));
  return { points, valid, heading: 0, sides, whole: true, inRoom: true, floor_m };
}

/** Level direction in which the hips face; to the camera when they are not seen. */
function facing({ hip_left, hip_right }) {
  if (!hip_left || !hip_right) return [1, 0, 0];
  const [x, , z] = minus(hip_right, hip_left);
  return unit([z, 0, -x]);
}

function addSketches(points, side, ahead) {
  const { [`elbow_${side}`]: elbow, [`wrist_${side}`]: wrist, [`ankle_${side}`]: ankle } = points;
  if (elbow && wrist) points[`hand_${side}`] = plus(wrist, times(unit(minus(wrist, elbow)), HAND_M));
  if (!ankle) return;
  points[`toe_${side}`] = plus(ankle, plus(times(ahead, FOOT.ahead), [0, -FOOT.below, 0]));
  points[`letter_${side}`] = plus(points[`toe_${side}`], times(ahead, LETTER_AHEAD_M));
}

/** Where the body stands on the floor, [x, z]: between what carries it. */
export function standpointOf({ points, sides }) {
  const feet = sides.map((side) => points[`ankle_${side}`]);
  const [x, , z] = feet.length === 2 ? middle(...feet) : points.spine_base;
  return [x, z];
}

/** Height of the floor: as the camera knows it, else as the feet tell; an ankle's joint centre is `ankle_m` over it. */
export function floorUnder({ points, sides, floor_m }, ankle_m) {
  if (floor_m !== null && floor_m !== undefined) return floor_m;
  const lowest = sides.map((side) => points[`ankle_${side}`][1]);
  return lowest.length > 0 ? Math.min(...lowest) - ankle_m : points.spine_base[1] - 1;
}
