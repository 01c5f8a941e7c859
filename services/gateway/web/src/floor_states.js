// How everybody on the floor is, from the gateway's newest list, trouble first.
import { STALE_S, byTrouble, stateOf } from "./words.js";

/** The list comes twice a second: so long an age need not grow on the screen, only in the judgement. */
const BETWEEN_S = 0.55;

/**
 * @typedef {{session: any, age_s: number|null, word: string, tone: string, light: string, stale: boolean}} Entry
 */

/**
 * Everybody of the list with their state, worst first, then by start.
 * @param {any} status the newest list @param {number} since_s how long ago it came @returns {Entry[]}
 */
export function entriesOf(status, since_s) {
  const entries = status.sessions.map((/** @type {any} */ session) => {
    const known = session.age_s !== null;
    const judged_s = known ? session.age_s + since_s : null;
    const state = stateOf({
      ...session,
      age_s: judged_s,
      segments: session.sensor_segments,
      silent: status.silent,
      preparing: status.preparing,
      heard: status.connected,
    });
    const shown_s = known ? session.age_s + (since_s > BETWEEN_S ? since_s : 0) : null;
    return { session, age_s: shown_s, stale: known && judged_s > STALE_S, ...state };
  });
  return entries.sort(
    (/** @type {Entry} */ x, /** @type {Entry} */ y) =>
      byTrouble(x, y) || x.session.started_unix_s - y.session.started_unix_s,
  );
}

/** Somebody should look: a sensor, the line or the recording is not as it should be. @param {Entry} entry */
export const needsLook = ({ tone }) => tone === "lost" || tone === "check";

/** "16 live, 2 need a look". @param {Entry[]} entries */
export function countsOf(entries) {
  const troubled = entries.filter(needsLook).length;
  if (entries.length === 0) return "";
  if (troubled === 0) return `${entries.length} live, none needs a look`;
  return `${entries.length} live, ${troubled} ${troubled === 1 ? "needs" : "need"} a look`;
}
