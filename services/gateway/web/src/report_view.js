// A session that is over: numbers with their spread, what was done, mean curves, files. What does not apply is absent.
import { get } from "./api.js";
import { isExercise } from "./arrangement.js";
import { NEVER_CALIBRATED } from "./camera_words.js";
import { MeanChart } from "./charts.js";
import { el, fill } from "./dom.js";
import { SIDES } from "./vectors.js";
import { PatientLink } from "./patient_link.js";
import { PhaseTimeline, attemptsOf, phaseTable } from "./phase_timeline.js";
import { rangesTable } from "./ranges_table.js";
import { RepetitionChart, movementTable, repetitionTable } from "./repetition_report.js";
import { isSeen, metricTile, ratioTable, sample, sideTable } from "./report_tables.js";
import { bytes, clock, number, when } from "./units.js";
import {
  STORED_WORDS,
  TASKS,
  headlineRank,
  jointName,
  metricGroup,
  misplacedText,
  qualityText,
} from "./words.js";

const FIRST_CURVES = ["hip_flexion", "knee_flexion"];
const EXERCISE_HEADLINES = [
  "repetitions_counted",
  "repetition_range",
  "repetition_flexion_largest",
  "repetition_flexion_smallest",
  "repetition_tempo",
];
const BODY_HEADLINES = [
  "repetitions_counted",
  "repetition_range",
  "repetition_hold",
  "repetition_tempo",
];
const PARTS = ["metrics", "curves", "phases", "repetitions", "recordings"];

export class ReportView {
  constructor(host, session) {
    this.session = session;
    this.charts = [];
    this.quality = el("p", { class: "quality quiet" });
    this.tiles = el("div", { class: "tiles wide" });
    this.timed = el("section", { class: "panel", "aria-label": "Timed up and go", hidden: true });
    this.exercise = el("section", { class: "panel", "aria-label": "Exercise", hidden: true });
    this.numbers = el("div", { class: "scroll" }, el("p", { class: "quiet" }, "Reading …"));
    this.more = el("div", { class: "pair" });
    this.strides = this.stridesPanel();
    this.files = el("ul", { class: "files" });
    this.curves = el("div", { class: "mean-curves" });
    fill(
      host,
      this.head(),
      this.tiles,
      this.timed,
      el(
        "div",
        { class: "report" },
        el("div", { class: "column" }, this.exercise, this.strides, this.filesPanel()),
        this.curves,
      ),
    );
    this.load();
  }

  head() {
    const { session } = this;
    const { word, tone } = STORED_WORDS[session.state];
    const task = session.task && session.task !== "walk" ? taskWords(session) : null;
    const facts = [when(session.started ?? session.created), clock(session.duration_s), task, session.estimator];
    const misplaced = misplacedText(session.misplaced);
    return el(
      "div",
      { class: "report-head" },
      el(
        "div",
        { class: "session-head" },
        el("h1", {}, session.title),
        el("p", { class: "chip big", "data-tone": tone }, word),
        el("span", { class: "quiet" }, facts.filter(Boolean).join("  ·  ")),
        el("span", { class: "spring" }),
        new PatientLink(session).node,
      ),
      session.reason ? el("p", { class: "banner" }, session.reason) : null,
      misplaced ? el("p", { class: "banner" }, misplaced) : null,
      session.absolute === false ? el("p", { class: "banner" }, NEVER_CALIBRATED) : null,
      this.quality,
    );
  }

  stridesPanel() {
    const meaning = el("span", { class: "quiet" }, "mean ± standard deviation over strides");
    const head = el("div", { class: "panel-head" }, el("h2", {}, "Numbers"), meaning);
    return el("section", { class: "panel", "aria-label": "Metrics" }, head, this.numbers, this.more);
  }

  filesPanel() {
    return el(
      "section",
      { class: "panel", "aria-label": "Recording" },
      el("h2", {}, "Recording"),
      el("p", { class: "quiet" }, "Everything that was measured and computed, as MCAP files with named fields."),
      this.files,
    );
  }

  async load() {
    const path = `/sessions/${this.session.id}`;
    const [metrics, curves, phases, repetitions, files] = await Promise.all(
      PARTS.map((part) => get(`${path}/${part}`).catch((problem) => problem)),
    );
    if (this.disposed) return;
    if (metrics instanceof Error) fill(this.numbers, el("p", { class: "quiet" }, metrics.message));
    else this.showMetrics(metrics.metrics);
    if (!(phases instanceof Error)) this.showPhases(phases.phases, metrics.metrics);
    if (!(repetitions instanceof Error) && repetitions.repetitions.length > 0)
      this.showRepetitions(repetitions.repetitions, metrics.metrics);
    if (!(curves instanceof Error) && this.walks) this.showCurves(curves.curves);
    this.showFiles(files instanceof Error ? [] : files);
  }

  /** Nobody walks in an exercise: what swings to and fro there are no strides. */
  get walks() {
    return !isExercise(this.session.task);
  }

  showMetrics(metrics) {
    const groups = Object.groupBy(metrics, (metric) => metricGroup(metric) ?? "rest");
    const { task, datum, absolute } = this.session;
    this.quality.textContent = qualityText(metrics, { task, datum: absolute === false ? null : datum });
    this.strides.hidden = !this.walks;
    if (this.walks) this.showStrides(groups);
    else this.showExercise(groups.exercise ?? [], groups.symmetry);
  }

  showStrides({ headlines = [], sides = [], counts = [], symmetry, legs, variability }) {
    const tiles = headlines.filter(isSeen).toSorted((a, b) => headlineRank(a) - headlineRank(b));
    fill(this.tiles, ...tiles.map((metric) => metricTile(metric)));
    this.tiles.hidden = tiles.length === 0;
    fill(this.numbers, sideTable([...sides, ...counts]) ?? el("p", { class: "quiet" }, "No stride was found."));
    const both = SIDES.every((side) => sides.some((metric) => metric.side === side && isSeen(metric)));
    const tables = [
      both && ratioTable("Symmetry", "larger side / smaller side, 1.00 is equal", symmetry),
      both && ratioTable("Left against right", "mean hip and knee curves over the stride, 0 is equal", legs),
      ratioTable("Variability", "standard deviation / mean", variability),
    ].filter(Boolean);
    fill(this.more, ...tables);
    this.more.hidden = tables.length === 0;
  }

  showExercise(metrics, symmetry) {
    const list = sideTable(metrics);
    const headlines = this.session.task === "knee_flexion" ? EXERCISE_HEADLINES : BODY_HEADLINES;
    const bothKnees = SIDES.every((side) => metrics.some((metric) => metric.side === side && isSeen(metric)));
    const tiles = metrics.filter((metric) => isSeen(metric) && headlines.includes(metric.name));
    fill(this.tiles, ...tiles.map((metric) => metricTile(metric, bothKnees)));
    this.tiles.hidden = tiles.length === 0;
    const meaning = el("span", { class: "quiet" }, "mean ± standard deviation over repetitions");
    const nothing = el("p", { class: "quiet" }, "No repetition was found.");
    const head = el("div", { class: "panel-head" }, el("h2", {}, "Exercise"), meaning);
    const equal = ratioTable("Symmetry", "larger side / smaller side, 1.00 is equal", symmetry);
    fill(this.exercise, head, list ?? nothing, equal && el("div", { class: "below" }, equal));
    this.exercise.hidden = false;
  }

  showPhases(phases, metrics) {
    this.timed.hidden = phases.length === 0 && this.session.task !== "timed_up_and_go";
    if (this.timed.hidden) return;
    const meaning = phases.length > 0 ? "seconds ± one standard deviation" : "none was found";
    const head = el("div", { class: "panel-head" }, el("h2", {}, TASKS.timed_up_and_go));
    head.append(el("span", { class: "quiet" }, meaning));
    fill(this.timed, head);
    if (phases.length === 0) return;
    const attempts = attemptsOf(phases);
    const host = el("div", { class: "drawn" });
    this.timed.append(host, phaseTable(attempts, metrics));
    this.charts.push(new PhaseTimeline(host, attempts));
  }

  showRepetitions(repetitions, metrics) {
    const host = el("div", { class: "drawn" });
    const meaning = el("span", { class: "quiet" }, "least to largest angle of each; hollow ones do not count");
    const head = el("div", { class: "panel-head" }, el("h2", {}, "Repetitions"), meaning);
    const list = this.session.task === "knee_flexion" ? repetitionTable(repetitions) : movementTable(repetitions);
    this.showRanges(repetitions, metrics);
    this.curves.append(el("section", { class: "panel", "aria-label": "Repetitions" }, head, host, list));
    this.charts.push(new RepetitionChart(host, repetitions));
  }

  /** Angles that are no metric of the task. */
  showRanges(repetitions, metrics) {
    const known = metrics.map(({ name }) => /^repetition_(.+)_range$/.exec(name)?.[1]).filter(Boolean);
    const list = rangesTable(repetitions, known);
    if (!list) return;
    const meaning = el("span", { class: "quiet" }, "range within a repetition, mean ± standard deviation");
    const head = el("div", { class: "panel-head" }, el("h2", {}, "Other angles"), meaning);
    this.exercise.after(el("section", { class: "panel", "aria-label": "Other angles" }, head, list));
  }

  showCurves(curves) {
    const joints = new Map();
    for (const curve of curves) {
      const [, side] = jointName(curve.degree_of_freedom);
      const joint = side ? curve.degree_of_freedom.slice(0, -side.length - 1) : curve.degree_of_freedom;
      if (side) joints.set(joint, { ...joints.get(joint), [side]: curve });
    }
    for (const joint of FIRST_CURVES.filter((name) => joints.has(name))) this.showCurve(joint, joints.get(joint));
  }

  showCurve(joint, sides) {
    const host = el("div", { class: "chart mean" });
    const seen = SIDES.filter((side) => sides[side]);
    const counts = seen.map((side) => `${side === "left" ? "L" : "R"} ${sides[side].strides}`).join(", ");
    const head = el(
      "div",
      { class: "panel-head" },
      el("h2", {}, jointName(joint)[0]),
      el("span", { class: "quiet" }, "mean ± SD"),
      el("span", { class: "spring" }),
      ...seen.map(sample),
      el("span", { class: "quiet" }, `${counts} strides`),
    );
    this.curves.append(el("section", { class: "panel chart-panel", "aria-label": jointName(joint)[0] }, head, host));
    this.charts.push(new MeanChart(host, sides));
  }

  showFiles(files) {
    const path = `/v1/sessions/${this.session.id}/recordings`;
    const lines = files.map(({ name, size_bytes, kind, complete }) => {
      const words = `${bytes(size_bytes)}, ${kind === "raw" ? "sensors" : "computed"}${complete ? "" : ", still open"}`;
      const link = el("a", { href: `${path}/${encodeURIComponent(name)}`, download: true }, name);
      return el("li", {}, link, el("span", { class: "quiet" }, words));
    });
    const none = el("li", { class: "quiet" }, "No files. The archive may not have been running.");
    fill(this.files, ...(lines.length > 0 ? lines : [none]));
  }

  dispose() {
    this.disposed = true;
    for (const chart of this.charts) chart.dispose();
  }
}

function taskWords({ task, walkway_m }) {
  return walkway_m ? `${TASKS[task]}, ${number(walkway_m, 1)} m` : TASKS[task];
}
