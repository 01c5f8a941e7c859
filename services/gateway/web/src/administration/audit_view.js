// @ts-check
// Who did what with which patient, and whether the record of it is as it was written.
import { get, linkTo } from "../api.js";
import { el, fill, say } from "../dom.js";
import { choice, labelled, textInput } from "../form_fields.js";
import { PagedList, chip, row, rowHead } from "../paged_list.js";
import { ROLES } from "../role_words.js";
import { actionWord, outcomeOf, precisely, verdictOn } from "./audit_words.js";
import { frame } from "./frame.js";

/** @typedef {import("../api_types").Models["AuditEntryOut"]} Entry */

const ABOUT = "Every request about a patient and every change, newest first. Entries can neither be changed nor removed.";
const MOST_ACTORS = 100;

/** @param {import("../pages.js").Place} place */
export const open = (place) => new AuditView(place);

class AuditView {
  /** @type {Map<string, string>} */
  actors = new Map();

  /** @param {import("../pages.js").Place} place */
  constructor(place) {
    this.from = el("input", { type: "date" });
    this.to = el("input", { type: "date" });
    this.actor = choice([["", "Everybody"]]);
    this.patient = textInput({ maxlength: 16 });
    this.action = textInput({ maxlength: 64, list: "audit-actions" });
    this.seen = el("datalist", { id: "audit-actions" });
    this.verdict = el("p", { class: "banner", role: "status", hidden: true });
    this.verify = el("button", { type: "button", onclick: () => this.check() }, "Verify the chain");
    this.lines = el("a", { class: "button", download: true }, "Export as lines of JSON");
    this.bundle = el("a", { class: "button", download: true }, "Export as FHIR");
    this.list = new PagedList({
      columns: ["When", "Who", "What", "Patient", "Session or object", "Outcome", "Reason"],
      empty: [el("h2", {}, "No entries"), el("p", {}, "Nothing matches. Take a filter away, or choose other days.")],
      read: (part) => get("/audit", { ...part, ...this.wanted }),
      row: (/** @type {Entry} */ entry) => this.row(entry),
    });
    frame(place, "audit", ABOUT, [this.verify, this.lines, this.bundle], this.verdict, this.filters(), this.list.node);
    this.start();
  }

  filters() {
    const clear = el("button", { type: "reset" }, "Clear");
    const form = el(
      "form",
      { class: "filters", role: "search", onsubmit: (event) => this.ask(event), onchange: () => this.ask() },
      labelled("From", this.from),
      labelled("To", this.to),
      labelled("Who", this.actor),
      labelled("Patient code", this.patient),
      labelled("What", this.action),
      this.seen,
      el("button", { type: "submit" }, "Show"),
      clear,
    );
    form.addEventListener("reset", () => setTimeout(() => this.ask()));
    return form;
  }

  get days() {
    return { from: this.from.value || null, to: this.to.value || null };
  }

  get wanted() {
    const patient = this.patient.value.trim().toUpperCase() || null;
    const action = this.action.value.trim().toLowerCase().replaceAll(" ", "_") || null;
    return { ...this.days, actor: this.actor.value || null, patient, action };
  }

  /** Ids of accounts and keys are shown by the names that they have now. */
  async start() {
    const [accounts, keys] = await Promise.all([
      get("/accounts", { limit: MOST_ACTORS }).catch(() => ({ items: [] })),
      get("/keys", { limit: MOST_ACTORS }).catch(() => ({ items: [] })),
    ]);
    for (const { id, login } of accounts.items) this.actors.set(id, login);
    for (const { id, name } of keys.items) this.actors.set(id, `${name} (key)`);
    this.actor.append(...[...this.actors].map(([id, name]) => el("option", { value: id }, name)));
    this.ask();
  }

  /** @param {Event} [event] */
  ask(event) {
    event?.preventDefault();
    this.lines.href = linkTo("/audit/export", { ...this.days, format: "ndjson" });
    this.bundle.href = linkTo("/audit/export", { ...this.days, format: "fhir" });
    return this.list.restart();
  }

  /** @param {Entry} entry */
  row(entry) {
    this.offerAction(entry.action);
    const { word, tone } = outcomeOf(entry.outcome);
    const role = entry.role ? el("span", { class: "quiet" }, ` ${ROLES[/** @type {keyof ROLES} */ (entry.role)] ?? entry.role}`) : null;
    const code = entry.patient ? el("a", { class: "code", href: `#/patients/${entry.patient}` }, entry.patient) : "";
    return row(
      rowHead(precisely(entry.at)),
      [this.actors.get(entry.actor ?? "") ?? entry.actor ?? entry.actor_kind, role],
      actionWord(entry.action),
      code,
      entry.session ? el("a", { class: "code", href: `#/sessions/${entry.session}` }, entry.session) : (entry.object ?? ""),
      chip(word, tone),
      entry.reason ?? "",
    );
  }

  /** @param {string} action */
  offerAction(action) {
    const offered = [...this.seen.options].some((option) => option.value === actionWord(action));
    if (!offered) this.seen.append(el("option", { value: actionWord(action) }));
  }

  async check() {
    this.verify.disabled = true;
    this.verdict.hidden = false;
    say(this.verdict, "Walking the whole chain …");
    try {
      const { text, tone } = verdictOn(await get("/audit/verification"));
      this.verdict.dataset.tone = tone;
      say(this.verdict, text);
    } catch (problem) {
      fill(this.verdict, /** @type {Error} */ (problem).message);
    } finally {
      this.verify.disabled = false;
    }
  }

  dispose() {}
}
