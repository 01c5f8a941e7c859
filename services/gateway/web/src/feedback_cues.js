// What a patient can be shown of the own movement: one cue at a time, as a place between too little and too much.
import { degrees } from "./units.js";

/** Values that are averaged before anything is said, so that no single step turns the sentence round. */
const SMOOTHED = 3;
const KEPT_S = 8;
/** Ends of the scale, in zones: what lies beyond is shown at the end. */
export const REACH = 3;

/**
 * `zone` is what is good, as places on the scale: its middle, or for a bend everything from the target up.
 * @typedef {{word: string, unit: string, least: number, most: number, step: number, usual: number, sided?: boolean,
 *   zone: [number, number]}} Cue
 * @type {Record<string, Cue>}
 */
export const CUES = {
  speed: { word: "Walking speed", unit: "m/s", least: 0.2, most: 2, step: 0.05, usual: 0.8, zone: [-1, 1] },
  cadence: { word: "Rhythm of the steps", unit: "steps/min", least: 40, most: 160, step: 1, usual: 100, zone: [-1, 1] },
  symmetry: { word: "Even steps", unit: "% apart at most", least: 3, most: 30, step: 1, usual: 10, zone: [-1, 1] },
  knee: { word: "Knee bend in swing", unit: "°", least: 10, most: 90, step: 1, usual: 50, sided: true, zone: [0, REACH] },
  repetitions: { word: "Repetitions", unit: "", least: 1, most: 100, step: 1, usual: 10, zone: [0, 0] },
};

/** Half the width of the zone around a speed or a rhythm, as a share of the target. */
const WIDTH = { speed: 0.08, cadence: 0.05 };
/** Degrees of bend for one step on the scale. */
const BEND_STEP = 10;

/** @typedef {{cue: string, target: number, side: string}} Target */

/** The cues that a session's arrangement can feed, the first one first. */
export function cuesOf({ counted, sides, legs }, { task, cameras = [] }) {
  if (counted) return ["repetitions"];
  const both = sides.length === 2;
  const measured = { speed: both && !legs && task !== "marching" && cameras.length === 0, symmetry: both };
  return Object.keys(CUES).filter((cue) => cue !== "repetitions" && (measured[cue] ?? true));
}

/** Follows one cue of a running session. */
export class CueProgress {
  /** @param {Target} target */
  constructor(target) {
    this.target = target;
    /** @type {number[]} */
    this.places = [];
    /** @type {{at_s: number, bend: number}[]} */
    this.bends = [];
    /** @type {Record<string, number>} */
    this.steps = {};
    /** @type {Map<string, number>} */
    this.counts = new Map();
  }

  /** Angles between strides, for the bend of the knee. @param {any} pose */
  onPose(pose) {
    if (this.target.cue !== "knee") return;
    for (const { at_s, angles } of [...pose.trail, pose]) {
      const bend = degrees(angles[`knee_flexion_${this.target.side}`]);
      if (bend !== null) this.bends.push({ at_s, bend });
    }
    this.bends = this.bends.filter(({ at_s }) => at_s > pose.at_s - KEPT_S);
  }

  /** @param {any} stride */
  onStride(stride) {
    if (!stride.valid || stride.turning) return;
    if (stride.step_time_s !== null) this.steps[stride.side] = stride.step_time_s;
    const place = this.placeOf(stride);
    if (place !== null) this.places = [...this.places, place].slice(-SMOOTHED);
  }

  /** @param {any} repetition */
  onRepetition({ degree_of_freedom, side, index, valid }) {
    const known = this.counts.get(`${degree_of_freedom} ${side}`) ?? 0;
    if (valid) this.counts.set(`${degree_of_freedom} ${side}`, Math.max(known, index + 1));
  }

  /** Place on the scale; to the left for a longer left step. @param {any} stride */
  placeOf(stride) {
    const { cue, target, side } = this.target;
    if (cue === "speed") return stride.walking_speed === null ? null : (stride.walking_speed / target - 1) / WIDTH.speed;
    if (cue === "cadence") return (120 / stride.stride_time_s / target - 1) / WIDTH.cadence;
    if (cue === "symmetry") {
      const { left, right } = this.steps;
      return left && right ? Math.log(right / left) / Math.log(1 + target / 100) : null;
    }
    const own = this.bends.filter(({ at_s }) => at_s >= stride.start_s && at_s <= stride.end_s);
    if (cue !== "knee" || stride.side !== side || own.length === 0) return null;
    return (Math.max(...own.map(({ bend }) => bend)) - target) / BEND_STEP;
  }

  /** @returns {{state: "waiting"|"low"|"in"|"high", place: number|null, done: number}} */
  now() {
    if (this.target.cue === "repetitions") {
      const done = [...this.counts.values()].reduce((sum, count) => sum + count, 0);
      return { state: done === 0 ? "waiting" : done < this.target.target ? "low" : "in", place: null, done };
    }
    if (this.places.length === 0) return { state: "waiting", place: null, done: 0 };
    const mean = this.places.reduce((sum, place) => sum + place, 0) / this.places.length;
    const place = Math.min(REACH, Math.max(-REACH, mean));
    const [low, high] = CUES[this.target.cue].zone;
    return { state: place < low ? "low" : place > high ? "high" : "in", place, done: 0 };
  }
}

const SIDED = { left: "left", right: "right" };

/** One sentence, and guidance before praise: what to do, in words that ask for nothing but the next step. */
export function sentenceOf({ cue, target, side }, { state, done }) {
  if (state === "waiting") return cue === "repetitions" ? "Begin when you are ready" : "Walk when you are ready";
  const own = SIDED[side] ?? "left";
  switch (cue) {
    case "speed":
      return { low: "A little faster", in: "Just right, keep going", high: "A little slower" }[state];
    case "cadence":
      return { low: "Quicker steps", in: "Good rhythm, keep going", high: "Calmer steps" }[state];
    case "symmetry":
      return {
        low: "Left foot forward sooner",
        in: "Even steps, keep going",
        high: "Right foot forward sooner",
      }[state];
    case "knee":
      return state === "low" ? `Bend the ${own} knee more` : "Good bend, keep going";
    default:
      if (state === "in") return "Done, well done";
      return target - done <= 2 ? "Nearly there" : "Keep going";
  }
}
