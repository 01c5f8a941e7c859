// @ts-check
// Names live in the clinic's own directory, apart from everything measured. They are asked for, never kept here.
import { post, put } from "./api.js";

/** @typedef {{code: string, name: string, record_number: string | null}} Entry */

/** Whose name or record number has the text in it. @param {string} text @returns {Promise<Entry[]>} */
export const searchNames = async (text) => (await post("/directory/search", { body: { text } })).items;

/** Who is behind these codes; whom the directory does not know is left out. @param {string[]} codes @returns {Promise<Entry[]>} */
export const namesOf = async (codes) => (codes.length > 0 ? (await post("/directory/names", { body: { codes } })).items : []);

/** Write down who is behind a code. @param {string} code @param {{name: string, record_number: string | null}} identity */
export const keepName = (code, identity) => put("/patients/{code}/name", { code, body: identity });
