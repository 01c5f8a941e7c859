// Repetitions of an exercise afterwards: a bar each from its least to its largest angle, and the same as a table.
import { el, svg, table } from "./dom.js";
import { Drawing, bottomAxis, leftAxis, ticksOf } from "./drawing.js";
import { INVALID, SIDE_COLOUR } from "./palette.js";
import { measuresOf } from "./repetition_counter.js";
import { degrees, number } from "./units.js";

const HEIGHT = 230;
const MARGIN = { left: 46, right: 14, top: 8, bottom: 42 };
const WIDEST_BAR_PX = 26;

/** The bars. Those that do not count are hollow. */
export class RepetitionChart {
  constructor(host, repetitions) {
    this.repetitions = repetitions;
    const largest = repetitions.map((each) => degrees(measuresOf(each).largest));
    const label = `Least and largest angle of ${repetitions.length} repetitions. Largest angle of each, in degrees: ${largest
      .map((each) => number(each, 0))
      .join(", ")}.`;
    this.drawing = new Drawing(host, { label, height: HEIGHT, draw: (width) => this.draw(width) });
  }

  draw(width) {
    const spans = this.repetitions.map((each) => [measuresOf(each).smallest, measuresOf(each).largest].map(degrees));
    const low = Math.min(0, 10 * Math.floor(Math.min(...spans.flat()) / 10));
    const high = Math.max(10, 10 * Math.ceil(Math.max(...spans.flat()) / 10));
    const [right, bottom] = [width - MARGIN.right, HEIGHT - MARGIN.bottom];
    const step = (right - MARGIN.left) / this.repetitions.length;
    const across = (count) => MARGIN.left + step * (count - 0.5);
    const up = (value) => bottom - ((value - low) / (high - low)) * (bottom - MARGIN.top);
    const counts = ticksOf(1, this.repetitions.length, Math.min(14, this.repetitions.length)).filter(Number.isInteger);
    return [
      ...leftAxis(ticksOf(low, high, 7), up, {
        left: MARGIN.left,
        right,
        title: "degrees",
        middle: (MARGIN.top + bottom) / 2,
      }),
      ...bottomAxis(counts, across, {
        top: bottom,
        bottom,
        title: "repetition",
        middle: (MARGIN.left + right) / 2,
      }),
      ...this.repetitions.map((each, place) => {
        const bar = Math.min(WIDEST_BAR_PX, 0.62 * step);
        const [least, largest] = spans[place];
        const paint = each.valid
          ? { fill: SIDE_COLOUR[each.side], "fill-opacity": 0.75 }
          : { fill: "none", stroke: INVALID, "stroke-width": 2 };
        const box = {
          x: across(place + 1) - bar / 2,
          y: up(largest),
          width: bar,
          height: up(least) - up(largest),
          rx: 3,
        };
        return svg("rect", { ...box, ...paint });
      }),
    ];
  }

  dispose() {
    this.drawing.dispose();
  }
}

/** Angles and times of each repetition. */
export function repetitionTable(repetitions) {
  const bothSides = new Set(repetitions.map((each) => each.side)).size > 1;
  const rows = repetitions.map((each, place) => {
    const { range, largest, smallest, flexing_s, extending_s } = measuresOf(each);
    const side = each.side === "left" ? "Left" : "Right";
    return el(
      "tr",
      {},
      el("th", { scope: "row" }, String(place + 1)),
      bothSides ? el("td", { class: each.side }, side) : null,
      ...[range, largest, smallest].map((angle) => cell(`${number(degrees(angle), 0)}°`)),
      ...[flexing_s, extending_s].map((time_s) => cell(`${number(time_s, 1)} s`)),
      el("td", { class: "quiet" }, each.valid ? "" : `does not count: ${each.rejected_because ?? "not known"}`),
    );
  });
  const columns = ["", ...(bothSides ? ["Side"] : []), "Range#", "Largest#", "Least#", "Flexing#", "Extending#", ""];
  return table(columns, el("tbody", {}, ...rows));
}

const cell = (words) => el("td", { class: "number" }, words);
