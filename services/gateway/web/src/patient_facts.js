// What is known of a patient: it decides which thresholds and references fit. No name, no free text.
import { patch } from "./api.js";
import { field } from "./conditions_form.js";
import { GROUPS, PARETIC, SEXES } from "./condition_words.js";
import { el, say } from "./dom.js";
import { when } from "./units.js";

const NOT_SAID = "";

export class PatientFacts {
  /** @param {object} patient as the API gives it @param {{onChange: () => void}} listener told after each change */
  constructor(patient, { onChange }) {
    this.code = patient.code;
    this.onChange = onChange;
    this.told = el("p", { class: "quiet", role: "status" }, `Registered ${when(patient.created)}`);
    this.inputs = {
      year_of_birth: el("input", { id: "year-of-birth", type: "number", min: 1900, max: 2100, value: patient.year_of_birth }),
      sex: choice("sex", SEXES, patient.sex),
      population: choice("population", GROUPS, patient.population),
      paretic_side: choice("paretic-side", PARETIC, patient.paretic_side),
    };
    const names = {
      year_of_birth: "Year of birth",
      sex: "Sex",
      population: "Group (decides which thresholds fit)",
      paretic_side: "Paretic (more affected) side",
    };
    for (const [name, input] of Object.entries(this.inputs)) input.addEventListener("change", () => this.change(name));
    this.node = el(
      "section",
      { class: "panel", "aria-label": "What is known" },
      el("h2", {}, "What is known"),
      el("div", { class: "fields" }, ...Object.entries(this.inputs).map(([name, input]) => field(names[name], input))),
      this.told,
    );
  }

  async change(name) {
    const { value } = this.inputs[name];
    const told = value === NOT_SAID ? null : name === "year_of_birth" ? Number(value) : value;
    try {
      await patch("/patients/{code}", { code: this.code, body: { [name]: told } });
      say(this.told, "Kept.");
      this.onChange();
    } catch (problem) {
      say(this.told, problem.message);
    }
  }
}

function choice(id, options, chosen) {
  const all = Object.entries(options).map(([value, name]) => el("option", { value, selected: value === chosen }, name));
  return el("select", { id }, el("option", { value: NOT_SAID }, "not said"), ...all);
}
