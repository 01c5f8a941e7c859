// @ts-check
// The record as a whole: take it away, put it into the bin, join it with another, erase it for good.
import { linkTo, post, remove } from "./api.js";
import { confirmPassword } from "./confirm_password.js";
import { el } from "./dom.js";
import { askForm } from "./form_dialog.js";
import { labelled, textInput } from "./form_fields.js";

const BIN = "The patient and all sessions go into the bin and can be brought back from there until the day that it names.";
const MERGE = "All sessions, treatments and shares go to the other code; this one is gone afterwards. This can not be undone.";
const ERASE =
  "Sessions, recordings, numbers, name and shares are erased on every disk that this site writes, and from backups when " +
  "they are restored. What stays is an entry in the audit. This can not be undone.";

/** @type {[string, string][]} */
const WHY_MERGE = [
  ["registered_twice", "Registered twice"],
  ["code_lost", "The first code was lost"],
];

/** @type {[string, string][]} */
const WHY_ERASE = [
  ["requested_by_patient", "The patient asked for it"],
  ["consent_withdrawn", "Consent was withdrawn"],
  ["registered_by_mistake", "Registered by mistake"],
  ["test_entry", "It was a test"],
];

export class RecordPanel {
  /** @param {string} code @param {{may: string[]}} me */
  constructor(code, { may }) {
    this.code = code;
    const administers = may.includes("administer");
    this.node = el(
      "section",
      { class: "panel", "aria-label": "The record" },
      el("h2", {}, "The record"),
      act("Everything that is known, as FHIR bundles and recordings in one archive.",
        el("a", { class: "button", href: linkTo("/patients/{code}/export", { code }), download: true }, "Take it away")),
      act("Registered by mistake, or not needed now.", button("Into the bin", () => this.bin())),
      administers ? act("The same person under two codes.", button("Join with another code", () => this.merge())) : null,
      administers ? act("The patient wants to be forgotten.", button("Erase for good", () => this.erase())) : null,
    );
  }

  async bin() {
    const done = await askForm({
      title: `Put ${this.code} into the bin`,
      about: BIN,
      fields: [],
      action: "Into the bin",
      danger: true,
      act: () => remove("/patients/{code}", { code: this.code }),
    });
    if (done) location.hash = "#/patients";
  }

  async merge() {
    const into = textInput({ required: true, maxlength: 16, pattern: "[0-9A-Za-z]+" });
    const target = () => into.value.trim().toUpperCase();
    const done = await confirmPassword({
      title: `Join ${this.code} with another code`,
      about: MERGE,
      action: "Join",
      reasons: WHY_MERGE,
      fields: [labelled("The code that stays", into)],
      act: (reason) => post("/patients/{code}/merge", { code: this.code, body: { into: target(), reason: /** @type {any} */ (reason) } }),
    });
    if (done) location.hash = `#/patients/${target()}`;
  }

  async erase() {
    const typed = textInput({ required: true, maxlength: 16 });
    const done = await confirmPassword({
      title: `Erase ${this.code} for good`,
      about: ERASE,
      action: "Erase for good",
      reasons: WHY_ERASE,
      fields: [labelled("Type the code once more", typed)],
      act: async (reason) => {
        if (typed.value.trim().toUpperCase() !== this.code) throw new Error(`The code is ${this.code}. Type it to be sure whom you erase.`);
        await post("/patients/{code}/erasure", { code: this.code, body: { reason: /** @type {any} */ (reason) } });
      },
    });
    if (done) location.hash = "#/patients";
  }
}

/** @param {string} words @param {HTMLElement} control */
const act = (words, control) => el("div", { class: "record-act" }, el("span", {}, words), control);

/** @param {string} word @param {() => unknown} onclick */
const button = (word, onclick) => el("button", { class: "danger", type: "button", onclick }, word);
