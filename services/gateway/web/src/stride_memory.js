// The last strides of one leg as they were drawn, so that one of them can walk along as a ghost.
import { between } from "./figure.js";
import { SIDES } from "./vectors.js";

const KEPT_S = 15;
const KEPT_STRIDES = 10;
/** Fewer pictures than that are no stride: half a second of a slow line. */
const FEWEST_PICTURES = 6;
const FEWEST_TO_COMPARE = 3;
const POINTS = 21;
/** A ghost stops with the person: after so many strides without a new one. */
const PATIENCE_STRIDES = 2.5;
const COMPARED = ["hip_flexion", "knee_flexion"].flatMap((joint) => SIDES.map((side) => `${joint}_${side}`));

/** What can be chosen, and what it means. */
export const GHOSTS = {
  off: { word: "No ghost", meaning: "Only the person" },
  best: {
    word: "Best stride",
    meaning: "Of the last ten straight strides of this leg, the one whose hip and knee angles lie closest to their mean",
  },
  previous: { word: "Previous stride", meaning: "The last whole straight stride of this leg" },
};

/**
 * @typedef {{at_s: number, figure: any, angles: Record<string, number>}} Picture
 * @typedef {{start_s: number, end_s: number, pictures: Picture[], curves: Map<string, number[]>}} KeptStride
 */

export class StrideMemory {
  constructor() {
    /** @type {Picture[]} */
    this.pictures = [];
    /** @type {Record<string, KeptStride[]>} */
    this.strides = { left: [], right: [] };
  }

  /** @param {number} at_s @param {any} figure @param {Record<string, number>} angles */
  add(at_s, figure, angles) {
    const last = this.pictures.at(-1);
    if (last && at_s < last.at_s) this.clear();
    this.pictures.push({ at_s, figure, angles });
    while (this.pictures[0].at_s < at_s - KEPT_S) this.pictures.shift();
  }

  /** A stride is over; only a straight one that counts is kept. @param {any} stride */
  onStride({ side, start_s, end_s, valid, turning }) {
    if (!valid || turning) return;
    const pictures = this.pictures.filter(({ at_s }) => at_s >= start_s && at_s <= end_s);
    if (pictures.length < FEWEST_PICTURES) return;
    const kept = this.strides[side];
    kept.push({ start_s, end_s, pictures, curves: curvesOf(pictures, start_s, end_s) });
    if (kept.length > KEPT_STRIDES) kept.shift();
  }

  clear() {
    this.pictures = [];
    this.strides = { left: [], right: [] };
  }

  /** The stride that is meant by "best" or "previous"; null while there is none. @param {string} kind @param {string} side */
  chosen(kind, side) {
    const kept = this.strides[side] ?? [];
    if (kind === "previous") return kept.at(-1) ?? null;
    return kind === "best" ? closestToMean(kept) : null;
  }

  /**
   * The ghost's figure at session time `now_s`, facing `heading`; null where there is nothing to show.
   * It walks in the rhythm of the last stride, from whose end its own stride begins again.
   * @param {string} kind @param {string} side @param {number} now_s @param {number} heading rad
   */
  ghost(kind, side, now_s, heading) {
    const stride = this.chosen(kind, side);
    const newest = this.strides[side]?.at(-1);
    if (!stride || !newest) return null;
    const passed = (now_s - newest.end_s) / (newest.end_s - newest.start_s);
    if (passed < 0 || passed > PATIENCE_STRIDES) return null;
    const at_s = stride.start_s + (passed % 1) * (stride.end_s - stride.start_s);
    return facing(pictureAt(stride.pictures, at_s), heading);
  }
}

/** @param {Picture[]} pictures @param {number} at_s */
function pictureAt(pictures, at_s) {
  const next = pictures.findIndex((each) => each.at_s >= at_s);
  if (next <= 0) return pictures.at(next === 0 ? 0 : -1).figure;
  const [before, after] = [pictures[next - 1], pictures[next]];
  return between(before.figure, after.figure, (at_s - before.at_s) / (after.at_s - before.at_s));
}

/** The figure turned about the vertical. @param {any} figure @param {number} heading rad, positive to the left */
function facing(figure, heading) {
  const turn = heading - figure.heading;
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  const points = Object.fromEntries(
    Object.entries(figure.points).map(([name, [x, y, z]]) => [name, [x * cos + z * sin, y, z * cos - x * sin]]),
  );
  return { ...figure, points, heading };
}

/** Angles at even shares of the stride, of those that were known throughout. */
function curvesOf(/** @type {Picture[]} */ pictures, /** @type {number} */ start_s, /** @type {number} */ end_s) {
  const known = COMPARED.filter((name) => pictures.every(({ angles }) => angles[name] !== undefined));
  const times = Array.from({ length: POINTS }, (_, i) => start_s + ((end_s - start_s) * i) / (POINTS - 1));
  return new Map(known.map((name) => [name, times.map((at_s) => angleAt(pictures, name, at_s))]));
}

function angleAt(/** @type {Picture[]} */ pictures, /** @type {string} */ name, /** @type {number} */ at_s) {
  const next = pictures.findIndex((each) => each.at_s >= at_s);
  if (next <= 0) return pictures.at(next === 0 ? 0 : -1).angles[name];
  const [before, after] = [pictures[next - 1], pictures[next]];
  const share = (at_s - before.at_s) / (after.at_s - before.at_s);
  return before.angles[name] + share * (after.angles[name] - before.angles[name]);
}

/** The stride whose known curves are, in the mean of squares, nearest to the mean of all. */
function closestToMean(/** @type {KeptStride[]} */ kept) {
  if (kept.length < FEWEST_TO_COMPARE) return null;
  const names = [...kept[0].curves.keys()].filter((name) => kept.every(({ curves }) => curves.has(name)));
  if (names.length === 0) return null;
  const means = new Map(
    names.map((name) => [
      name,
      Array.from({ length: POINTS }, (_, i) => kept.reduce((sum, { curves }) => sum + curves.get(name)[i], 0) / kept.length),
    ]),
  );
  const distance = (/** @type {KeptStride} */ { curves }) =>
    names.reduce(
      (sum, name) => sum + curves.get(name).reduce((part, value, i) => part + (value - means.get(name)[i]) ** 2, 0),
      0,
    );
  return kept.reduce((best, each) => (distance(each) < distance(best) ? each : best));
}
