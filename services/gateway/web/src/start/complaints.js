// What is wrong with a field stands beside it, in words, and is read out with it.
import { el } from "../dom.js";

/**
 * Look at every visible field of a step. Says what is wrong beside each, and goes to the first.
 * @param {HTMLElement} place @returns {boolean} whether nothing is
 */
export function isInOrder(place) {
  const fields = /** @type {NodeListOf<HTMLInputElement>} */ (place.querySelectorAll("input, select"));
  const seen = [...fields].filter((field) => field.closest("[hidden]") === null && field.type !== "radio");
  for (const field of seen) complain(field, field.validity.valid ? "" : field.validationMessage);
  const wrong = seen.find((field) => !field.validity.valid);
  const fold = wrong?.closest("details");
  if (fold) fold.open = true;
  wrong?.focus();
  return wrong === undefined;
}

/**
 * Say what is wrong with a field, or take it back with an empty text.
 * @param {HTMLElement} field @param {string} text
 */
export function complain(field, text) {
  const id = `${field.id}-wrong`;
  let place = document.getElementById(id);
  if (!place && text === "") return;
  if (!place) {
    place = el("span", { id, class: "field-wrong" });
    field.after(place);
  }
  place.textContent = text;
  place.hidden = text === "";
  if (text === "") {
    field.removeAttribute("aria-invalid");
    field.removeAttribute("aria-describedby");
  } else {
    field.setAttribute("aria-invalid", "true");
    field.setAttribute("aria-describedby", id);
  }
}
