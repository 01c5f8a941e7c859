// Patients as codes. Who is behind a code is known outside of Ambula.
import { get, post } from "./api.js";
import { GROUPS, PARETIC } from "./condition_words.js";
import { el, fill, say, table } from "./dom.js";
import { when } from "./units.js";

const PAGE = 50;

/** @param {import("./pages.js").Place} place */
export const open = ({ host }) => new PatientsView(host);

export class PatientsView {
  constructor(host) {
    this.rows = el("tbody");
    this.total = el("span", { class: "quiet" });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.offset = 0;
    fill(
      host,
      el(
        "section",
        { class: "panel", "aria-label": "Patients" },
        el(
          "div",
          { class: "panel-head" },
          el("h1", {}, "Patients"),
          this.total,
          el("span", { class: "spring" }),
          el("button", { type: "button", onclick: () => this.turn(-PAGE) }, "Newer"),
          el("button", { type: "button", onclick: () => this.turn(PAGE) }, "Older"),
          el("button", { class: "primary", type: "button", onclick: () => this.add() }, "New patient"),
        ),
        el(
          "p",
          { class: "quiet" },
          "A patient is a random code here. Write it on the chart; names do not belong into this software.",
        ),
        this.problem,
        table(["Code", "Year of birth", "Group", "Paretic side", "Sessions#", "Registered"], this.rows),
      ),
    );
    this.load();
  }

  turn(by) {
    if (this.offset + by >= 0 && this.offset + by < this.count) this.load((this.offset += by));
  }

  async load() {
    await this.attempt(async () => {
      const page = await get("/patients", { limit: PAGE, offset: this.offset });
      this.count = page.total;
      say(this.total, `${page.total} in all`);
      fill(
        this.rows,
        page.items.length > 0
          ? page.items.map((patient) => this.row(patient))
          : el("tr", {}, el("td", { colspan: 6, class: "quiet" }, "No patients yet.")),
      );
    });
  }

  row({ code, year_of_birth, population, paretic_side, sessions, created }) {
    const known = [year_of_birth, GROUPS[population], PARETIC[paretic_side]];
    return el(
      "tr",
      {},
      el("th", { scope: "row" }, el("a", { class: "code", href: `#/patients/${code}` }, code)),
      ...known.map((value) => (value ? el("td", {}, String(value)) : el("td", { class: "quiet" }, "not said"))),
      el("td", { class: "number" }, String(sessions)),
      el("td", {}, when(created)),
    );
  }

  async add() {
    await this.attempt(async () => (location.hash = `#/patients/${(await post("/patients", { body: {} })).code}`));
  }

  async attempt(action) {
    this.problem.hidden = true;
    try {
      await action();
    } catch (problem) {
      say(this.problem, problem.message);
      this.problem.hidden = false;
    }
  }

  dispose() {}
}
