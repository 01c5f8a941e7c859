// From a pose to points: pure geometry, shared by the drawing in space and the one on paper.
// World: x forward, y up, z right (ISB); quaternions w, x, y, z; metres.

export const SIDES = ["left", "right"];
const PELVIS_HEIGHT_M = 0.11;
const FOOT_LENGTH_M = 0.2;
const TRUNK_M = 0.42;

/** Vector seen from the world, of a vector seen from the segment. */
export function rotate([w, x, y, z], [a, b, c]) {
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

const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

/**
 * Points of the legs by name, which bones may be trusted, and where the body faces.
 * `body` has the lengths of the session's description. Null when the pose has no pelvis.
 */
export function figureOf(pose, body) {
  const pelvis = pose.segments.pelvis;
  if (!pelvis) return null;
  const points = { pelvis: pelvis.position };
  const valid = { pelvis: pelvis.valid };
  for (const side of SIDES) {
    const thigh = pose.segments[`thigh_${side}`];
    const shank = pose.segments[`shank_${side}`];
    if (!thigh || !shank) return null;
    const down = rotate(shank.quat_world_from_segment, [0, -body.shank_length_m, 0]);
    const ankle = plus(shank.position, down);
    points[`hip_${side}`] = thigh.position;
    points[`knee_${side}`] = shank.position;
    points[`ankle_${side}`] = ankle;
    points[`toe_${side}`] = plus(ankle, rotate(shank.quat_world_from_segment, [FOOT_LENGTH_M, -0.04, 0]));
    valid[`thigh_${side}`] = thigh.valid;
    valid[`shank_${side}`] = shank.valid;
  }
  const up = rotate(pelvis.quat_world_from_segment, [0, 1, 0]);
  const middle = points.hip_left.map((value, axis) => (value + points.hip_right[axis]) / 2);
  points.pelvis_top = plus(
    middle,
    up.map((value) => value * PELVIS_HEIGHT_M),
  );
  points.neck = plus(points.pelvis_top, [0, TRUNK_M, 0]);
  return { points, valid, heading: headingOf(pelvis.quat_world_from_segment) };
}

/** A figure between two, for a screen that is faster than the data. Validity is the newer one's. */
export function between(older, newer, share) {
  const points = {};
  for (const name of Object.keys(newer.points)) {
    points[name] = newer.points[name].map((value, axis) => value * share + older.points[name][axis] * (1 - share));
  }
  const turn = Math.atan2(Math.sin(newer.heading - older.heading), Math.cos(newer.heading - older.heading));
  return { points, valid: newer.valid, heading: older.heading + share * turn };
}

/** Follows the lowest ankle of the last strides and the direction of walking, both slowly, so the view stays calm. */
export class Stage {
  constructor() {
    this.heading = null;
    this.ground = null;
  }

  follow(figure, elapsed_s) {
    const lowest = Math.min(figure.points.ankle_left[1], figure.points.ankle_right[1]);
    if (this.heading === null) {
      this.heading = figure.heading;
      this.ground = lowest;
    }
    const turn = Math.atan2(Math.sin(figure.heading - this.heading), Math.cos(figure.heading - this.heading));
    this.heading += turn * (1 - Math.exp(-elapsed_s / 0.8));
    // Down at once, up slowly: a foot never sinks into the floor.
    this.ground = lowest < this.ground ? lowest : this.ground + (lowest - this.ground) * (1 - Math.exp(-elapsed_s / 4));
  }
}
