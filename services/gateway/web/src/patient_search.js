// @ts-check
// Finding patients: by code for everybody, by name where the directory may be asked.
import { get } from "./api.js";
import { namesOf, searchNames } from "./directory.js";

const LEAST_LETTERS = 2;
const CODE = /^[0-9A-Za-z]{1,16}$/;

/**
 * @typedef {import("./api_types").Models["RosterEntryOut"]} Entry
 * @typedef {{items: Entry[], total: number, names: Map<string, import("./directory.js").Entry>, trouble: string}} Found
 *   `trouble`: why nobody is found by name
 */

/** @type {{items: Entry[], total: number}} */
const NOBODY = { items: [], total: 0 };

/**
 * Patients whose code, or name, has the text in it; all of them for an empty text.
 * @param {string} text
 * @param {{mayName: boolean, showNames?: boolean, population?: string | null, offset?: number, limit?: number}} how
 *   `showNames`: ask who they are, too
 * @returns {Promise<Found>}
 */
export async function findPatients(text, { mayName, showNames = false, population = null, offset = 0, limit = 25 }) {
  const group = /** @type {any} */ (population || null);
  let trouble = "";
  // Whoever knows the code is served without the directory.
  const without = (/** @type {Error} */ problem) => {
    trouble = problem.message;
    return /** @type {import("./directory.js").Entry[]} */ ([]);
  };
  const [byCode, called] = await Promise.all([
    text === "" || CODE.test(text) ? get("/roster", { search: text || null, population: group, offset, limit }) : NOBODY,
    mayName && text.length >= LEAST_LETTERS ? searchNames(text).catch(without) : [],
  ]);
  const names = new Map();
  const others = called.map(({ code }) => code).filter((code) => !byCode.items.some((entry) => entry.code === code));
  const byName = others.length > 0 && offset === 0 ? await get("/roster", { code: others.slice(0, 100), population: group }) : NOBODY;
  const items = [...byName.items, ...byCode.items];
  const known = mayName && showNames ? await namesOf(items.map(({ code }) => code)).catch(without) : [];
  for (const entry of [...called, ...known]) names.set(entry.code, entry);
  return { items, total: byName.total + byCode.total, names, trouble };
}
