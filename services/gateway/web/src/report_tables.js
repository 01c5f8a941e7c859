// Metrics as tables and tiles. What has not been seen at all is absent; what was withheld says why.
import { el, svg } from "./dom.js";
import { SIDE_COLOUR, SIDE_DASH } from "./palette.js";
import { number, shown } from "./units.js";
import { metricName } from "./words.js";

const SIDES = ["left", "right"];

const isCount = ({ name }) => /^(strides|repetitions)_/.test(name);

/** A metric that rests on something, even if too little to be told. A count of nothing is not one. */
export const isSeen = (metric) => metric.strides > 0 || (metric.value !== null && !isCount(metric));

/** A row per metric, a column per side that has been seen, and one for what has none; null when nothing was seen. */
export function sideTable(metrics) {
  const sides = [...SIDES, null].filter((side) => metrics.some((metric) => metric.side === side && isSeen(metric)));
  if (sides.length === 0) return null;
  const find = (name, side) => metrics.find((metric) => metric.name === name && metric.side === side);
  const names = new Set(metrics.filter((metric) => isSeen(metric) || isCount(metric)).map((metric) => metric.name));
  const rows = [...names].map((name) => {
    const cells = sides.map((side) => find(name, side));
    const { unit } = shown(cells.find(Boolean).unit, name);
    return el(
      "tr",
      {},
      el("th", { scope: "row" }, metricName(name), unit ? el("span", { class: "unit" }, ` ${unit}`) : null),
      ...cells.map((metric) => cell(metric)),
    );
  });
  const head = [
    el("th", { scope: "col" }, ""),
    ...sides.map((side) => el("th", { scope: "col", class: `number ${side ?? ""}` }, columnName(side, sides))),
  ];
  return el("table", {}, el("thead", {}, el("tr", {}, ...head)), el("tbody", {}, ...rows));
}

function columnName(side, sides) {
  if (side !== null) return side === "left" ? "Left" : "Right";
  return sides.length > 1 ? "Whole body" : "";
}

/** Metrics of the whole body under a heading; null when none has been seen. */
export function ratioTable(title, meaning, metrics = []) {
  if (!metrics.some(isSeen)) return null;
  const seen = metrics.filter(isSeen);
  const rows = seen.map((metric) => el("tr", {}, el("th", { scope: "row" }, metricName(metric.name)), cell(metric, true)));
  return el(
    "div",
    {},
    el("h3", {}, title),
    el("p", { class: "quiet" }, meaning),
    el("table", {}, el("tbody", {}, ...rows)),
  );
}

/** One number, large. `named` says the side too. */
export function metricTile(metric, named = false) {
  const { factor, unit, digits } = shown(metric.unit, metric.name);
  const withheld = metric.value === null;
  const spread = metric.spread === null || withheld ? "" : `± ${number(metric.spread * factor, digits)}`;
  return el(
    "div",
    { class: "tile" },
    el("span", { class: "name" }, metricName(metric.name) + (named && metric.side ? `, ${metric.side}` : "")),
    el(
      "span",
      {},
      el("span", { class: "value" }, withheld ? "–" : number(metric.value * factor, digits)),
      el("span", { class: "unit" }, ` ${unit}`),
    ),
    el(
      "span",
      { class: "quiet" },
      withheld ? (metric.withheld_because ?? "") : `${spread}  (${metric.strides} ${restsOn(metric)})`,
    ),
  );
}

function restsOn({ name }) {
  if (name.startsWith("tug_")) return "attempts";
  return name.startsWith("repetition") ? "repetitions" : "strides";
}

function cell(metric, named = false) {
  if (!metric) return el("td", { class: "number" }, "");
  const { factor, digits, unit } = shown(metric.unit, metric.name);
  const shownUnit = named ? unit : "";
  if (metric.value === null) return el("td", { class: "number quiet", title: metric.withheld_because }, "–");
  const spread = metric.spread === null ? "" : ` ± ${number(metric.spread * factor, digits)}`;
  return el(
    "td",
    { class: "number" },
    number(metric.value * factor, digits),
    el("span", { class: "quiet" }, spread || ` ${shownUnit}`),
  );
}

export function sample(side) {
  const line = svg("line", {
    x1: 0,
    x2: 34,
    y1: 6,
    y2: 6,
    stroke: SIDE_COLOUR[side],
    "stroke-width": 2.5,
    "stroke-dasharray": SIDE_DASH[side]?.join(" "),
  });
  const drawing = svg("svg", { width: 34, height: 12, "aria-hidden": "true" }, line);
  return el("span", { class: `sample ${side}` }, side === "left" ? "L " : "R ", drawing);
}
