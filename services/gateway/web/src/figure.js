// From a pose to points: pure geometry, shared by the drawing in space and the one on paper.
// World: x forward, y up, z right (ISB); quaternions w, x, y, z; metres.

import { roomFigureOf } from "./room_figure.js";
import { SIDES, dot, middle, minus, plus, times, unit } from "./vectors.js";

const PELVIS_HEIGHT_M = 0.11;
const FOOT_LENGTH_M = 0.2;
const TRUNK_M = 0.42;
const HEAD_ABOVE_NECK_M = 0.2;
const LETTER_FROM_TOE = [0.08, 0.03, 0];
const LABEL = { ahead: 0.2, apart: 0.1 };

/** Vector seen from the world, of a vector seen from the segment. */
export function rotate([w, x, y, z], /** @type {number[]} */ [a, b, c]) {
  const tx = 2 * (y * c - z * b);
  const ty = 2 * (z * a - x * c);
  const tz = 2 * (x * b - y * a);
  return [a + w * tx + y * tz - z * ty, b + w * ty + z * tx - x * tz, c + w * tz + x * ty - y * tx];
}

/** Angle about the vertical from world x to where the pelvis faces, in rad, positive to the left. */
export function headingOf(quat) {
  const [x, , z] = rotate(quat, [1, 0, 0]);
  return Math.atan2(-z, x);
}

/**
 * Points of the worn legs by name, which bones may be trusted, and where the body faces. Of a body that a camera sees,
 * its joint centres.
 * `body` has the lengths of the session's description. Pelvis and trunk are there only with both legs and a pelvis;
 * legs alone hang from their hips, which then are the origin. Null when there is no whole leg.
 */
export function figureOf(pose, body) {
  if (pose.centres && Object.keys(pose.centres).length > 0) return roomFigureOf(pose, body.floor_m);
  const sides = SIDES.filter((side) => pose.segments[`thigh_${side}`] && pose.segments[`shank_${side}`]);
  if (sides.length === 0) return null;
  const points = {};
  const valid = {};
  for (const side of sides) addLeg(points, valid, pose.segments, side, body);
  addLabels(points, pose.segments, sides);
  const { pelvis } = pose.segments;
  const whole = Boolean(pelvis) && sides.length === 2;
  if (whole) addTrunk(points, valid, pelvis);
  else hang(points, sides);
  const heading = whole ? headingOf(pelvis.quat_world_from_segment) : headingOfThighs(pose.segments, sides);
  return { points, valid, heading, sides, whole };
}

function addLeg(points, valid, segments, side, body) {
  const [thigh, shank] = [segments[`thigh_${side}`], segments[`shank_${side}`]];
  const ankle = plus(shank.position, rotate(shank.quat_world_from_segment, [0, -body.shank_length_m, 0]));
  points[`hip_${side}`] = thigh.position;
  points[`knee_${side}`] = shank.position;
  points[`ankle_${side}`] = ankle;
  points[`toe_${side}`] = plus(ankle, rotate(shank.quat_world_from_segment, [FOOT_LENGTH_M, -0.04, 0]));
  points[`letter_${side}`] = plus(points[`toe_${side}`], LETTER_FROM_TOE);
  valid[`thigh_${side}`] = thigh.valid;
  valid[`shank_${side}`] = shank.valid;
}

/** Places for text: before the knee; with two, the left one's behind and both apart, so that none covers the other. */
function addLabels(points, segments, sides) {
  const both = sides.length === 2;
  for (const side of sides) {
    const bones = [segments[`thigh_${side}`], segments[`shank_${side}`]];
    const [fronts, rights] = [
      [1, 0, 0],
      [0, 0, 1],
    ].map((axis) => unit(bones.map((bone) => rotate(bone.quat_world_from_segment, axis)).reduce(plus)));
    const outward = side === "left" ? -1 : 1;
    const ahead = times(fronts, LABEL.ahead * (both ? outward : 1));
    points[`label_${side}`] = plus(
      points[`knee_${side}`],
      plus(ahead, times(rights, both ? outward * LABEL.apart : 0)),
    );
  }
}

function addTrunk(points, valid, pelvis) {
  const up = rotate(pelvis.quat_world_from_segment, [0, 1, 0]);
  points.pelvis = pelvis.position;
  points.pelvis_top = plus(middle(points.hip_left, points.hip_right), times(up, PELVIS_HEIGHT_M));
  points.neck = plus(points.pelvis_top, [0, TRUNK_M, 0]);
  points.head = plus(points.neck, [0, HEAD_ABOVE_NECK_M, 0]);
  valid.pelvis = pelvis.valid;
}

function hang(points, sides) {
  const hips = sides.map((side) => points[`hip_${side}`]);
  const origin = hips.length === 2 ? middle(...hips) : hips[0];
  for (const name of Object.keys(points)) points[name] = minus(points[name], origin);
}

// By the axis of flexion, which stays level when the person sits and the thigh's front looks up.
function headingOfThighs(segments, sides) {
  const rights = sides.map((side) => rotate(segments[`thigh_${side}`].quat_world_from_segment, [0, 0, 1]));
  const [x, , z] = rights.reduce(plus);
  return Math.atan2(x, z);
}

/** A figure between two, for a screen that is faster than the data. Validity is the newer one's. */
export function between(older, newer, share) {
  const points = {};
  for (const [name, point] of Object.entries(newer.points)) {
    const before = older.points[name] ?? point;
    points[name] = point.map((value, axis) => value * share + before[axis] * (1 - share));
  }
  const turn = Math.atan2(Math.sin(newer.heading - older.heading), Math.cos(newer.heading - older.heading));
  return { ...newer, points, heading: older.heading + share * turn };
}

/** Angle of the steepest thigh from hanging straight down, in rad: small in standing and walking, large in sitting. */
export function thighTilt({ points, sides }) {
  const tilts = sides.map((side) => Math.acos(unit(minus(points[`hip_${side}`], points[`knee_${side}`]))[1]));
  return Math.min(...tilts);
}

/**
 * What is drawn at a knee: `open`, the directions from the thigh's straight continuation to the shank, and `spread`,
 * those within two standard deviations of the shank's. Unit vectors; null for a knee that is not known.
 */
export function kneeFan({ points, valid, sides }, side, std) {
  if (!sides.includes(side) || !valid[`thigh_${side}`] || !valid[`shank_${side}`]) return null;
  const along = unit(minus(points[`knee_${side}`], points[`hip_${side}`]));
  const shank = unit(minus(points[`ankle_${side}`], points[`knee_${side}`]));
  const across = unit(minus(shank, times(along, dot(shank, along))));
  const bend = Math.acos(Math.min(1, Math.max(-1, dot(shank, along))));
  const at = (angle) => plus(times(along, Math.cos(angle)), times(across, Math.sin(angle)));
  const sweep = (from, to, count) =>
    Array.from({ length: count + 1 }, (_, step) => at(from + ((to - from) * step) / count));
  return { open: sweep(0, bend, 24), spread: sweep(bend - 2 * std, bend + 2 * std, 12) };
}
