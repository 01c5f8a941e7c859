// @ts-check
// What is asked when somebody is registered. All of it may be left open; a name goes to the directory alone.
import { GROUPS, PARETIC, SEXES } from "./condition_words.js";
import { field } from "./conditions_form.js";
import { el } from "./dom.js";

const NOT_SAID = "";

export class PatientFields {
  /** @param {{mayName: boolean}} who whether whoever asks may write to the directory */
  constructor({ mayName }) {
    this.year = el("input", { id: "new-year-of-birth", type: "number", min: 1900, max: 2100, step: 1 });
    this.sex = choice("new-sex", SEXES);
    this.population = choice("new-population", GROUPS);
    this.paretic = choice("new-paretic-side", PARETIC);
    this.name = el("input", { id: "new-name", type: "text", maxlength: 120, autocomplete: "off" });
    this.record = el("input", { id: "new-record-number", type: "text", maxlength: 40, autocomplete: "off" });
    this.identityFields = el(
      "div",
      { class: "fields", hidden: !mayName },
      field("Name (kept in the clinic’s directory alone)", this.name),
      field("Record number", this.record),
    );
    this.node = el(
      "div",
      { class: "step-part" },
      el(
        "div",
        { class: "fields" },
        field("Year of birth", this.year),
        field("Sex", this.sex),
        field("Group (decides which thresholds fit)", this.population),
        field("Paretic (more affected) side", this.paretic),
      ),
      this.identityFields,
      el("p", { class: "quiet" }, "Leave open what nobody knows. A random code is drawn; write it on the chart."),
    );
  }

  /** What POST /patients takes. */
  get facts() {
    return {
      year_of_birth: this.year.value === NOT_SAID ? null : Number(this.year.value),
      sex: said(this.sex),
      population: said(this.population),
      paretic_side: said(this.paretic),
    };
  }

  /** What the directory takes; null when no name was given. */
  get identity() {
    const name = this.name.value.trim();
    return name === "" ? null : { name, record_number: this.record.value.trim() || null };
  }
}

/** @param {HTMLSelectElement} select @returns {any} */
const said = (select) => (select.value === NOT_SAID ? null : select.value);

/** @param {string} id @param {Record<string, string>} options */
function choice(id, options) {
  const all = Object.entries(options).map(([value, name]) => el("option", { value }, name));
  return el("select", { id }, el("option", { value: NOT_SAID }, "not said"), ...all);
}
