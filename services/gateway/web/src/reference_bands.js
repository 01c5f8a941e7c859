// What people like this one have, for each measure of a test: from the session that came last, at the speed walked then.
import { get } from "./api.js";
import { shown } from "./units.js";

/** @typedef {{low: number, high: number, title: string, citation: string, n: number | null}} Band in shown units */

const keyOf = ({ task, instruction, measure }) => [task, instruction, measure].join(" ");

/**
 * Bands by test and measure; those that fit nobody are missing.
 * @param {object[]} series of the API @returns {Promise<Map<string, Band>>}
 */
export async function readBands(series) {
  const newest = newestOfTests(series);
  const found = new Map();
  await Promise.all(
    [...new Set(newest.values())].map(async (session) => {
      const told = await get("/sessions/{session}/references", { session }).catch(() => null);
      for (const { measure, unit, band } of told?.metrics ?? []) {
        const { factor } = shown(unit, measure);
        const { low, high, title, citation, n } = band ?? {};
        for (const [test, from] of newest)
          if (band && from === session) found.set(`${test} ${measure}`, { low: factor * low, high: factor * high, title, citation, n });
      }
    }),
  );
  return found;
}

/** @param {Map<string, Band>} bands @param {object} each of a test and measure */
export const bandOf = (bands, each) => bands.get(keyOf(each)) ?? null;

/** The session of each test that came last. @param {object[]} series @returns {Map<string, string>} */
function newestOfTests(series) {
  const newest = new Map();
  const last = new Map();
  for (const { task, instruction, points } of series) {
    const test = [task, instruction].join(" ");
    for (const { visit, session } of points) {
      if (visit < (last.get(test) ?? 0)) continue;
      last.set(test, visit);
      newest.set(test, session);
    }
  }
  return newest;
}
