// @ts-check
// Fields of forms: a label, what is typed or chosen, and a line that says what is wanted.
import { el } from "./dom.js";

/** @typedef {HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement} Input */

/** @type {number} */
let count = 0;

/** An id that nothing else on the page has. */
export const freshId = () => `field-${(count += 1)}`;

/**
 * A field under its label. `hint` says what is wanted, in the field's description.
 * @param {string} label @param {Input} input @param {string} [hint]
 */
export function labelled(label, input, hint) {
  input.id ||= freshId();
  const told = hint ? el("span", { class: "hint", id: `${input.id}-hint` }, hint) : null;
  if (told) input.setAttribute("aria-describedby", told.id);
  return el("div", { class: "field" }, el("label", { for: input.id }, label), input, told);
}

/** @param {Record<string, unknown>} [attributes] */
export const textInput = (attributes = {}) =>
  el("input", { type: "text", autocomplete: "off", spellcheck: "false", autocapitalize: "none", ...attributes });

/** A password. @param {"current-password" | "new-password"} kind */
export const passwordInput = (kind) =>
  el("input", { type: "password", required: true, maxlength: 200, autocomplete: kind });

/** A choice of words; `chosen` is the value that is chosen at first. @param {[string, string][]} options @param {string} [chosen] */
export function choice(options, chosen) {
  const select = el("select", {}, ...options.map(([value, word]) => el("option", { value }, word)));
  if (chosen !== undefined) select.value = chosen;
  return select;
}
