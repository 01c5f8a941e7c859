// Recovery or compensation: how far each joint of one leg is from the other's, visit by visit, beside walking speed.
import { el, fill, table } from "./dom.js";
import { JOINT_WORDS, ruleSentence, sayer } from "./rule_words.js";
import { degrees, number } from "./units.js";
import { TASKS, jointName } from "./words.js";

export class JointsPanel {
  constructor() {
    this.place = el("div");
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Recovery or compensation", hidden: true },
      el("h2", {}, "Recovery or compensation"),
      el(
        "p",
        { class: "quiet" },
        "Root mean square difference of the two legs' curves over the stride, aligned by phase. Legs that come closer",
        " while walking gets faster speak for recovery; hip rotation or circumduction that grows, for compensation.",
      ),
      this.place,
    );
  }

  show(joints) {
    this.node.hidden = joints.length === 0;
    const tests = Object.values(Object.groupBy(joints, (each) => `${each.task} ${each.instruction}`));
    fill(this.place, ...tests.map(jointTable));
  }
}

function jointTable(joints) {
  const numbers = [...new Set(joints.flatMap(({ visits }) => visits.map(({ visit }) => visit)))].sort((a, b) => a - b);
  const speedAt = (visit) => joints.flatMap(({ visits }) => visits).find((each) => each.visit === visit)?.speed ?? null;
  const speeds = el(
    "tr",
    {},
    el("th", { scope: "row" }, "Walking speed"),
    ...numbers.map((visit) => el("td", { class: "number" }, withUnit(speedAt(visit), 2, " m/s"))),
    el("td", { colspan: 2 }),
  );
  const body = el("tbody", {}, speeds, ...joints.map((joint) => row(joint, numbers)));
  const columns = [TASKS[joints[0].task], ...numbers.map((visit) => `Visit ${visit}#`), "", "Rule"];
  return table(columns, body);
}

function row({ joint, visits, word, rules }, numbers) {
  const { word: text, tone } = JOINT_WORDS[word];
  const say = sayer("rad", joint);
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, jointName(joint)[0]),
    ...numbers.map((visit) => cell(visits.find((each) => each.visit === visit))),
    el("td", {}, el("span", { class: "chip small", "data-tone": tone }, text)),
    el("td", { class: "quiet" }, rules.map((rule) => ruleSentence(rule, say)).join(" ")),
  );
}

function cell(told) {
  if (!told) return el("td", { class: "number quiet" }, "–");
  const interval = `${number(degrees(told.low), 1)} to ${number(degrees(told.high), 1)}`;
  return el("td", { class: "number", title: `95 % interval ${interval}°` }, withUnit(degrees(told.distance), 1, "°"));
}

const withUnit = (value, digits, unit) => (value === null ? "–" : `${number(value, digits)}${unit}`);
