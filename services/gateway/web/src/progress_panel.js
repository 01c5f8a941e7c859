// Whether the patient really changed: a small chart per measure, the verdict in its words, and the rule behind it.
import { PACES } from "./condition_words.js";
import { el, fill, table } from "./dom.js";
import { ProgressChart } from "./progress_chart.js";
import { byMeasure, lineOf, notAlike } from "./progress_series.js";
import { bandOf } from "./reference_bands.js";
import { DIRECTIONS, VERDICTS, ruleSentence, sayer } from "./rule_words.js";
import { number, shown } from "./units.js";
import { TASKS, metricName } from "./words.js";

const FIRST = 9;
const REFERENCE = "Grey: reference, from the 5th to the 95th percentile of people like this one.";
const NO_REFERENCE = "No reference set of this site fits people like this one.";
const LETTERS = { left: "L", right: "R" };

export class ProgressPanel {
  constructor() {
    this.charts = [];
    this.place = el("div");
    this.reference = el("p", { class: "quiet" });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Progress" },
      el("h2", {}, "Progress"),
      el(
        "p",
        { class: "quiet" },
        "Dashed: baseline; band: ± MDC, the smallest change beyond measurement error; bars: 95 % interval. Triangle:",
        " real change. Dot: within measurement error or cannot tell. Square: baseline. Hollow: not comparable.",
      ),
      this.reference,
      this.place,
    );
  }

  /**
   * @param {object[]} series of the API @param {object[]} treatments with letter and place
   * @param {Map<string, import("./reference_bands.js").Band>} bands by test and measure
   */
  show(series, treatments, bands) {
    this.dispose();
    this.bands = bands;
    fill(this.reference, bands.size > 0 ? REFERENCE : NO_REFERENCE);
    this.charts = [];
    const tests = Object.values(Object.groupBy(byMeasure(series), (each) => `${each.task} ${each.instruction}`));
    const nothing = el("p", {}, "No visit has numbers that can be followed yet.");
    fill(this.place, ...(tests.length > 0 ? tests.map((groups) => this.test(groups, treatments)) : [nothing]));
  }

  test(groups, treatments) {
    const [{ task, instruction }] = groups;
    const all = groups.flatMap((group) => group.series);
    return el(
      "div",
      { class: "test-progress" },
      el("h3", {}, instruction ? `${TASKS[task]}, pace: ${PACES[instruction].toLowerCase()}` : TASKS[task]),
      differences(all),
      el("div", { class: "multiples" }, ...groups.slice(0, FIRST).map((group) => this.multiple(group, treatments))),
      el("details", {}, el("summary", {}, `All ${all.length} measures with their verdicts`), verdictTable(all), repeatTable(all)),
    );
  }

  multiple({ task, instruction, measure, unit, series }, treatments) {
    const host = el("div", { class: "drawn" });
    const sign = shown(unit, measure).unit;
    const lines = series.map(lineOf);
    const name = metricName(measure);
    const reference = bandOf(this.bands, { task, instruction, measure });
    this.charts.push(new ProgressChart(host, { lines, treatments, reference, label: chartWords(name, sign, lines, reference) }));
    return el(
      "figure",
      { class: "multiple", "data-measure": measure },
      el("figcaption", {}, name, sign ? el("span", { class: "unit" }, ` ${sign}`) : null),
      host,
      reference ? el("p", { class: "quiet reference" }, referenceWords(reference, sign)) : null,
      ...bySentence(series).map(verdictOf),
    );
  }

  dispose() {
    for (const chart of this.charts) chart.dispose();
  }
}

function differences(series) {
  const say = sayer("1", "");
  const found = notAlike(series);
  if (found.length === 0) return null;
  const lines = found.map(([visit, rule]) => el("li", {}, `Visit ${visit}: ${ruleSentence(rule, say)}`));
  return el("div", { class: "banner" }, "Not all visits can be compared.", el("ul", {}, ...lines));
}

/** Sides of which the very same is said, said once. */
function bySentence(series) {
  const say = sayer(series[0].unit, series[0].measure);
  const told = series.map((each) => ({ each, words: each.rules.map((rule) => ruleSentence(rule, say)).join(" ") }));
  return Object.values(Object.groupBy(told, ({ each, words }) => `${each.verdict} ${each.direction} ${words}`));
}

function verdictOf(alike) {
  const [{ each, words }] = alike;
  const sides = alike.map(({ each: { side } }) => side && el("b", { class: side }, `${LETTERS[side]} `));
  return el(
    "div",
    { class: "verdict" },
    ...sides,
    verdictChip(each),
    el("p", { class: "quiet" }, words, each.mdc && ` MDC: ${each.mdc.people}; ${each.mdc.source}.`),
  );
}

function verdictChip({ verdict, direction }) {
  const { word, tone } = VERDICTS[verdict];
  const way = direction ? `, ${DIRECTIONS[direction]}` : "";
  return el("span", { class: "chip small", "data-tone": direction === "worse" ? "check" : tone }, word + way);
}

function verdictTable(series) {
  const rows = series.map((each) => {
    const { measure, side, unit, baseline, visits, change, mdc, rules } = each;
    const say = sayer(unit, measure);
    const newest = visits.at(-1);
    return el(
      "tr",
      {},
      el("th", { scope: "row" }, metricName(measure)),
      el("td", { class: side }, LETTERS[side] ?? ""),
      ...[baseline?.value, newest?.value].map((value) => el("td", { class: "number" }, told(value, say.plain))),
      el("td", { class: "number" }, change ? `${say.change(change.value)} (${say.change(change.low)} to ${say.change(change.high)})` : "–"),
      el("td", { class: "number" }, told(mdc?.value, say.plain)),
      el("td", {}, verdictChip(each)),
      el("td", { class: "quiet" }, rules.map((rule) => ruleSentence(rule, say)).join(" ")),
    );
  });
  const columns = ["Measure", "Side", "Baseline#", "Newest#", "Change (95 % interval)#", "MDC#", "Verdict", "Rule"];
  return table(columns, el("tbody", {}, ...rows));
}

/** Trials of one visit against each other; null where nobody repeated anything. */
function repeatTable(series) {
  const rows = series.flatMap(({ measure, side, unit, repeats }) => {
    const say = sayer(unit, measure);
    return repeats.map((repeat) =>
      el(
        "tr",
        {},
        el("th", { scope: "row" }, metricName(measure)),
        el("td", { class: side }, LETTERS[side] ?? ""),
        el("td", { class: "number" }, String(repeat.visit)),
        el("td", { class: "number" }, say.change(repeat.change.value)),
        el("td", { class: "number" }, told(repeat.mdc?.value, say.plain)),
        el("td", {}, verdictChip(repeat)),
        el("td", { class: "quiet" }, repeat.rules.map((rule) => ruleSentence(rule, say)).join(" ")),
      ),
    );
  });
  if (rows.length === 0) return null;
  const columns = ["Last against first trial", "Side", "Visit#", "Change#", "MDC#", "Verdict", "Rule"];
  return el("div", { class: "below" }, table(columns, el("tbody", {}, ...rows)));
}

const told = (value, say) => (value === undefined || value === null ? "–" : say(value));

/** The chart in words with its numbers. */
function chartWords(name, unit, lines, reference) {
  const parts = lines.map(({ side, marks, baseline, mdc }) => {
    const values = marks.map((mark) => `visit ${mark.number} ${number(mark.value, 2)}`).join(", ");
    const band = baseline === null ? "" : `; baseline ${number(baseline, 2)}${mdc === null ? "" : ` ± ${number(mdc, 2)}`}`;
    return `${side ? `${side}: ` : ""}${values}${band}`;
  });
  const people = reference ? ` Reference ${number(reference.low, 2)} to ${number(reference.high, 2)}.` : "";
  return `${name}${unit ? ` in ${unit}` : ""} by visit. ${parts.join(". ")}.${people}`;
}

function referenceWords({ low, high, title, citation, n }, unit) {
  const people = n === null ? "" : `, n=${n}`;
  return `Reference ${number(low, 2)} to ${number(high, 2)}${unit ? ` ${unit}` : ""}: ${title}${people} (${citation}).`;
}
