// Repetitions of an exercise afterwards: a bar each from its least to its largest angle, and the same as a table.
import { el, svg, table } from "./dom.js";
import { Drawing, bottomAxis, leftAxis, ticksOf } from "./drawing.js";
import { INVALID, PELVIS, SIDE_COLOUR } from "./palette.js";
import { measuresOf } from "./repetition_counter.js";
import { degrees, number } from "./units.js";
import { SIDES } from "./vectors.js";

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
    const slots = slotsOf(this.repetitions);
    const step = (right - MARGIN.left) / slots.count;
    const across = (count) => MARGIN.left + step * (count - 0.5);
    const up = (value) => bottom - ((value - low) / (high - low)) * (bottom - MARGIN.top);
    const counts = ticksOf(1, slots.count, Math.min(14, slots.count)).filter(Number.isInteger);
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
        const bar = Math.min(WIDEST_BAR_PX, (0.62 * step) / slots.beside);
        const [least, largest] = spans[place];
        const { slot, shift } = slots.places[place];
        const paint = each.valid
          ? { fill: SIDE_COLOUR[each.side] ?? PELVIS, "fill-opacity": 0.75 }
          : { fill: "none", stroke: INVALID, "stroke-width": 2 };
        const box = {
          x: across(slot) - bar / 2 + shift * (bar + 1.5),
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

/**
 * Where each repetition's bar stands: the n-th of the left side beside the n-th of the right. `slot` counts from one,
 * `shift` is in bars from the slot's middle; `count` slots, `beside` bars in each.
 */
export function slotsOf(repetitions) {
  const sides = SIDES.filter((side) => repetitions.some((each) => each.side === side));
  const beside = Math.max(1, sides.length);
  const counts = {};
  const places = repetitions.map(({ side }) => {
    counts[side] = (counts[side] ?? 0) + 1;
    return { slot: counts[side], shift: beside > 1 ? (side === "left" ? -0.5 : 0.5) : 0 };
  });
  return { count: Math.max(1, ...Object.values(counts)), beside, places };
}

/** Angles and times of each repetition of a movement of the whole body, both knees beside each other. */
export function movementTable(repetitions) {
  const sided = repetitions.some((each) => each.side !== null);
  const knees = sided ? [] : SIDES.filter((side) => repetitions.some((each) => `knee_flexion_${side}` in each.ranges));
  const rows = repetitions.map((each, place) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, String(place + 1)),
      sided ? el("td", { class: each.side }, each.side === "left" ? "Left" : "Right") : null,
      ...[measuresOf(each).range, each.turn_angle].map((value) => cell(angle(value))),
      ...[each.turn_s - each.start_s, each.hold_s, each.end_s - each.turn_s].map((time_s) => cell(seconds(time_s))),
      ...knees.map((side) => cell(angle(each.ranges[`knee_flexion_${side}`]))),
      el("td", { class: "quiet" }, refusal(each)),
    ),
  );
  const kneeNames = knees.map((side) => `Knee ${side === "left" ? "L" : "R"}#`);
  const columns = ["", ...(sided ? ["Side"] : []), "Range#", "Farthest#", "There#", "Hold#", "Back#", ...kneeNames, ""];
  return table(columns, el("tbody", {}, ...rows));
}

const angle = (radians) => (radians === undefined ? "–" : `${number(degrees(radians), 0)}°`);
const seconds = (time_s) => (time_s === null ? "–" : `${number(time_s, 1)} s`);
const refusal = (each) => (each.valid ? "" : `does not count: ${each.rejected_because ?? "not known"}`);

/** Angles and times of each repetition of a knee. */
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
      ...[range, largest, smallest].map((value) => cell(angle(value))),
      ...[flexing_s, extending_s].map((time_s) => cell(`${number(time_s, 1)} s`)),
      el("td", { class: "quiet" }, refusal(each)),
    );
  });
  const columns = ["", ...(bothSides ? ["Side"] : []), "Range#", "Largest#", "Least#", "Flexing#", "Extending#", ""];
  return table(columns, el("tbody", {}, ...rows));
}

const cell = (words) => el("td", { class: "number" }, words);
