// What the physio has chosen for a patient's screen. It goes by this browser's memory to other windows of the same
// computer, and in the address to a screen elsewhere. It names nobody.
import { CUES } from "./feedback_cues.js";
import { recall, remember } from "./screen_memory.js";

const NAME = "feedback";
const KEPT = 16;

/** @typedef {import("./feedback_cues.js").Target} Target */

/** @param {string} cue @returns {Target} */
export const usualTarget = (cue) => ({ cue, target: CUES[cue].usual, side: "left" });

/** A target from words of unknown origin; null when they name none. @param {any} words @returns {Target|null} */
export function targetFrom({ cue, target, side }) {
  if (!Object.hasOwn(CUES, String(cue))) return null;
  const { least, most, usual } = CUES[cue];
  const value = Number(target);
  const kept = target !== null && Number.isFinite(value) ? Math.min(most, Math.max(least, value)) : usual;
  return { cue, target: kept, side: side === "right" ? "right" : "left" };
}

function all() {
  try {
    const kept = JSON.parse(recall(NAME) ?? "[]");
    return Array.isArray(kept) ? kept : [];
  } catch {
    return [];
  }
}

/** @param {string} session @returns {Target|null} */
export function keptTarget(session) {
  const found = all().find((each) => each.session === session);
  return found ? targetFrom(found) : null;
}

/** @param {string} session @param {Target} target */
export function keepTarget(session, target) {
  const others = all().filter((each) => each.session !== session);
  remember(NAME, JSON.stringify([{ session, ...target }, ...others].slice(0, KEPT)));
}

/** Address of the patient's screen with its target. @param {string} session @param {Target} target */
export const feedbackAddress = (session, { cue, target, side }) =>
  `#/feedback/${session}?${new URLSearchParams({ cue, target: String(target), side })}`;

/** The target in an address. @param {string} hash @returns {Target|null} */
export function targetOfAddress(hash) {
  return targetFrom(Object.fromEntries(new URLSearchParams(hash.split("?")[1] ?? "")));
}

/** Call when another window of this browser has chosen anew; gives what ends it. @param {() => void} callback */
export function whenChosenElsewhere(callback) {
  const listen = (/** @type {StorageEvent} */ event) => event.key === `ambula.${NAME}` && callback();
  window.addEventListener("storage", listen);
  return () => window.removeEventListener("storage", listen);
}
