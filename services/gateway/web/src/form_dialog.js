// @ts-check
// A question in front of the page: fields, one thing to do, and what was wrong with it when it did not work.
import { el, tell } from "./dom.js";

/**
 * Ask, and do it. The dialog stays open with the reason while it does not work.
 * @param {object} wish
 * @param {string} wish.title
 * @param {string} [wish.about] what will happen
 * @param {Node[]} wish.fields
 * @param {string} wish.action word on the button
 * @param {boolean} [wish.danger] whether it takes something away
 * @param {boolean} [wish.over] whether it has happened already: there is nothing to cancel
 * @param {() => Promise<unknown>} wish.act what the button does; its errors are shown
 * @returns {Promise<boolean>} whether it was done
 */
export function askForm({ title, about, fields, action, danger = false, over = false, act }) {
  const problem = el("p", { class: "banner", role: "alert", hidden: true });
  const go = el("button", { class: danger ? "danger" : "primary", type: "submit" }, action);
  const dialog = el("dialog", { class: "form-dialog" });
  const cancel = el("button", { type: "button", hidden: over, onclick: () => dialog.close() }, "Cancel");
  const heading = el("h2", { id: "form-dialog-title" }, title);
  let done = false;

  /** @param {SubmitEvent} event */
  async function submit(event) {
    event.preventDefault();
    tell(problem, "");
    go.disabled = true;
    try {
      await act();
      done = true;
      dialog.close();
    } catch (error) {
      tell(problem, error instanceof Error ? error.message : String(error));
    } finally {
      go.disabled = false;
    }
  }

  const form = el(
    "form",
    { onsubmit: submit },
    heading,
    about ? el("p", {}, about) : null,
    ...fields,
    problem,
    el("div", { class: "actions" }, cancel, go),
  );
  dialog.setAttribute("aria-labelledby", heading.id);
  dialog.append(form);
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(done);
    });
    dialog.addEventListener("cancel", (event) => over && event.preventDefault());
    // Whoever leaves the page has left the question, too.
    window.addEventListener("hashchange", () => dialog.close(), { once: true });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** Show a text once, with a button that copies it. @param {{ title: string, about: string, text: string }} wish */
export function showOnce({ title, about, text }) {
  const shown = el("code", { class: "secret" }, text);
  const told = el("span", { class: "quiet", role: "status" });
  const copy = el("button", { type: "button", onclick: () => copyText(shown, told) }, "Copy");
  const fields = [el("div", { class: "copied" }, shown, copy), told];
  return askForm({ title, about, fields, action: "I have kept it", over: true, act: async () => {} });
}

/** Without a clipboard (plain http on a network) it is selected, to be copied by hand. @param {HTMLElement} shown @param {HTMLElement} told */
async function copyText(shown, told) {
  try {
    await navigator.clipboard.writeText(shown.textContent ?? "");
    told.textContent = "Copied.";
  } catch {
    getSelection()?.selectAllChildren(shown);
    told.textContent = "Selected: press Ctrl and C to copy it.";
  }
}
