// What was done for the patient and when: marks beside the progress. No verdict rests on them.
import { get, post, remove } from "./api.js";
import { field } from "./conditions_form.js";
import { el, fill, say } from "./dom.js";
import { TREATMENTS } from "./rule_words.js";

export class TreatmentsPanel {
  constructor(code, { onChange }) {
    this.code = code;
    this.onChange = onChange;
    this.list = el("ul", { class: "files" });
    this.date = el("input", { id: "treated-on", type: "date", required: true });
    this.kind = el(
      "select",
      { id: "treatment" },
      ...Object.entries(TREATMENTS).map(([kind, name]) => el("option", { value: kind }, name)),
    );
    this.told = el("p", { class: "quiet", role: "status" });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Treatments" },
      el("h2", {}, "Treatments"),
      el("p", { class: "quiet" }, "Shown as marks beside the progress; no verdict rests on them."),
      this.list,
      el(
        "form",
        { class: "fields", onsubmit: (event) => this.add(event) },
        field("On", this.date),
        field("What", this.kind),
        el("button", { type: "submit" }, "Add"),
      ),
      this.told,
    );
  }

  load() {
    return get("/patients/{code}/treatments", { code: this.code, limit: 100 }).then((page) => page.items);
  }

  /** @param {{id: number, date: string, kind: string, letter: string}[]} treatments in order */
  show(treatments) {
    const lines = treatments.map(({ id, date, kind, letter }) =>
      el(
        "li",
        {},
        el("b", {}, letter),
        el("span", {}, `${date}  ${TREATMENTS[kind]}`),
        el("span", { class: "spring" }),
        el(
          "button",
          {
            class: "quiet-button",
            type: "button",
            "aria-label": `Remove ${TREATMENTS[kind]} of ${date}`,
            onclick: () => this.attempt(() => remove("/patients/{code}/treatments/{number}", { code: this.code, number: id })),
          },
          "Remove",
        ),
      ),
    );
    fill(this.list, ...(lines.length > 0 ? lines : [el("li", { class: "quiet" }, "None noted.")]));
  }

  add(event) {
    event.preventDefault();
    return this.attempt(() => post("/patients/{code}/treatments", { code: this.code, body: { date: this.date.value, kind: /** @type {any} */ (this.kind.value) } }));
  }

  async attempt(action) {
    try {
      await action();
      say(this.told, "");
      this.onChange();
    } catch (problem) {
      say(this.told, problem.message);
    }
  }
}
