// Every number of a session: with its 95 % interval, what it rests on, and how far it may be relied on.
import { el } from "./dom.js";
import { GRADES, doubtWords } from "./trust_words.js";
import { number, shown } from "./units.js";
import { metricName } from "./words.js";

const WHOLE = "whole";
const SIDES = { left: "Left", right: "Right", [WHOLE]: "Whole body" };

const sideOf = ({ side }) => side ?? WHOLE;

const isCount = ({ name }) => /^(strides|repetitions)_/.test(name);

/** A metric that rests on something, even if too little to be told. A count of nothing is not one. */
export const isSeen = (metric) => metric.strides > 0 || (metric.value !== null && !isCount(metric));

/** What the 95 % interval, or else the standard deviation, says of a number, in its unit on the screen. */
export function spreadWords({ low, high, spread }, { factor, digits }) {
  if (low !== null && high !== null) return `${number(low * factor, digits)} to ${number(high * factor, digits)}`;
  return spread === null ? "" : `SD ${number(spread * factor, digits)}`;
}

/** A row per number, a column per side that has any; null where nothing was seen. */
export function numbersTable(metrics) {
  const seen = metrics.filter(isSeen);
  if (seen.length === 0) return null;
  const sides = Object.keys(SIDES).filter((side) => seen.some((metric) => sideOf(metric) === side));
  const names = [...new Set(seen.map(({ name }) => name))];
  const head = sides.map((side) => el("th", { scope: "col", class: `number ${side}` }, SIDES[side]));
  return el(
    "div",
    { class: "scroll" },
    el(
      "table",
      { class: "every-number" },
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Number"), ...head)),
      el("tbody", {}, ...names.map((name) => row(name, sides, seen))),
    ),
  );
}

function row(name, sides, seen) {
  const own = seen.filter((metric) => metric.name === name);
  const { unit } = shown(own[0].unit, name);
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, metricName(name), unit ? el("span", { class: "unit" }, ` ${unit}`) : null),
    ...sides.map((side) => cell(own.find((metric) => sideOf(metric) === side))),
  );
}

function cell(metric) {
  if (!metric) return el("td", {});
  const scale = shown(metric.unit, metric.name);
  const { word, tone } = GRADES[metric.grade];
  const known = metric.value !== null;
  const reasons = doubtWords(metric);
  return el(
    "td",
    { class: "number", "data-tone": tone },
    el("b", {}, known ? number(metric.value * scale.factor, scale.digits) : "–"),
    known ? el("span", { class: "quiet" }, ` ${spreadWords(metric, scale)}`) : null,
    el("small", { class: "quiet" }, [`${word}, of ${metric.strides}`, reasons].filter(Boolean).join(": ")),
  );
}
