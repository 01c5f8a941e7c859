// @ts-check
// Every stride that was found, also those that do not count, each with the way to its moment in the replay.
import { get, linkTo } from "../api.js";
import { el, fill, table } from "../dom.js";
import { addressOf } from "../pages.js";
import { degrees, number } from "../units.js";

const A_PAGE = 100;
/** The archive closes the files of a session that has just ended. */
const AGAIN_MS = 2000;
const COLUMNS = ["Stride", "Side", "Begins#", "Time, s#", "Step length, m#", "Stride length, m#", "Speed, m/s#", "Stance, %#", "Turn, °#", "Counts"];

/** @typedef {import("../api_types").Models["StrideOut"]} Stride */

export class StridesView {
  span = el("span", { class: "quiet", role: "status" });
  before = el("button", { type: "button", onclick: () => this.turn(-A_PAGE) }, "‹ Earlier");
  after = el("button", { type: "button", onclick: () => this.turn(A_PAGE) }, "Later ›");

  /** @param {HTMLElement} host @param {{id: string}} session @param {URLSearchParams} query `row`: one to be shown, from 0 */
  constructor(host, session, query) {
    this.id = session.id;
    const row = query.get("row");
    this.row = row === null ? null : Math.max(0, Number(row) || 0);
    this.offset = Math.floor((this.row ?? 0) / A_PAGE) * A_PAGE;
    this.place = el("div", {}, el("p", { class: "quiet", role: "status" }, "Reading the strides …"));
    this.node = el("section", { class: "panel strides-panel", "aria-label": "Strides" }, this.head(), this.place);
    fill(host, this.node);
    this.load();
  }

  head() {
    const href = linkTo("/sessions/{session}/exports/{name}", { session: this.id, name: "strides.csv" });
    return el(
      "div",
      { class: "panel-head" },
      el("h2", {}, "Strides"),
      this.span,
      el("span", { class: "spring" }),
      this.before,
      this.after,
      el("a", { class: "button", download: true, href }, "All (CSV)"),
    );
  }

  /** @param {number} by */
  turn(by) {
    this.offset = Math.max(0, this.offset + by);
    this.row = null;
    history.replaceState(null, "", `${addressOf("session", { session: this.id, part: "strides" })}?row=${this.offset}`);
    this.load();
  }

  async load() {
    try {
      const page = await get("/sessions/{session}/strides", { session: this.id, offset: this.offset, limit: A_PAGE });
      if (!this.disposed) this.show(page);
    } catch (problem) {
      if (this.disposed) return;
      const { message, status } = /** @type {import("../api.js").ApiProblem} */ (problem);
      fill(this.place, el("p", { role: "status" }, message));
      if (status === 409 || status === 0) this.timer = setTimeout(() => this.load(), AGAIN_MS);
    }
  }

  /** @param {import("../api_types").Models["StridePage"]} page */
  show({ total, items }) {
    const last = this.offset + items.length;
    this.span.textContent = total === 0 ? "none was found" : `${this.offset + 1} to ${last} of ${total}`;
    this.before.disabled = this.offset === 0;
    this.after.disabled = last >= total;
    if (items.length === 0) return fill(this.place);
    const rows = items.map((stride, index) => this.rowOf(stride, this.offset + index === this.row));
    fill(this.place, table(COLUMNS, el("tbody", {}, ...rows)), el("p", { class: "quiet" }, "± is half the 95 % interval of one step."));
    this.place.querySelector("tr[aria-current]")?.scrollIntoView({ block: "center" });
  }

  /** @param {Stride} stride @param {boolean} isShown */
  rowOf(stride, isShown) {
    const side = stride.side === "left" ? "Left" : "Right";
    const cell = (/** @type {string} */ text) => el("td", { class: "number" }, text);
    return el(
      "tr",
      { class: stride.valid ? "" : "refused", "aria-current": isShown ? "true" : null },
      el("th", { scope: "row" }, el("a", { href: this.momentOf(stride) }, `${side[0]} ${stride.index + 1}`)),
      el("td", { class: stride.side }, side),
      cell(`${number(stride.start_s, 2)} s`),
      cell(number(stride.stride_time_s, 2)),
      cell(withInterval(stride.step_length_m, stride.step_length_std_m)),
      cell(number(stride.stride_length_m, 2)),
      cell(number(stride.walking_speed, 2)),
      cell(number(stride.stance_fraction === null ? null : 100 * stride.stance_fraction, 0)),
      cell(number(degrees(stride.turn), 0)),
      el("td", {}, stride.valid ? "yes" : (stride.rejected_because ?? "no"), stride.turning && stride.valid ? ", turning" : ""),
    );
  }

  /** @param {Stride} stride */
  momentOf({ start_s }) {
    return `${addressOf("session", { session: this.id, part: "replay" })}?t=${start_s.toFixed(2)}`;
  }

  dispose() {
    this.disposed = true;
    clearTimeout(this.timer);
  }
}

/** @param {number | null} value_m @param {number | null} std_m */
const withInterval = (value_m, std_m) =>
  value_m !== null && std_m !== null ? `${number(value_m, 2)} ± ${number(1.96 * std_m, 2)}` : number(value_m, 2);
