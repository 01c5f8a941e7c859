// @ts-check
// The clinics of the site: their names, and how long they keep recordings.
import { get, patch, post } from "../api.js";
import { confirmPassword } from "../confirm_password.js";
import { el } from "../dom.js";
import { askForm } from "../form_dialog.js";
import { labelled, textInput } from "../form_fields.js";
import { PagedList, moment, row, rowActions, rowButton, rowHead } from "../paged_list.js";
import { when } from "../units.js";
import { frame, newButton } from "./frame.js";

/** @typedef {import("../api_types").Models["ClinicOut"]} Clinic */

const ABOUT = "What one clinic records, no other can see, unless a patient is shared with somebody by name.";
const KEEP = "Days; empty: for good. Older recordings are removed by the next housekeeping.";

/** @param {import("../pages.js").Place} place */
export const open = (place) => new ClinicsView(place);

class ClinicsView {
  /** @param {import("../pages.js").Place} place */
  constructor(place) {
    this.list = new PagedList({
      columns: ["Clinic", "Id", "Recordings are kept", "Open accounts#", "Since", "Actions"],
      empty: "",
      read: (part) => get("/clinics", part),
      row: (/** @type {Clinic} */ clinic) => this.row(clinic),
    });
    const add = place.app.me.site_admin ? newButton("New clinic", () => this.then(createClinic())) : null;
    frame(place, "clinics", ABOUT, [add], this.list.node);
    this.list.refresh();
  }

  /** @param {Clinic} clinic */
  row(clinic) {
    return row(
      rowHead(clinic.name),
      el("span", { class: "code" }, clinic.id),
      clinic.keep_days === null ? "for good" : `${clinic.keep_days} days`,
      el("td", { class: "number" }, clinic.accounts),
      moment(when(clinic.created)),
      rowActions(rowButton("Change", clinic.name, () => this.then(changeClinic(clinic)))),
    );
  }

  /** @param {Promise<unknown>} done */
  async then(done) {
    await done;
    this.list.refresh();
  }

  dispose() {}
}

/** @param {number | null} days */
const keepInput = (days) => el("input", { type: "number", min: 1, max: 36500, step: 1, value: days });

/** @param {HTMLInputElement} input */
const daysOf = (input) => (input.value === "" ? null : Number(input.value));

function createClinic() {
  const id = textInput({ required: true, maxlength: 32, pattern: "[a-z0-9][a-z0-9\\-]*" });
  const name = textInput({ required: true, maxlength: 100 });
  const keep = keepInput(null);
  return askForm({
    title: "New clinic",
    fields: [
      labelled("Name", name),
      labelled("Id", id, "Small letters, digits, hyphens. It stays as it is."),
      labelled("Keep recordings", keep, KEEP),
    ],
    action: "Create",
    act: () => post("/clinics", { body: { id: id.value, name: name.value, keep_days: daysOf(keep) } }),
  });
}

/** Keeping recordings for a shorter time removes some, so that asks for the password. @param {Clinic} clinic */
async function changeClinic(clinic) {
  const name = textInput({ required: true, maxlength: 100, value: clinic.name });
  const keep = keepInput(clinic.keep_days);
  const change = () =>
    patch("/clinics/{clinic}", { clinic: clinic.id, body: { name: name.value, keep_days: daysOf(keep) } });
  let shorter = false;
  const done = await askForm({
    title: `Change ${clinic.name}`,
    fields: [labelled("Name", name), labelled("Keep recordings", keep, KEEP)],
    action: "Change",
    act: async () => {
      const days = daysOf(keep);
      shorter = days !== null && days < (clinic.keep_days ?? Infinity);
      if (!shorter) await change();
    },
  });
  if (!done || !shorter) return;
  await confirmPassword({
    title: `Keep recordings for ${keep.value} days only`,
    about: `Recordings of ${clinic.name} that are older are removed for good by the next housekeeping.`,
    action: "Keep them for that long",
    act: change,
  });
}
