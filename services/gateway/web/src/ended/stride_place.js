// @ts-check
// Which stride a moment is in.
import { countUntil } from "./pose_store.js";

/** @typedef {import("../api_types").Models["StrideOut"]} Stride */

/** Strides that end after a moment and may have begun before it: those of both sides, and one to spare. */
const NEAR = 3;

/**
 * Place of the stride that a moment is in, the one that ends first; null between strides.
 * @param {Stride[]} strides in the order of their ends @param {{at_s: number}[]} ends theirs @param {number} at_s
 */
export function strideAt(strides, ends, at_s) {
  const first = countUntil(ends, at_s);
  const near = strides.slice(first, first + NEAR).findIndex(({ start_s }) => start_s <= at_s + 1e-6);
  return near < 0 ? null : first + near;
}

/** @param {Stride} stride */
export function strideWords({ side, index, valid, rejected_because }) {
  const why = valid ? "" : `, does not count: ${rejected_because ?? "not known"}`;
  return `${side === "left" ? "Left" : "Right"} stride ${index + 1}${why}`;
}
