// @ts-check
// Colleagues of other clinics who may see the patient. There is no list of people: one knows their login.
import { get, post, remove } from "./api.js";
import { confirmPassword } from "./confirm_password.js";
import { el, fill, tell } from "./dom.js";
import { labelled, textInput } from "./form_fields.js";
import { when } from "./units.js";

/** @typedef {import("./api_types").Models["ShareOut"]} Share */

export class SharesPanel {
  /** @param {string} code */
  constructor(code) {
    this.code = code;
    this.list = el("ul", { class: "files" });
    this.login = textInput({ required: true, maxlength: 64 });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Shared with" },
      el("h2", {}, "Shared with"),
      el("p", { class: "quiet" }, "A colleague of another clinic sees this patient and may start sessions; the name stays here."),
      this.list,
      this.problem,
      el(
        "form",
        { class: "share-form", onsubmit: (event) => this.add(event) },
        labelled("Login of the colleague", this.login),
        el("button", { type: "submit" }, "Share"),
      ),
    );
    this.load();
  }

  async load() {
    try {
      const { items } = await get("/patients/{code}/shares", { code: this.code });
      fill(this.list, items.length > 0 ? items.map((share) => this.line(share)) : el("li", { class: "quiet" }, "Nobody outside of this clinic."));
    } catch (problem) {
      // Somebody to whom the patient was shared does not share it on.
      this.node.hidden = /** @type {import("./api.js").ApiProblem} */ (problem).status === 403;
      tell(this.problem, /** @type {Error} */ (problem).message);
    }
  }

  /** @param {Share} share */
  line(share) {
    const { login, clinic_name, granted } = share;
    const end = el("button", { class: "quiet-button", type: "button", onclick: () => this.end(share) }, "End", el("span", { class: "unseen" }, ` the share with ${login}`));
    const since = el("span", { class: "quiet" }, `${clinic_name}, since ${when(granted)}`);
    return el("li", {}, el("b", {}, login), since, el("span", { class: "spring" }), end);
  }

  /** @param {SubmitEvent} event */
  async add(event) {
    event.preventDefault();
    tell(this.problem, "");
    try {
      const { account } = await get("/colleagues", { login: this.login.value.trim() });
      await post("/patients/{code}/shares", { code: this.code, body: { account } });
      this.login.value = "";
      await this.load();
    } catch (problem) {
      tell(this.problem, /** @type {Error} */ (problem).message);
    }
  }

  /** @param {Share} share */
  async end({ account, login }) {
    await confirmPassword({
      title: `End the share with ${login}`,
      about: "They do not see the patient any more, on open pages within seconds.",
      action: "End the share",
      act: () => remove("/patients/{code}/shares/{account}", { code: this.code, account }),
    });
    await this.load();
  }
}
