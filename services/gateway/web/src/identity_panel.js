// @ts-check
// Who is behind the code. Shown only once asked for; kept in the clinic's directory, never beside measurements.
import { get, remove } from "./api.js";
import { confirmPassword } from "./confirm_password.js";
import { keepName } from "./directory.js";
import { el, fill, tell } from "./dom.js";
import { askForm } from "./form_dialog.js";
import { labelled, textInput } from "./form_fields.js";

/** @typedef {import("./directory.js").Entry} Entry */

export class IdentityPanel {
  /** @param {string} code */
  constructor(code) {
    this.code = code;
    this.told = el("span", { class: "person" });
    this.problem = el("span", { class: "quiet", role: "status" });
    this.buttons = el("span", { class: "actions" });
    this.node = el("div", { class: "identity" }, this.told, this.buttons, this.problem);
    this.hide();
  }

  hide() {
    fill(this.told);
    fill(this.buttons, this.button("Show name", () => this.show()));
  }

  async show() {
    tell(this.problem, "");
    try {
      this.offer(await get("/patients/{code}/name", { code: this.code }));
    } catch (problem) {
      if (/** @type {import("./api.js").ApiProblem} */ (problem).status === 404) this.offer(null);
      else tell(this.problem, /** @type {Error} */ (problem).message);
    }
  }

  /** @param {Entry | null} known */
  offer(known) {
    const { name, record_number } = known ?? { name: "No name is known", record_number: null };
    fill(this.told, record_number ? `${name} (${record_number})` : name);
    fill(
      this.buttons,
      this.button("Hide", () => this.hide()),
      this.button(known ? "Change" : "Add a name", () => this.change(known)),
      known ? this.button("Forget", () => this.forget()) : null,
    );
  }

  /** @param {string} word @param {() => unknown} act */
  button(word, act) {
    return el("button", { class: "quiet-button", type: "button", onclick: act }, word);
  }

  /** @param {Entry | null} known */
  async change(known) {
    const name = textInput({ required: true, maxlength: 120, value: known?.name });
    const record = textInput({ maxlength: 40, value: known?.record_number });
    await askForm({
      title: `Who is ${this.code}?`,
      about: "Kept in the clinic’s directory alone. It is in no recording, report file or log.",
      fields: [labelled("Name", name), labelled("Record number", record)],
      action: "Keep",
      act: async () => this.offer(await keepName(this.code, { name: name.value, record_number: record.value.trim() || null })),
    });
  }

  async forget() {
    const done = await confirmPassword({
      title: `Forget the name of ${this.code}`,
      about: "What was measured stays under the code. Without a note of your own nobody can tell whose it is.",
      action: "Forget the name",
      act: () => remove("/patients/{code}/name", { code: this.code }),
    });
    if (done) this.offer(null);
  }
}
