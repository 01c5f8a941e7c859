// @ts-check
// What changed between the software versions that computed a session: another algorithm, not another patient.
import { get } from "../api.js";
import { el, fill, table } from "../dom.js";
import { degrees, number, shown, when } from "../units.js";
import { jointName, metricName } from "../words.js";

/** @typedef {import("../api_types").Models} Models */

const KINDS = {
  changed: "another value",
  new: "new",
  gone: "not told any more",
  withheld: "withheld now",
  given: "given now",
  judged: "judged otherwise",
};
const SIDES = { left: "Left", right: "Right" };

export class VersionsView {
  /** @param {HTMLElement} host @param {{id: string}} session */
  constructor(host, session) {
    this.id = session.id;
    this.host = host;
    fill(host, el("p", { class: "panel quiet", role: "status" }, "Comparing …"));
    this.load();
  }

  async load() {
    try {
      const { versions } = await get("/sessions/{session}/versions", { session: this.id });
      if (!this.disposed) this.show(versions);
    } catch (problem) {
      if (!this.disposed) fill(this.host, el("p", { class: "panel", role: "status" }, /** @type {Error} */ (problem).message));
    }
  }

  /** @param {Models["VersionOut"][]} versions */
  show(versions) {
    if (versions.length === 0)
      return fill(this.host, el("p", { class: "panel", role: "status" }, "No result of this session is stored."));
    const advice = el(
      "p",
      { class: "quiet" },
      "Results are kept under the software that computed them. Another one is added with ",
      el("code", {}, `ambula reprocess ${this.id} --store`),
      ".",
    );
    const alone = versions.length === 1 ? el("p", {}, "One software version has computed this session so far.") : null;
    fill(this.host, el("div", { class: "column" }, ...versions.map((version) => versionPanel(version)), alone, advice));
  }

  dispose() {
    this.disposed = true;
  }
}

/** @param {Models["VersionOut"]} version */
function versionPanel(version) {
  const { software, current, stored, replaced, files, identical, metrics, curves } = version;
  const head = el(
    "div",
    { class: "panel-head" },
    el("h2", {}, software),
    current ? el("span", { class: "chip small", "data-tone": "good" }, "shown everywhere") : null,
    el("span", { class: "spring" }),
    el("span", { class: "quiet" }, `stored ${when(stored)}${replaced ? `, replaced ${when(replaced)}` : ""}`),
  );
  const made = el("p", { class: "quiet" }, files.length > 0 ? `Files: ${files.join(", ")}` : "Its files are not kept.");
  return el("section", { class: "panel", "aria-label": software }, head, made, ...differences(current, identical, metrics, curves));
}

/** @param {boolean} current @param {boolean} identical @param {Models["MetricChangeOut"][]} metrics @param {Models["CurveChangeOut"][]} curves */
function differences(current, identical, metrics, curves) {
  if (current) return [];
  if (identical) return [el("p", {}, "Every number and curve is the same as in the current result.")];
  const rows = metrics.map(changeRow);
  const columns = ["Number", "Side", "Then#", "Now#", "Change#", "In half intervals#", "What became of it"];
  return [
    rows.length > 0 ? table(columns, el("tbody", {}, ...rows)) : el("p", {}, "Every number is the same."),
    curves.length > 0 ? table(["Mean curve", "Side", "Largest distance#"], el("tbody", {}, ...curves.map(curveRow))) : null,
  ];
}

/** @param {Models["MetricChangeOut"]} change */
function changeRow({ name, side, unit, kind, before, after, change, change_in_intervals }) {
  const { factor, unit: shownUnit, digits } = shown(unit, name);
  const value = (/** @type {number | null | undefined} */ each) =>
    each === null || each === undefined ? "–" : `${number(each * factor, digits + 1)} ${shownUnit}`;
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, metricName(name)),
    el("td", {}, side === null ? "" : SIDES[side]),
    ...[value(before?.value), value(after?.value), value(change), number(change_in_intervals, 2)].map((text) =>
      el("td", { class: "number" }, text),
    ),
    el("td", { class: "quiet" }, KINDS[kind]),
  );
}

/** @param {Models["CurveChangeOut"]} curve */
function curveRow({ degree_of_freedom, largest }) {
  const [name, side] = jointName(degree_of_freedom);
  const far = largest === null ? "there is only one" : `${number(degrees(largest), 2)}°`;
  return el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, side ?? ""), el("td", { class: "number" }, far));
}
