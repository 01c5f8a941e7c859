// The page's pure modules for a body before a camera. Run by test_page_modules.py, or: node --test ...
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const load = (name) => import(new URL(name, sources));
const { figureOf, between } = await load("figure.js");
const { Stage } = await load("stage.js");
const { arrangementOf, isExercise } = await load("arrangement.js");
const { cameraWord } = await load("camera_words.js");
const { whyUnseen } = await load("angle_words.js");
const { angleTitle, metricName, stateOf } = await load("words.js");
const { BONES } = await load("bones.js");
const { slotsOf } = await load("repetition_report.js");
const { meanRanges } = await load("ranges_table.js");

const BODY = { thigh_length_m: 0.42, shank_length_m: 0.41, hip_width_m: 0.18, floor_m: null };

/** Somebody 2.5 m before the camera who faces it, arms hanging. */
function standing() {
  const centres = { spine_base: [-2.5, -0.1, 0], spine_mid: [-2.5, 0.2, 0], spine_shoulder: [-2.5, 0.42, 0] };
  for (const [side, z] of [
    ["right", 1],
    ["left", -1],
  ]) {
    centres[`shoulder_${side}`] = [-2.5, 0.4, 0.17 * z];
    centres[`elbow_${side}`] = [-2.5, 0.1, 0.2 * z];
    centres[`wrist_${side}`] = [-2.5, -0.15, 0.2 * z];
    centres[`hip_${side}`] = [-2.5, -0.1, 0.09 * z];
    centres[`knee_${side}`] = [-2.5, -0.52, 0.1 * z];
    centres[`ankle_${side}`] = [-2.5, -0.92, 0.11 * z];
  }
  const angles = { knee_flexion_left: 0.1, knee_flexion_right: 0.1, hip_flexion_left: 0, hip_flexion_right: 0 };
  return { centres, angles: { ...angles, trunk_flexion: 0, pelvis_tilt: 0 }, segments: {} };
}

test("joint centres become a body whose bones are trusted as far as their angles are known", () => {
  const pose = standing();
  delete pose.angles.knee_flexion_left;
  const figure = figureOf(pose, BODY);
  assert.equal(figure.inRoom, true);
  assert.deepEqual(figure.sides, ["left", "right"]);
  assert.equal(figure.valid.shank_left, false);
  assert.equal(figure.valid.shank_right, true);
  assert.equal(figure.valid.forearm_left, false);
  assert.ok(figure.points.head[1] > figure.points.spine_shoulder[1]);
  assert.ok(figure.points.toe_left[0] > figure.points.ankle_left[0], "feet point to the camera");
});

test("every bone that is drawn of a body in a room has both its ends, whole limbs are missing with their centres", () => {
  const drawn = ({ points }) => BONES.filter(({ from, to }) => from in points && to in points).length;
  const whole = figureOf(standing(), BODY);
  assert.equal(drawn(whole), 18);
  const pose = standing();
  delete pose.centres.elbow_left;
  assert.equal(drawn(figureOf(pose, BODY)), 15);
  delete pose.centres.spine_base;
  assert.equal(figureOf(pose, BODY), null);
});

test("feet point where the hips face", () => {
  const pose = standing();
  pose.centres.hip_right = [-2.59, -0.1, 0];
  pose.centres.hip_left = [-2.41, -0.1, 0];
  const { points } = figureOf(pose, BODY);
  assert.ok(points.toe_right[2] - points.ankle_right[2] > 0.1, "turned to the patient's right hand");
});

test("the view stays while a person shifts, follows who walks, and knows the camera's floor", () => {
  const stage = new Stage();
  const moved = (by, floor_m = null) => {
    const pose = standing();
    for (const centre of Object.values(pose.centres)) centre[0] += by;
    return figureOf(pose, { ...BODY, floor_m });
  };
  stage.follow(moved(0), 0.05);
  assert.deepEqual(stage.standpoint, [-2.5, 0]);
  stage.follow(moved(0.1), 0.05);
  assert.ok(Math.abs(stage.standpoint[0] + 2.5) < 0.01);
  stage.follow(moved(1), 0.05);
  assert.ok(stage.standpoint[0] > -1.7);
  assert.ok(Math.abs(stage.ground - (-0.92 - 0.09 + 0.05)) < 1e-9);
  assert.equal(stage.seatHeight(moved(1)), null);
  const known = new Stage();
  known.follow(moved(0, -1.1), 0.05);
  assert.ok(Math.abs(known.ground - (-1.1 + 0.05)) < 1e-9);
});

test("between two bodies in a room every point moves, and one that is new is there at once", () => {
  const older = figureOf(standing(), BODY);
  delete older.points.wrist_left;
  const pose = standing();
  pose.centres.knee_left = [-2.3, -0.52, -0.1];
  const middle = between(older, figureOf(pose, BODY), 0.5);
  assert.ok(Math.abs(middle.points.knee_left[0] + 2.4) < 1e-9);
  assert.deepEqual(middle.points.wrist_left, standing().centres.wrist_left);
});

test("what is shown follows from what measures and what is to be done", () => {
  const camera = { name: "kinect", kind: "kinect_v2", rate_hz: 30 };
  const squat = arrangementOf({ sensors: [], cameras: [camera], task: "squat" });
  assert.deepEqual(
    squat.charts.map(({ joint }) => joint),
    ["knee_flexion", "hip_flexion", "arm_elevation"],
  );
  assert.equal(Object.keys(squat.views)[0], "front");
  assert.equal(squat.counted, true);
  for (const task of ["walk", "stepping", "trunk_tilt_sagittal", "trunk_tilt_frontal", "timed_up_and_go"]) {
    const shown = arrangementOf({ sensors: [{ segment: "pelvis" }], cameras: [camera], task });
    assert.equal(shown.charts.length, 3, task);
    assert.equal(shown.counted, isExercise(task));
  }
  const walker = arrangementOf({ sensors: [{ segment: "pelvis" }], cameras: [], task: "walk" });
  assert.equal(walker.wholeBody, null);
  assert.equal(Object.keys(walker.views)[0], "side");
  const knee = arrangementOf({ sensors: [{ segment: "thigh_left" }, { segment: "shank_left" }], task: "walk" });
  assert.deepEqual(knee.charts.map(({ sides }) => sides), [["left"]]);
});

test("a camera's state has its word", () => {
  const word = (state, people) => cameraWord({ state, people }).word;
  assert.equal(word("ok", 1), "Good");
  assert.equal(word("ok", 0), "Nobody in view");
  assert.equal(word("ok", 2), "2 people in view");
  assert.equal(word("rejected", 1), "Partly covered");
  assert.equal(word("missing", 0), "No pictures");
  const now = { age_s: 0.1, phase: "estimating", message: "", sensors: [], segments: {}, silent: [], heard: true };
  const state = (camera) => stateOf({ ...now, cameras: [camera] }).word;
  assert.equal(state({ state: "ok", people: 0 }), "Nobody in view");
  assert.equal(state({ state: "ok", people: 2 }), "Live", "one of them is followed");
  assert.equal(state({ state: "unused", people: 0 }), "Live");
});

test("what is not observable has a reason", () => {
  assert.match(whyUnseen("hip_internal_rotation"), /knee is bent/);
  assert.match(whyUnseen("knee_flexion"), /^The camera has not seen/);
});

test("both sides of an exercise stand beside each other", () => {
  const [left, right, both] = ["left", "right", null].map((side) => ({ side }));
  const paired = slotsOf([right, left, right, left, right]);
  assert.equal(paired.count, 3);
  assert.deepEqual(paired.places[0], { slot: 1, shift: 0.5 });
  assert.deepEqual(paired.places[1], { slot: 1, shift: -0.5 });
  assert.deepEqual(slotsOf([both, both]).places[1], { slot: 2, shift: 0 });
});

test("ranges are averaged over repetitions that count", () => {
  const repetition = (range, valid = true) => ({ valid, ranges: { knee_flexion_left: range } });
  const told = meanRanges([repetition(1), repetition(1.2), repetition(9, false)]).get("knee_flexion_left");
  assert.ok(Math.abs(told.mean - 1.1) < 1e-9);
  assert.ok(Math.abs(told.spread - Math.SQRT2 / 10) < 1e-9);
  assert.equal(told.count, 2);
});

test("movements and their metrics have names", () => {
  assert.equal(angleTitle("trunk_lean_right"), "Trunk lean to the right");
  assert.equal(angleTitle("squat_depth"), "Squat depth");
  assert.equal(metricName("repetition_knee_flexion_range"), "Knee flexion range");
  assert.equal(metricName("repetition_range_ratio_larger_to_smaller"), "Range, larger / smaller side");
});
