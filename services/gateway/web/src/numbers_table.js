// Every number of a session: with its 95 % interval, what it rests on, and how far it may be relied on.
import { el, table } from "./dom.js";
import { GRADES, doubtWords } from "./trust_words.js";
import { number, shown } from "./units.js";
import { metricName } from "./words.js";

const LETTERS = { left: "L", right: "R" };

const isCount = ({ name }) => /^(strides|repetitions)_/.test(name);

/** A metric that rests on something, even if too little to be told. A count of nothing is not one. */
export const isSeen = (metric) => metric.strides > 0 || (metric.value !== null && !isCount(metric));

/** What the 95 % interval, or else the standard deviation, says of a number, in its unit on the screen. */
export function spreadWords({ low, high, spread }, { factor, digits }) {
  if (low !== null && high !== null) return `${number(low * factor, digits)} to ${number(high * factor, digits)}`;
  return spread === null ? "" : `SD ${number(spread * factor, digits)}`;
}

/** Null where nothing was seen. */
export function numbersTable(metrics) {
  const seen = metrics.filter(isSeen);
  if (seen.length === 0) return null;
  return table(
    ["Number", "Side", "Value#", "95 % interval#", "Rests on#", "Trust", "Because of"],
    el("tbody", {}, ...seen.map(row)),
  );
}

function row(metric) {
  const scale = shown(metric.unit, metric.name);
  const grade = GRADES[metric.grade];
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, metricName(metric.name), scale.unit ? el("span", { class: "unit" }, ` ${scale.unit}`) : null),
    el("td", { class: metric.side }, LETTERS[metric.side] ?? ""),
    el("td", { class: "number" }, metric.value === null ? "–" : number(metric.value * scale.factor, scale.digits)),
    el("td", { class: "number quiet" }, metric.value === null ? "" : spreadWords(metric, scale)),
    el("td", { class: "number" }, String(metric.strides)),
    el("td", {}, el("span", { class: "chip small", "data-tone": grade.tone }, grade.word)),
    el("td", { class: "quiet" }, doubtWords(metric)),
  );
}
