// @ts-check
// The audit in words.
import { when } from "../units.js";

/** @typedef {import("../api_types").Models["VerificationOut"]} Verification */

/** The name of an operation as words. @param {string} action */
export function actionWord(action) {
  const words = action.replaceAll("_", " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** A UTC time in the reader's own zone, to the second. @param {string} iso */
export const precisely = (iso) => new Date(iso).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "medium" });

const LIVE = 101;

/** @param {number} status @returns {{ word: string, tone: "good" | "check" | "lost" | "none" }} */
export function outcomeOf(status) {
  if (status === LIVE) return { word: "Watched live", tone: "good" };
  if (status < 400) return { word: "Done", tone: "good" };
  if (status === 401) return { word: "Not signed in", tone: "lost" };
  if (status === 403) return { word: "Refused", tone: "lost" };
  if (status === 404) return { word: "Not found", tone: "none" };
  if (status === 429) return { word: "Too many requests", tone: "check" };
  return { word: status < 500 ? `Not done (${status})` : `Failed (${status})`, tone: "check" };
}

/** @param {Verification} verification */
export function verdictOn({ intact, entries, broken_entry, fault, signed_entry, signed_at }) {
  const signed = signed_entry === null ? "No entry is signed yet." : `Signed up to entry ${signed_entry}, ${when(signed_at)}.`;
  if (intact) return { text: `The chain is as it was written: ${entries} entries hang together. ${signed}`, tone: "good" };
  const place = broken_entry === null ? "" : ` at entry ${broken_entry}`;
  return { text: `The chain is not as it was written${place}. ${fault ?? ""} ${signed}`, tone: "lost" };
}
