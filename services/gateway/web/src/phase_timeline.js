// Timed tests of a session: one bar per attempt, its parts in seconds from standing up, and the same as a table.
import { el, svg, table } from "./dom.js";
import { Drawing, bottomAxis, text, ticksOf } from "./drawing.js";
import { extentOf, isGivenUp } from "./phase_strip.js";
import { INK, INVALID, PHASE_COLOURS, SOFT_INK } from "./palette.js";
import { number } from "./units.js";
import { PHASES } from "./words.js";

const ROW = { height: 46, gap: 10 };
const MARGIN = { left: 84, right: 14, top: 4, bottom: 42 };
const ROOM_FOR_NAME_PX = 62;

/** Phases by attempt, in order. */
export function attemptsOf(phases) {
  return [...new Set(phases.map((phase) => phase.attempt))].map((attempt) => {
    const own = phases.filter((phase) => phase.attempt === attempt);
    return { attempt, phases: own, ...extentOf(own) };
  });
}

/** The bars. */
export class PhaseTimeline {
  constructor(host, attempts) {
    this.attempts = attempts;
    const height = MARGIN.top + attempts.length * (ROW.height + ROW.gap) + MARGIN.bottom;
    const label = attempts.map(inWords).join(" ");
    this.drawing = new Drawing(host, { label, height, draw: (width) => this.draw(width, height) });
  }

  draw(width, height) {
    const ends = this.attempts.flatMap(({ from, phases }) => phases.map((each) => (each.end_s ?? each.start_s) - from));
    const longest_s = Math.max(1, ...ends);
    const inner = width - MARGIN.left - MARGIN.right;
    const place = (time_s) => MARGIN.left + (inner * time_s) / longest_s;
    const axis = {
      top: MARGIN.top,
      bottom: height - MARGIN.bottom,
      title: "seconds from the beginning of standing up",
      middle: MARGIN.left + inner / 2,
    };
    const ticks = ticksOf(0, longest_s, Math.max(3, Math.min(14, inner / 70)));
    return [...bottomAxis(ticks, place, axis), ...this.attempts.flatMap((each, row) => bar(each, row, place))];
  }

  dispose() {
    this.drawing.dispose();
  }
}

function bar({ attempt, from, phases }, row, place) {
  const y = MARGIN.top + row * (ROW.height + ROW.gap) + ROW.gap / 2;
  const parts = phases.filter((phase) => phase.end_s !== null).flatMap((phase) => part(phase, from, y, place));
  const edges = phases.filter((phase) => phase.end_std_s !== null).map((phase) => whisker(phase, from, y, place));
  return [text(0, y + ROW.height / 2 + 4, `Attempt ${attempt + 1}`, { fill: INK }), ...parts, ...edges];
}

function part(whole, from, y, place) {
  const { phase, start_s, end_s, duration_s } = whole;
  const [left, right] = [place(start_s - from), place(end_s - from)];
  const middle = (left + right) / 2;
  const box = { x: left + 1, y, width: Math.max(1, right - left - 2), height: ROW.height, rx: 5 };
  const paint = isGivenUp(whole) ? { fill: "none", stroke: INVALID, "stroke-dasharray": "4 3" } : {};
  const block = svg("rect", { ...box, fill: PHASE_COLOURS[phase], ...paint });
  const tip = svg("title");
  tip.append(`${PHASES[phase]}: ${number(duration_s, 2)} s`);
  block.append(tip);
  const place_ = { "text-anchor": "middle", fill: INK, "pointer-events": "none" };
  const roomy = right - left > ROOM_FOR_NAME_PX;
  const seconds = text(middle, y + (roomy ? 36 : 28), `${number(duration_s, 1)} s`, { ...place_, "font-weight": 650 });
  return roomy ? [block, text(middle, y + 18, PHASES[phase], place_), seconds] : [block, seconds];
}

/** Where the end of a part may be: one standard deviation either way. */
function whisker({ end_s, end_std_s }, from, y, place) {
  const [left, right] = [place(end_s - from - end_std_s), place(end_s - from + end_std_s)];
  const low = y + ROW.height + 3;
  return svg("path", {
    d: `M ${left} ${low - 3} v 6 M ${left} ${low} H ${right} M ${right} ${low - 3} v 6`,
    stroke: SOFT_INK,
  });
}

function inWords({ attempt, phases, from, to }) {
  const parts = phases
    .filter((phase) => phase.end_s !== null)
    .map((phase) => `${PHASES[phase.phase]} ${number(phase.duration_s, 1)} s`);
  const total = to === null ? "not done to the end" : `in all ${number(to - from, 1)} s`;
  return `Attempt ${attempt + 1}: ${parts.join(", ")}; ${total}.`;
}

/** Seconds and their standard deviation, a row per attempt; with several, `metrics` has their mean and its spread. */
export function phaseTable(attempts, metrics = []) {
  const names = Object.keys(PHASES);
  const rows = attempts.map(({ attempt, phases, from, to, spread_s, given_up }) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, `Attempt ${attempt + 1}`),
      ...names.map((name) => {
        const phase = phases.find((each) => each.phase === name);
        return seconds(phase?.duration_s ?? null, phase?.duration_std_s ?? null);
      }),
      given_up ? el("td", { class: "number quiet" }, "given up") : seconds(to === null ? null : to - from, spread_s),
    ),
  );
  const means = [...names.map((name) => `tug_${name}_time`), "tug_time"].map((name) =>
    metrics.find((metric) => metric.name === name && metric.spread !== null),
  );
  if (means.every(Boolean)) {
    const cells = means.map(({ value, spread }) => seconds(value, spread));
    rows.push(
      el("tr", { class: "mean-row" }, el("th", { scope: "row" }, `Mean of ${means[0].strides} attempts`), ...cells),
    );
  }
  const columns = ["", ...names.map((name) => `${PHASES[name]}#`), "Total#"];
  return table(columns, el("tbody", {}, ...rows));
}

function seconds(value, spread) {
  const deviation = spread === null ? "" : ` ± ${number(spread, 2)}`;
  return el("td", { class: "number" }, number(value, 2), el("span", { class: "quiet" }, deviation));
}
