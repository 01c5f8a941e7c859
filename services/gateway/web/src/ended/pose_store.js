// @ts-check
// Pictures of a recording, ten seconds at a time: those around now and those that come next, and not the whole of it.
import { get } from "../api.js";

export const CHUNK_S = 10;
export const RATE_HZ = 25;
const BEFORE_S = 8;
const MOST_ASKED = 3;
const KEPT = 12;
const AGAIN_MS = 2000;

/** @typedef {import("../api_types").Models["PoseOut"]} Pose */

export class PoseStore {
  /** @type {Map<number, Pose[] | null>} null while it is asked for */
  chunks = new Map();
  closed = false;
  asked = 0;
  wanted_s = 0;

  /**
   * @param {string} session @param {number} end_s
   * @param {{ onLoaded: () => void, onTrouble: (text: string) => void }} told
   */
  constructor(session, end_s, { onLoaded, onTrouble }) {
    this.session = session;
    this.last = placeOf(end_s);
    this.onLoaded = onLoaded;
    this.onTrouble = onTrouble;
  }

  /** Have the pictures at a time, those that curves show before it, and those that come after. @param {number} at_s */
  need(at_s) {
    this.wanted_s = at_s;
    this.askOn();
  }

  /** What is wanted now, a few at a time: whoever drags over an hour does not ask for all of it. */
  askOn() {
    const place = placeOf(this.wanted_s);
    for (const each of [place, placeOf(this.wanted_s - BEFORE_S), place + 1]) {
      if (this.asked >= MOST_ASKED) return;
      this.ask(each);
    }
  }

  /** Whether the picture of a time is there. @param {number} at_s */
  isReady(at_s) {
    return Boolean(this.chunks.get(placeOf(at_s)));
  }

  /** The newest picture at or before a time; null where there is none. @param {number} at_s @returns {Pose | null} */
  at(at_s) {
    for (const place of [placeOf(at_s), placeOf(at_s) - 1]) {
      const poses = this.chunks.get(place) ?? [];
      const count = countUntil(poses, at_s);
      if (count > 0) return poses[count - 1];
    }
    return null;
  }

  /** Pictures later than one time, up to another. @param {number} after_s @param {number} until_s @returns {Pose[]} */
  between(after_s, until_s) {
    const found = [];
    for (let place = placeOf(Math.max(0, after_s)); place <= placeOf(until_s); place += 1) {
      const poses = this.chunks.get(place) ?? [];
      found.push(...poses.slice(countUntil(poses, after_s), countUntil(poses, until_s)));
    }
    return found;
  }

  /** @param {number} place */
  async ask(place) {
    if (place < 0 || place > this.last || this.chunks.has(place) || this.closed) return;
    this.chunks.set(place, null);
    this.asked += 1;
    const from_s = place * CHUNK_S;
    try {
      const wish = { session: this.session, from_s, to_s: from_s + CHUNK_S, rate_hz: RATE_HZ };
      const { poses } = await get("/sessions/{session}/poses", wish);
      this.asked -= 1;
      this.keep(place, poses);
      this.askOn();
    } catch (problem) {
      this.asked -= 1;
      this.chunks.delete(place);
      if (this.closed) return;
      this.onTrouble(/** @type {Error} */ (problem).message);
      setTimeout(() => this.askOn(), AGAIN_MS);
    }
  }

  /** @param {number} place @param {Pose[]} poses */
  keep(place, poses) {
    if (this.closed) return;
    // What was asked for first goes first; it can be had again.
    const loaded = [...this.chunks].filter(([, kept]) => kept !== null).map(([each]) => each);
    const far = loaded.filter((each) => Math.abs(each - place) > 1);
    for (const each of far.slice(0, Math.max(0, loaded.length + 1 - KEPT))) this.chunks.delete(each);
    this.chunks.set(place, poses);
    this.onLoaded();
  }

  close() {
    this.closed = true;
    this.chunks.clear();
  }
}

/** @param {number} at_s */
const placeOf = (at_s) => Math.floor(at_s / CHUNK_S);

/** How many of some things in the order of time are at or before a time. @param {{at_s: number}[]} sorted @param {number} at_s */
export function countUntil(sorted, at_s) {
  let [low, high] = [0, sorted.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle].at_s <= at_s) low = middle + 1;
    else high = middle;
  }
  return low;
}
