// A patient's progress as pages put it: verdicts and rules in sentences, charts from what the API tells.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const load = (name) => import(new URL(name, sources));
const { DIRECTIONS, JOINT_WORDS, TREATMENTS, VERDICTS, ruleSentence, sayer } = await load("rule_words.js");
const { byMeasure, lineOf, notAlike, treatmentMarks } = await load("progress_series.js");
const { spanOf } = await load("progress_chart.js");
const { digitsOf } = await load("drawing.js");
const { GRADES, doubtWords } = await load("trust_words.js");
const { possible } = await load("files_panel.js");
const { columnOf } = await load("report_document.js");
const { isSeen, spreadWords } = await load("numbers_table.js");

const rulesFile = new URL("../../../services/progress/rules.py", import.meta.url);
const rule = (code, parameters = {}) => ({ code, parameters });
const speed = sayer("m/s", "walking_speed");

const visit = (number, value, verdict = "cannot_tell", change = null) => ({
  visit: number,
  day: `2026-0${number}-01`,
  value,
  low: value - 0.1,
  high: value + 0.1,
  change: change && { value: change },
  verdict,
});
const point = (number, value, rules = []) => ({ visit: number, value, low: null, high: null, rules });
const series = (fields) => ({
  task: "walk",
  instruction: "comfortable",
  measure: "walking_speed",
  side: null,
  unit: "m/s",
  visits: [],
  points: [],
  baseline: null,
  mdc: null,
  ...fields,
});

test("verdicts have the three words and no others", () => {
  assert.deepEqual(
    Object.values(VERDICTS).map(({ word }) => word),
    ["real change", "within measurement error", "cannot tell"],
  );
});

test("no page ever calls anybody normal or abnormal", () => {
  const files = readdirSync(sources).filter((name) => name.endsWith(".js"));
  assert.ok(files.length > 40);
  for (const name of files) {
    const code = readFileSync(new URL(name, sources), "utf8").replaceAll(/^\s*(\/\/|\/?\*).*$/gm, "");
    assert.doesNotMatch(code, /["'`][^"'`\n]*\b(ab)?normal\b[^"'`\n]*["'`]/i, name);
  }
});

test("every rule, verdict, word and treatment of the services has a sentence here", () => {
  const python = readFileSync(rulesFile, "utf8");
  const codes = [...python.matchAll(/^    [A-Z_]+ = "([a-z_]+)"$/gm)].map(([, code]) => code);
  const worded = { ...VERDICTS, ...DIRECTIONS, ...JOINT_WORDS };
  const parameters = new Proxy({}, { get: (_, name) => (name === "motion" ? "circumduction" : "1") });
  assert.ok(codes.length > 25, String(codes));
  for (const code of codes.filter((each) => !(each in worded))) {
    const sentence = ruleSentence(rule(code, parameters), speed);
    assert.notEqual(sentence, `${code.replaceAll("_", " ")}.`, code);
    assert.doesNotMatch(sentence, /normal|undefined|NaN/, code);
  }
  const treatments = readFileSync(new URL("treatments.py", rulesFile), "utf8");
  const kinds = [...treatments.matchAll(/= "([a-z_]+)"$/gm)].map(([, kind]) => kind);
  assert.deepEqual(Object.keys(TREATMENTS), kinds);
});

test("a verdict's rule is said with the interval and the threshold, in the reader's unit", () => {
  const numbers = { change: 0.21, low: 0.18, high: 0.24, mdc: 0.15, limit: 0.153 };
  assert.equal(
    ruleSentence(rule("change_beyond_mdc", numbers), speed),
    "Change +0.21 m/s (95 % interval +0.18 m/s to +0.24 m/s): larger than the MDC of 0.15 m/s and our own error together (0.15 m/s).",
  );
  const knee = sayer("rad", "knee_flexion_range");
  const below = ruleSentence(rule("below_smallest_change", { change: -0.05, smallest: Math.PI / 30 }), knee);
  assert.equal(below, "Change −2.9°: below 6.0° it is never called progress.");
});

test("what differs is named in plain words", () => {
  const aid = rule("difference", { what: "aid", now: "rollator", baseline: "cane" });
  assert.equal(ruleSentence(aid, speed), "Not like with like: walking aid rollator now, cane at the baseline.");
  const unsaid = rule("difference", { what: "test_duration_s", now: null, baseline: 360 });
  assert.match(ruleSentence(unsaid, speed), /duration of the test not said now, 360 s at the baseline/);
  assert.equal(ruleSentence(rule("something_new"), speed), "something new.");
});

test("both sides of a measure share a chart, and what has no value has none", () => {
  const left = series({ measure: "step_length", side: "left", points: [point(1, 0.5)] });
  const right = { ...left, side: "right" };
  const groups = byMeasure([left, right, series({ points: [point(1, null)] })]);
  assert.deepEqual(
    groups.map(({ measure, series: each }) => [measure, each.length]),
    [["step_length", 2]],
  );
});

test("a triangle is drawn for a real change alone, and what cannot be compared stays beside the line", () => {
  const line = lineOf(
    series({
      visits: [visit(1, 0.5), visit(3, 0.7, "real_change", 0.2), visit(4, 0.4, "within_measurement_error", -0.1)],
      points: [point(1, 0.5), point(2, 0.6, [rule("difference", { what: "aid" })]), point(5, null)],
      baseline: visit(1, 0.5),
      mdc: { value: 0.15 },
    }),
  );
  assert.deepEqual(
    line.marks.map(({ number, baseline, real, counts }) => [number, baseline, real, counts]),
    [
      [1, true, 0, true],
      [2, false, 0, false],
      [3, false, 1, true],
      [4, false, 0, true],
    ],
  );
  assert.deepEqual([line.baseline, line.mdc], [0.5, 0.15]);
  const angle = lineOf(series({ measure: "knee_flexion_range", unit: "rad", visits: [visit(1, Math.PI / 4)] }));
  assert.ok(Math.abs(angle.marks[0].value - 45) < 1e-9, "charts are in shown units");
});

test("the span of a chart holds every interval and the band, and is never nothing", () => {
  const [low, high] = spanOf([lineOf(series({ visits: [visit(1, 1)], baseline: visit(1, 1), mdc: { value: 0.3 } }))]);
  assert.ok(low < 0.7 && high > 1.3);
  const [one, other] = spanOf([{ marks: [{ value: 0, low: null, high: null }], baseline: null, mdc: null }]);
  assert.ok(other > one);
  assert.deepEqual([digitsOf([0, 10]), digitsOf([0.5, 0.6]), digitsOf([0.1, 0.15]), digitsOf([3])], [0, 1, 2, 0]);
});

test("each difference from the baseline is told once per visit", () => {
  const aid = rule("difference", { what: "aid" });
  const told = notAlike([
    series({ points: [point(3, 1, [aid, rule("no_interval")]), point(2, 1, [rule("unsaid", { what: "aid" })])] }),
    series({ points: [point(3, 1, [aid])] }),
  ]);
  assert.deepEqual(
    told.map(([number, { code }]) => [number, code]),
    [
      [2, "unsaid"],
      [3, "difference"],
    ],
  );
});

test("treatments stand between the visits by their day, with letters in order", () => {
  const visits = [
    { visit: 2, day: "2026-09-21" },
    { visit: 1, day: "2026-09-07" },
  ];
  const treated = (id, date) => ({ id, date, kind: "surgery" });
  const marks = treatmentMarks(
    [treated(1, "2026-12-01"), treated(2, "2026-09-14"), treated(3, "2026-01-01"), treated(4, "2026-09-21")],
    visits,
  );
  assert.deepEqual(
    marks.map(({ id, letter, at }) => [id, letter, at]),
    [
      [3, "A", 0.7],
      [2, "B", 1.5],
      [4, "C", 2],
      [1, "D", 2.3],
    ],
  );
  assert.equal(treatmentMarks([treated(1, "2026-01-01")], []).length, 1);
});

test("trust is a word, and what was withheld says why", () => {
  assert.deepEqual(Object.values(GRADES).map(({ word }) => word), ["Good", "Fair", "Poor", "Withheld"]);
  assert.equal(doubtWords({ doubts: [], withheld_because: "2 of at least 6 strides" }), "2 of at least 6 strides");
  const doubts = [
    { kind: "few_cycles", subject: null },
    { kind: "misplaced", subject: "thigh_left" },
  ];
  assert.equal(doubtWords({ doubts, withheld_because: null }), "few cycles, sensors may be swapped (thigh left)");
});

test("every doubt of the services has words here", () => {
  const python = readFileSync(new URL("../../../schemas/metrics.py", import.meta.url), "utf8");
  const [, body] = python.split("class DoubtKind");
  const kinds = [...body.split("class ")[0].matchAll(/= "([a-z_]+)"/g)].map(([, kind]) => kind);
  assert.ok(kinds.length > 10);
  const words = kinds.map((kind) => doubtWords({ doubts: [{ kind, subject: null }], withheld_because: null }));
  assert.equal(new Set(words).size, kinds.length);
});

test("formats that cannot be had are named once per reason", () => {
  const format = (name, reason = null) => ({ format: name, available: reason === null, reason });
  const { had, not } = possible([format("a.csv"), format("b.c3d", "no recording"), format("c.mot", "no recording")]);
  assert.deepEqual(had.map((each) => each.format), ["a.csv"]);
  assert.deepEqual(not, [["no recording", ["b.c3d", "c.mot"]]]);
});

test("a value of the whole body takes the columns of both sides", () => {
  const cells = [{ span: 2 }, { span: 1 }, { span: 1 }];
  assert.deepEqual([columnOf(cells, 0), columnOf(cells, 1), columnOf(cells, 2)], [1, 3, 4]);
});

test("a number is shown with its 95 % interval, else with its standard deviation", () => {
  const scale = { factor: 1, digits: 2 };
  assert.equal(spreadWords({ low: 0.61, high: 0.65, spread: 0.1 }, scale), "0.61 to 0.65");
  assert.equal(spreadWords({ low: null, high: null, spread: 0.1 }, scale), "SD 0.10");
  assert.equal(spreadWords({ low: null, high: null, spread: null }, scale), "");
  assert.equal(isSeen({ name: "strides_counted", strides: 0, value: 0 }), false);
  assert.equal(isSeen({ name: "walking_speed", strides: 2, value: null }), true);
});
