// What a report rests on: attempts, repetitions and curves to look into, and every number.
import { get } from "./api.js";
import { isExercise } from "./arrangement.js";
import { MeanChart } from "./charts.js";
import { el, svg } from "./dom.js";
import { numbersTable } from "./numbers_table.js";
import { SIDE_COLOUR, SIDE_DASH } from "./palette.js";
import { PhaseTimeline, attemptsOf, phaseTable } from "./phase_timeline.js";
import { rangesTable } from "./ranges_table.js";
import { RepetitionChart, movementTable, repetitionTable } from "./repetition_report.js";
import { SIDES } from "./vectors.js";
import { TASKS, jointName } from "./words.js";

const FIRST_CURVES = ["hip_flexion", "knee_flexion"];
const PARTS = /** @type {const} */ ([
  "/sessions/{session}/metrics",
  "/sessions/{session}/curves",
  "/sessions/{session}/phases",
  "/sessions/{session}/repetitions",
]);

export class MeasuredView {
  constructor(session) {
    this.session = session;
    this.charts = [];
    this.drawn = el("div", { class: "column" });
    this.numbers = el("div");
    this.node = el("div", { class: "column" }, this.drawn, this.numbers);
    this.load();
  }

  async load() {
    const session = this.session.id;
    const answers = await Promise.all(PARTS.map((part) => get(part, { session }).catch(() => null)));
    if (this.disposed) return;
    const [metrics, curves, phases, repetitions] = /** @type {any[]} */ (answers);
    const all = metrics?.metrics ?? [];
    this.showPhases(phases?.phases ?? [], all);
    this.showRepetitions(repetitions?.repetitions ?? [], all);
    // Nobody walks in an exercise: what swings to and fro there are no strides.
    if (!isExercise(this.session.task)) this.showCurves(curves?.curves ?? []);
    const numbers = numbersTable(all) ?? el("p", { class: "quiet" }, "No number could be measured.");
    const meaning = "95 % interval where it is known, else standard deviation; trust, and cycles it rests on";
    this.numbers.append(panel("Every number", meaning, numbers));
  }

  showPhases(phases, metrics) {
    const timed = phases.filter((phase) => phase.task === "timed_up_and_go");
    if (timed.length === 0) return;
    const attempts = attemptsOf(timed);
    const host = el("div", { class: "drawn" });
    const title = TASKS.timed_up_and_go;
    this.drawn.append(panel(title, "seconds ± one standard deviation", host, phaseTable(attempts, metrics)));
    this.charts.push(new PhaseTimeline(host, attempts));
  }

  showRepetitions(repetitions, metrics) {
    if (repetitions.length === 0) return;
    const host = el("div", { class: "drawn" });
    const list = this.session.task === "knee_flexion" ? repetitionTable(repetitions) : movementTable(repetitions);
    const meaning = "least to largest angle of each; hollow ones do not count";
    this.drawn.append(panel("Repetitions", meaning, host, list));
    this.charts.push(new RepetitionChart(host, repetitions));
    const known = metrics.map(({ name }) => /^repetition_(.+)_range$/.exec(name)?.[1]).filter(Boolean);
    const others = rangesTable(repetitions, known);
    if (others)
      this.drawn.append(panel("Other angles", "range within a repetition, mean ± standard deviation", others));
  }

  showCurves(curves) {
    const joints = new Map();
    for (const curve of curves) {
      const [, side] = jointName(curve.degree_of_freedom);
      const joint = side ? curve.degree_of_freedom.slice(0, -side.length - 1) : curve.degree_of_freedom;
      if (side) joints.set(joint, { ...joints.get(joint), [side]: curve });
    }
    const shown = FIRST_CURVES.filter((name) => joints.has(name));
    if (shown.length === 0) return;
    const place = el("div", { class: "mean-curves" });
    this.drawn.append(place);
    for (const joint of shown) this.showCurve(place, joint, joints.get(joint));
  }

  showCurve(place, joint, sides) {
    const host = el("div", { class: "chart mean" });
    const seen = SIDES.filter((side) => sides[side]);
    const counts = seen.map((side) => `${side === "left" ? "L" : "R"} ${sides[side].strides}`).join(", ");
    const name = jointName(joint)[0];
    const curve = panel(name, "mean ± SD", host);
    curve.firstElementChild.append(
      el("span", { class: "spring" }),
      ...seen.map(sample),
      el("span", { class: "quiet" }, `${counts} strides`),
    );
    curve.classList.add("chart-panel");
    place.append(curve);
    this.charts.push(new MeanChart(host, sides));
  }

  dispose() {
    this.disposed = true;
    for (const chart of this.charts) chart.dispose();
  }
}

function panel(title, meaning, ...children) {
  const head = el("div", { class: "panel-head" }, el("h2", {}, title), el("span", { class: "quiet" }, meaning));
  return el("section", { class: "panel", "aria-label": title }, head, ...children);
}

function sample(side) {
  const dash = SIDE_DASH[side]?.join(" ");
  const stroke = { stroke: SIDE_COLOUR[side], "stroke-width": 2.5, "stroke-dasharray": dash };
  const line = svg("line", { x1: 0, x2: 34, y1: 6, y2: 6, ...stroke });
  const drawing = svg("svg", { width: 34, height: 12, "aria-hidden": "true" }, line);
  return el("span", { class: `sample ${side}` }, side === "left" ? "L " : "R ", drawing);
}
