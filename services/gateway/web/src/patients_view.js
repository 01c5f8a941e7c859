// @ts-check
// Patients as codes: who came last first, how they stand, and who they are once somebody asks for it.
import { post } from "./api.js";
import { GROUPS, PARETIC } from "./condition_words.js";
import { keepName } from "./directory.js";
import { el, fill, tell } from "./dom.js";
import { askForm } from "./form_dialog.js";
import { labelled } from "./form_fields.js";
import { PagedList, chip, moment, row, rowHead } from "./paged_list.js";
import { PatientFields } from "./patient_fields.js";
import { findPatients } from "./patient_search.js";
import { DIRECTIONS, VERDICTS } from "./rule_words.js";
import { when } from "./units.js";
import { TASKS, metricName } from "./words.js";

const TYPING_MS = 250;
const COLUMNS = ["Patient", "Born", "Group", "Paretic side", "Visits#", "Last visit", "Since the baseline"];

/** @typedef {import("./patient_search.js").Entry} Entry */

/** @param {import("./pages.js").Place} place */
export const open = ({ host, app }) => new PatientsView(host, app.me.may);

class PatientsView {
  showNames = false;
  /** @type {Map<string, import("./directory.js").Entry>} */
  names = new Map();

  /** @param {HTMLElement} host @param {string[]} may */
  constructor(host, may) {
    this.mayName = may.includes("names");
    this.search = el("input", { type: "search", maxlength: 60, autocomplete: "off", oninput: () => this.type() });
    this.group = el(
      "select",
      { onchange: () => this.list.restart() },
      el("option", { value: "" }, "All groups"),
      ...Object.entries(GROUPS).map(([value, name]) => el("option", { value }, name)),
    );
    this.trouble = el("p", { class: "banner", role: "status", hidden: true });
    this.toggle = el("button", { type: "button", "aria-pressed": "false", onclick: () => this.toggleNames() }, "Show names");
    this.toggle.hidden = !this.mayName;
    const add = el("button", { class: "primary", type: "button", onclick: () => this.register() }, "New patient");
    add.hidden = !may.includes("work");
    this.list = new PagedList({
      columns: COLUMNS,
      empty: [
        el("h2", {}, "Nobody is found"),
        el("p", {}, "Clear the search to see all patients, or register a new one."),
      ],
      read: (part) => this.read(part),
      row: (/** @type {Entry} */ entry) => this.row(entry),
    });
    fill(
      host,
      el(
        "section",
        { class: "panel listed", "aria-label": "Patients" },
        el("div", { class: "panel-head" }, el("h1", {}, "Patients"), el("span", { class: "spring" }), this.toggle, add),
        el(
          "div",
          { class: "filters" },
          labelled(this.mayName ? "Code, or part of the name" : "Code", this.search),
          labelled("Group", this.group),
        ),
        el("p", { class: "quiet" }, "A patient is a random code here. Names are in the clinic’s own directory and are shown only while you ask for them."),
        this.trouble,
        this.list.node,
      ),
    );
    this.list.refresh();
  }

  type() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.list.restart(), TYPING_MS);
  }

  toggleNames() {
    this.showNames = !this.showNames;
    this.toggle.setAttribute("aria-pressed", String(this.showNames));
    fill(this.toggle, this.showNames ? "Hide names" : "Show names");
    this.list.refresh();
  }

  /** @param {{offset: number, limit: number}} part */
  async read(part) {
    const { mayName, showNames } = this;
    const found = await findPatients(this.search.value.trim(), { mayName, showNames, population: this.group.value, ...part });
    this.names = found.names;
    tell(this.trouble, found.trouble);
    return found;
  }

  /** @param {Entry} entry */
  row(entry) {
    const { code, year_of_birth, population, paretic_side, visits, last_visit, shared } = entry;
    const name = this.showNames ? (this.names.get(code)?.name ?? "") : "";
    return row(
      rowHead(
        el("a", { class: "code", href: `#/patients/${code}` }, code),
        name ? el("span", { class: "person" }, name) : null,
        shared ? el("span", { class: "quiet" }, " shared with you") : null,
      ),
      year_of_birth ?? notSaid(),
      population ? GROUPS[population] : notSaid(),
      paretic_side ? PARETIC[paretic_side] : notSaid(),
      el("td", { class: "number" }, visits),
      moment(last_visit ? when(last_visit) : "never"),
      standing(entry),
    );
  }

  async register() {
    const fields = new PatientFields({ mayName: this.mayName });
    let code = "";
    const done = await askForm({
      title: "New patient",
      fields: [fields.node],
      action: "Register",
      act: async () => {
        // Asked again after the name could not be kept, the patient is there already.
        code ||= (await post("/patients", { body: fields.facts })).code;
        if (fields.identity) await keepName(code, fields.identity);
      },
    });
    if (done) location.hash = `#/patients/${code}`;
    else if (code) this.list.restart();
  }

  dispose() {
    clearTimeout(this.timer);
  }
}

const notSaid = () => el("span", { class: "quiet" }, "not said");

/** The verdict on the newest test, and what it is on. @param {Entry} entry */
function standing({ standing: found, visits }) {
  if (!found) return el("span", { class: "quiet" }, visits > 1 ? "no baseline yet" : "–");
  const { word, tone } = VERDICTS[found.verdict];
  const way = found.direction ? `, ${DIRECTIONS[found.direction]}` : "";
  const shown = chip(word + way, /** @type {any} */ (found.direction === "worse" ? "check" : tone));
  return [shown, el("span", { class: "quiet" }, ` ${metricName(found.measure)}${found.task === "walk" ? "" : `, ${TASKS[found.task].toLowerCase()}`}`)];
}
