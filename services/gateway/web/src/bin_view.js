// @ts-check
// What was deleted and can still be brought back.
import { get, post } from "./api.js";
import { el, fill, say, tell } from "./dom.js";
import { PagedList, moment, row, rowActions, rowButton, rowHead } from "./paged_list.js";
import { when } from "./units.js";
import { TASKS } from "./words.js";

/** @typedef {import("./api_types").Models["BinOut"]} Bin @typedef {Bin["patients"][number]} Patient */
/** @typedef {Bin["sessions"][number]} Session */

/** @param {import("./pages.js").Place} place */
export const open = (place) => new BinView(place);

class BinView {
  /** @type {Bin} */
  bin = { keep_days: 0, patients: [], sessions: [] };

  /** @param {import("./pages.js").Place} place */
  constructor({ host }) {
    this.about = el("p", { class: "quiet" });
    this.told = el("p", { class: "banner", "data-tone": "good", role: "status", hidden: true });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.patients = new PagedList({
      columns: ["Patient", "Sessions#", "Deleted", "Erased for good", "Actions"],
      empty: [el("h2", {}, "No patients in the bin"), el("p", {}, "A patient is deleted on the patient's own page.")],
      read: async (part) => partOf(this.bin.patients, part),
      row: (/** @type {Patient} */ patient) => this.patientRow(patient),
    });
    this.sessions = new PagedList({
      columns: ["Session", "Patient", "Recorded", "Deleted", "Erased for good", "Actions"],
      empty: [el("h2", {}, "No sessions in the bin"), el("p", {}, "A session is deleted on the session's own page.")],
      read: async (part) => partOf(this.bin.sessions, part),
      row: (/** @type {Session} */ session) => this.sessionRow(session),
    });
    const section = (/** @type {string} */ title, /** @type {Node[]} */ ...parts) =>
      el("section", { class: "panel listed", "aria-label": title }, ...parts);
    fill(
      host,
      section("Recycle bin", el("h1", {}, "Recycle bin"), this.about, this.told, this.problem),
      section("Patients", el("h2", {}, "Patients"), this.patients.node),
      section("Sessions", el("h2", {}, "Single sessions"), this.sessions.node),
    );
    this.load();
  }

  async load() {
    try {
      this.bin = await get("/bin");
      say(this.about, `What is deleted stays here for ${this.bin.keep_days} days, then it is erased for good, recordings included.`);
      tell(this.problem, "");
    } catch (problem) {
      tell(this.problem, /** @type {Error} */ (problem).message);
    }
    await Promise.all([this.patients.refresh(), this.sessions.refresh()]);
  }

  /** @param {Patient} patient */
  patientRow({ code, sessions, deleted, erased_on }) {
    return row(
      rowHead(el("span", { class: "code" }, code)),
      el("td", { class: "number" }, sessions),
      moment(when(deleted)),
      remaining(erased_on),
      rowActions(rowButton("Bring back", code, () => this.restore(() => post("/bin/patients/{code}/restoration", { code })))),
    );
  }

  /** @param {Session} session */
  sessionRow({ id, patient, task, created, deleted, erased_on }) {
    return row(
      rowHead(task ? TASKS[task] : "Session"),
      patient ? el("span", { class: "code" }, patient) : el("span", { class: "quiet" }, "unassigned"),
      moment(when(created)),
      moment(when(deleted)),
      remaining(erased_on),
      rowActions(
        rowButton("Bring back", when(created), () =>
          this.restore(() => post("/bin/sessions/{session}/restoration", { session: id })),
        ),
      ),
    );
  }

  /** @param {() => Promise<import("./api_types").Models["RestoredOut"]>} ask */
  async restore(ask) {
    try {
      const { patient, sessions } = await ask();
      const whose = patient ? `Patient ${patient}` : "A session without a patient";
      tell(this.told, `${whose} is back, sessions: ${sessions}.`);
      tell(this.problem, "");
    } catch (problem) {
      tell(this.told, "");
      tell(this.problem, /** @type {Error} */ (problem).message);
    }
    await this.load();
  }

  dispose() {}
}

/** @template T @param {T[]} all @param {{ offset: number, limit: number }} part */
const partOf = (all, { offset, limit }) => ({ total: all.length, items: all.slice(offset, offset + limit) });

const DAY_MS = 24 * 3600 * 1000;

/** @param {string} day UTC, YYYY-MM-DD */
function remaining(day) {
  const days = Math.max(0, Math.ceil((Date.parse(day) - Date.now()) / DAY_MS));
  const date = new Date(day).toLocaleDateString(undefined, { dateStyle: "medium", timeZone: "UTC" });
  return moment(`${date} (${days === 0 ? "today" : days === 1 ? "in a day" : `in ${days} days`})`);
}
