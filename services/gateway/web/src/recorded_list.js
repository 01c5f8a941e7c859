// What has been recorded, newest first.
import { get } from "./api.js";
import { el, fill, say, table } from "./dom.js";
import { clock, number, when } from "./units.js";
import { STORED_WORDS } from "./words.js";

const PAGE = 20;
const COLUMNS = ["Session", "Patient", "Started", "Length#", "Strides#", "Speed#", "Cadence#", "State"];
const EVERY_MS = 5000;

export class RecordedList {
  constructor() {
    this.offset = 0;
    this.rows = el("tbody");
    this.total = el("span", { class: "quiet" });
    this.filter = el(
      "select",
      { "aria-label": "Show sessions in state", onchange: () => this.turn(0) },
      el("option", { value: "" }, "All"),
      ...Object.entries(STORED_WORDS).map(([state, { word }]) => el("option", { value: state }, word)),
    );
    this.newer = el("button", { type: "button", onclick: () => this.turn(this.offset - PAGE) }, "Newer");
    this.older = el("button", { type: "button", onclick: () => this.turn(this.offset + PAGE) }, "Older");
    const head = [el("h2", {}, "Sessions"), this.total, el("span", { class: "spring" }), this.filter, this.newer, this.older];
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Recorded sessions" },
      el("div", { class: "panel-head" }, ...head),
      table(COLUMNS, this.rows),
    );
    this.refresh();
    this.timer = setInterval(() => this.refresh(), EVERY_MS);
  }

  /** @param {number} offset */
  turn(offset) {
    this.offset = Math.max(0, offset);
    this.refresh();
  }

  async refresh() {
    const state = /** @type {any} */ (this.filter.value || null);
    const page = await get("/sessions", { limit: PAGE, offset: this.offset, state }).catch(() => null);
    if (!page) return;
    const seen = JSON.stringify(page);
    if (seen === this.seen) return;
    this.seen = seen;
    say(this.total, `${page.total} in all`);
    this.newer.disabled = this.offset === 0;
    this.older.disabled = this.offset + PAGE >= page.total;
    const none = el("tr", {}, el("td", { colspan: 8, class: "quiet" }, "No sessions yet."));
    fill(this.rows, page.items.length > 0 ? page.items.map(row) : none);
  }

  dispose() {
    clearInterval(this.timer);
  }
}

/** @param {number|null|undefined} value @param {number} digits @param {string} unit */
const withUnit = (value, digits, unit) => (value ? `${number(value, digits)} ${unit}` : "–");

/** @param {any} session */
function row(session) {
  const { word, tone } = STORED_WORDS[/** @type {keyof typeof STORED_WORDS} */ (session.state)];
  const best = session.highlights;
  const code = session.patient
    ? el("span", { class: "code" }, session.patient)
    : el("span", { class: "quiet" }, "unassigned");
  return el(
    "tr",
    {},
    el("td", {}, el("a", { href: `#/sessions/${session.id}` }, session.title)),
    el("td", {}, code),
    el("td", {}, when(session.started ?? session.created)),
    el("td", { class: "number" }, session.ended ? clock(session.duration_s) : "–"),
    el("td", { class: "number" }, best?.strides ? String(best.strides) : "–"),
    el("td", { class: "number" }, withUnit(best?.walking_speed, 2, "m/s")),
    el("td", { class: "number" }, withUnit(best?.cadence_per_min, 0, "/min")),
    el("td", {}, el("span", { class: "chip small", "data-tone": tone }, word)),
  );
}
