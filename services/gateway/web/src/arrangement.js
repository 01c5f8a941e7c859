// What a live page shows of a session: decided by what measures the person and by what is to be done. What can not be
// known is absent, not empty.
import { SIDES } from "./vectors.js";
import { kneesOf } from "./worn.js";

const MIDDLE = [null];
const knees = { joint: "knee_flexion", title: "Knee flexion", range: [-10, 80] };
const hips = { joint: "hip_flexion", title: "Hip flexion", range: [-30, 50] };
const arms = { joint: "arm_elevation", title: "Arm elevation", range: [0, 100] };
const forward = { joint: "trunk_lean_forward", title: "Trunk lean, forward", range: [-10, 50], sides: MIDDLE };
const aside = { joint: "trunk_lean_right", title: "Trunk lean, to the right", range: [-30, 30], sides: MIDDLE };
const deep = (chart, range) => ({ ...chart, range });

const WHOLE_BODY = {
  squat: {
    charts: [deep(knees, [0, 120]), deep(hips, [-10, 100]), arms],
    angles: [
      "knee_flexion",
      "hip_flexion",
      "ankle_dorsiflexion",
      "hip_adduction",
      "hip_internal_rotation",
      "arm_elevation",
    ],
    middle: ["trunk_lean_forward", "trunk_lean_right"],
    compared: "knee_flexion",
  },
  stepping: {
    charts: [deep(hips, [-10, 80]), deep(knees, [0, 90]), deep(aside, [-20, 20])],
    angles: ["hip_flexion", "knee_flexion", "hip_adduction", "hip_internal_rotation"],
    middle: ["trunk_lean_forward", "trunk_lean_right", "pelvis_tilt", "pelvis_obliquity"],
    compared: "hip_flexion",
  },
  trunk_tilt_sagittal: {
    charts: [deep(forward, [-10, 70]), hips, deep(knees, [0, 60])],
    angles: ["hip_flexion", "knee_flexion"],
    middle: ["trunk_lean_forward", "trunk_lean_right", "trunk_flexion", "pelvis_tilt"],
    compared: "hip_flexion",
  },
  trunk_tilt_frontal: {
    charts: [aside, { joint: "hip_adduction", title: "Hip adduction", range: [-20, 20] }, deep(forward, [-20, 30])],
    angles: ["hip_adduction", "hip_flexion", "knee_flexion"],
    middle: ["trunk_lean_forward", "trunk_lean_right", "trunk_flexion", "pelvis_obliquity"],
    compared: "trunk_lean",
  },
  walk: {
    charts: [hips, knees, deep(aside, [-20, 20])],
    angles: ["hip_flexion", "knee_flexion", "hip_adduction", "arm_elevation", "elbow_flexion"],
    middle: ["trunk_lean_forward", "trunk_lean_right"],
    compared: null,
  },
};
const VIEWS = { side: "Side", front: "Front", back: "Back" };
const ROOM_VIEWS = { front: "Front", mirror: "Mirror", side: "Side" };

/** Tasks in which a movement is repeated and counted, and nobody makes strides. */
const EXERCISES = ["knee_flexion", "squat", "stepping", "trunk_tilt_sagittal", "trunk_tilt_frontal"];
export const isExercise = (task) => EXERCISES.includes(task);

/**
 * `charts`, the `sides` that are seen, `views` of the skeleton (first one first), and for a camera the `wholeBody`'s
 * angles and what is compared between the sides; `legs`: single legs, where that is all that is measured.
 * @param {{sensors: {segment: string}[], cameras: {name: string}[], task: string}} session
 */
export function arrangementOf({ sensors, cameras = [], task }) {
  const common = { counted: isExercise(task) };
  if (cameras.length > 0) {
    const wholeBody = WHOLE_BODY[task] ?? WHOLE_BODY.walk;
    return { ...common, charts: wholeBody.charts, sides: SIDES, views: ROOM_VIEWS, wholeBody, legs: null };
  }
  const legs = kneesOf(sensors);
  const charts = legs ? [{ ...knees, sides: legs }] : [hips, knees];
  return { ...common, charts, sides: legs ?? SIDES, views: VIEWS, wholeBody: null, legs };
}
