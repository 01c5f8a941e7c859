// How far angles went within a repetition, both sides beside each other.
import { el, fill } from "./dom.js";
import { degrees, number } from "./units.js";
import { SIDES } from "./vectors.js";
import { angleTitle, jointName } from "./words.js";

/** Mean and standard deviation of the ranges of valid repetitions, rad, by angle. */
export function meanRanges(repetitions) {
  const values = new Map();
  for (const { ranges } of repetitions.filter((each) => each.valid))
    for (const [name, range] of Object.entries(ranges)) values.set(name, [...(values.get(name) ?? []), range]);
  return new Map([...values].map(([name, all]) => [name, { ...spreadOf(all), count: all.length }]));
}

function spreadOf(values) {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  const squares = values.reduce((sum, value) => sum + (value - mean) ** 2, 0);
  return { mean, spread: values.length > 1 ? Math.sqrt(squares / (values.length - 1)) : null };
}

/** A row per angle, without the joints in `known`; null where no repetition tells of any. */
export function rangesTable(repetitions, known = []) {
  const means = meanRanges(repetitions);
  const all = new Set([...means.keys()].map((name) => (sideOf(name) ? jointOf(name) : name)));
  const joints = [...all].filter((joint) => !known.includes(joint));
  if (joints.length === 0) return null;
  const head = el("tr", {}, el("th", { scope: "col" }, ""));
  head.append(...SIDES.map((side) => el("th", { scope: "col", class: `number ${side}` }, side === "left" ? "Left" : "Right")));
  const rows = joints.toSorted(byRange(means)).map((joint) => row(joint, means));
  const body = el("tbody");
  fill(body, ...rows);
  return el("table", { class: "ranges" }, el("thead", {}, head), body);
}

const sideOf = (name) => (name.startsWith("trunk_") ? null : jointName(name)[1]);
const jointOf = (name) => name.slice(0, -sideOf(name).length - 1);
const namesOf = (joint) => [joint, ...SIDES.map((side) => `${joint}_${side}`)];
const largest = (joint, means) => Math.max(...namesOf(joint).map((name) => means.get(name)?.mean ?? 0));
const byRange = (means) => (a, b) => largest(b, means) - largest(a, means);

function row(joint, means) {
  const cells = means.has(joint)
    ? [cell(means.get(joint), { colspan: 2 })]
    : SIDES.map((side) => cell(means.get(`${joint}_${side}`)));
  return el("tr", {}, el("th", { scope: "row" }, angleTitle(joint)), ...cells);
}

function cell(told, attributes = {}) {
  if (!told) return el("td", { class: "number quiet", title: "not observable in these repetitions" }, "–");
  const spread = told.spread === null ? "" : ` ± ${number(degrees(told.spread), 0)}°`;
  return el(
    "td",
    { class: "number", title: `${told.count} repetitions`, ...attributes },
    `${number(degrees(told.mean), 0)}°`,
    el("span", { class: "quiet" }, spread),
  );
}
