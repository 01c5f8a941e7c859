// Who is it? Somebody registered, somebody new, or nobody said yet.
import { post } from "../api.js";
import { field } from "../conditions_form.js";
import { GROUPS, PARETIC } from "../condition_words.js";
import { keepName } from "../directory.js";
import { el, fill, say } from "../dom.js";
import { findPatients } from "../patient_search.js";
import { PatientFields } from "../patient_fields.js";
import { complain, isInOrder } from "./complaints.js";

const LATER = "later";
const KNOWN = "known";
const NEW = "new";
const WAYS = {
  [LATER]: "Assign later",
  [KNOWN]: "A patient of ours",
  [NEW]: "Register a new patient",
};
const TYPING_MS = 250;

/** @typedef {{code: string, paretic_side: string|null}} Chosen */

export class PatientStep {
  title = "Whose session is it?";

  /** @param {{mayName: boolean, preselected?: string}} known */
  constructor({ mayName, preselected }) {
    this.mayName = mayName;
    /** @type {Chosen|null} */
    this.chosen = null;
    this.way = preselected ? KNOWN : LATER;
    this.search = el("input", {
      id: "patient-search",
      type: "search",
      maxlength: 60,
      autocomplete: "off",
      oninput: () => this.type(),
    });
    this.found = el("div", { class: "found", role: "radiogroup", "aria-label": "Patients found" });
    this.told = el("p", { class: "quiet", role: "status" });
    this.fields = new PatientFields({ mayName });
    this.known = el(
      "div",
      { class: "step-part" },
      field(mayName ? "Code, or part of the name" : "Code", this.search),
      this.found,
      this.told,
    );
    this.fresh = el("div", { class: "step-part" }, this.fields.node);
    this.later = el(
      "p",
      { class: "quiet step-part" },
      "The session can be given to a patient on its page, while it runs or afterwards. Until then it counts for nobody’s progress.",
    );
    this.ways = Object.entries(WAYS).map(([way, words]) => this.wayOf(way, words));
    this.node = el(
      "div",
      { class: "step-body" },
      el("fieldset", { class: "ways" }, el("legend", { class: "unseen" }, "Patient"), ...this.ways),
      this.known,
      this.fresh,
      this.later,
    );
    this.show();
    this.look(preselected ?? "", preselected);
  }

  /** @param {string} way @param {string} words */
  wayOf(way, words) {
    const choose = () => {
      this.way = way;
      this.show();
    };
    const input = el("input", { type: "radio", name: "patient-way", value: way, checked: way === this.way, onchange: choose });
    return el("label", {}, input, words);
  }

  show() {
    this.known.hidden = this.way !== KNOWN;
    this.fresh.hidden = this.way !== NEW;
    this.later.hidden = this.way !== LATER;
  }

  type() {
    clearTimeout(this.timer);
    complain(this.search, "");
    this.timer = setTimeout(() => this.look(this.search.value.trim()), TYPING_MS);
  }

  /** @param {string} text @param {string} [preselected] */
  async look(text, preselected) {
    this.asked = text;
    try {
      const { items, total, names, trouble } = await findPatients(text, { mayName: this.mayName });
      if (this.asked !== text) return;
      if (preselected) this.chosen = items.find(({ code }) => code === preselected) ?? this.chosen;
      else if (!items.some(({ code }) => code === this.chosen?.code)) this.chosen = null;
      fill(this.found, ...items.map((patient) => this.row(patient, names.get(patient.code)?.name ?? "")));
      say(this.told, [trouble, counted(items.length, total, text)].filter(Boolean).join(" "));
    } catch (problem) {
      say(this.told, problem.message);
    }
  }

  /** @param {import("../patient_search.js").Entry} patient @param {string} name */
  row(patient, name) {
    const { code, year_of_birth, population, paretic_side } = patient;
    const choose = () => {
      this.chosen = patient;
      complain(this.search, "");
    };
    const input = el("input", {
      type: "radio",
      name: "patient",
      value: code,
      checked: code === this.chosen?.code,
      onchange: choose,
    });
    const facts = [
      year_of_birth && `born ${year_of_birth}`,
      population && GROUPS[population],
      paretic_side && `paretic side: ${PARETIC[paretic_side].toLowerCase()}`,
    ];
    return el(
      "label",
      {},
      input,
      el("span", { class: "code" }, code),
      el("b", {}, name),
      el("span", { class: "quiet" }, facts.filter(Boolean).join(", ")),
    );
  }

  enter() {}

  /** Whether one may go on; registers who is new. */
  async finish() {
    if (this.way === LATER) {
      this.chosen = null;
      return true;
    }
    if (this.way === KNOWN) {
      complain(this.search, this.chosen ? "" : "Choose a patient from the list, or “Assign later”.");
      if (!this.chosen) this.search.focus();
      return this.chosen !== null;
    }
    if (!isInOrder(this.fresh)) return false;
    await this.register();
    return true;
  }

  /** The code first; the name goes to the directory, under that code. */
  async register() {
    const patient = await post("/patients", { body: this.fields.facts });
    this.chosen = patient;
    this.way = KNOWN;
    for (const each of this.ways) each.querySelector("input").checked = each.querySelector("input").value === KNOWN;
    this.show();
    if (this.fields.identity) await keepName(patient.code, this.fields.identity);
    this.search.value = patient.code;
    await this.look(patient.code, patient.code);
  }

  /** What was chosen, in a few words. */
  get summary() {
    return this.chosen ? this.chosen.code : "later";
  }

  /** Part of the wish for a session. */
  get wish() {
    return { patient: this.chosen?.code ?? null };
  }

  dispose() {
    clearTimeout(this.timer);
  }
}

/** @param {number} here @param {number} total @param {string} text */
function counted(here, total, text) {
  if (total === 0) return text ? "Nobody is found. Check the spelling, or register a new patient." : "Nobody is registered yet.";
  return here < total ? `The newest ${here} of ${total}; type a code to find others.` : "";
}
