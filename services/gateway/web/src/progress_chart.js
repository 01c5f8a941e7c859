// One measure over the visits: reference, baseline and its MDC band, 95 % intervals, treatments; a triangle only for a real change.
import { svg } from "./dom.js";
import { Drawing, leftAxis, text, ticksOf } from "./drawing.js";
import { CHANGE_BAND, INK, INVALID, PANEL, PELVIS, REFERENCE_BAND, SIDE_COLOUR, SIDE_DASH } from "./palette.js";

const HEIGHT = 168;
const MARGIN = { left: 42, right: 20, top: 16, bottom: 26 };
const MARK = 5;
const LETTERS = { left: "L", right: "R" };

/**
 * @typedef {{number: number, value: number, low: number|null, high: number|null, baseline: boolean, real: -1|0|1,
 *   counts: boolean}} Mark in shown units; `real` is the way of a real change, 0 for none or where nobody can tell
 * @typedef {{side: "left"|"right"|null, marks: Mark[], baseline: number|null, mdc: number|null}} Line
 */
export class ProgressChart {
  /**
   * @param {HTMLElement} host
   * @param {{lines: Line[], treatments: {at: number, letter: string}[], reference: {low: number, high: number}|null,
   *   label: string}} content
   */
  constructor(host, content) {
    this.content = content;
    this.drawing = new Drawing(host, { label: content.label, height: HEIGHT, draw: (width) => this.draw(width) });
  }

  draw(width) {
    const { lines, treatments, reference } = this.content;
    const numbers = [...new Set(lines.flatMap((line) => line.marks.map((mark) => mark.number)))].sort((a, b) => a - b);
    const [first, last] = [numbers[0] - 0.4, Math.max(numbers.at(-1), numbers[0] + 1) + 0.4];
    const [low, high] = spanOf(lines, reference);
    const [right, bottom] = [width - MARGIN.right, HEIGHT - MARGIN.bottom];
    const across = (visit) => MARGIN.left + ((visit - first) / (last - first)) * (right - MARGIN.left);
    const up = (value) => bottom - ((value - low) / (high - low)) * (bottom - MARGIN.top);
    const place = { left: MARGIN.left, right, top: MARGIN.top, bottom, across, up };
    return [
      ...(reference ? [referenceBand(reference, place)] : []),
      ...lines.flatMap((line) => band(line, place, lines.length === 1)),
      ...leftAxis(ticksOf(low, high, 4), up, { left: MARGIN.left, right, title: "", middle: 0 }),
      ...numbers.map((visit) => text(across(visit), HEIGHT - 8, String(visit), { "text-anchor": "middle" })),
      text(0, HEIGHT - 8, "Visit"),
      ...treatments.flatMap(({ at, letter }) => treatment(across(Math.min(last, Math.max(first, at))), letter, place)),
      ...lines.flatMap((line) => curve(line, place)),
    ];
  }

  dispose() {
    this.drawing.dispose();
  }
}

/** From the least to the largest of what is drawn, with some room; never nothing. */
export function spanOf(lines, reference = null) {
  const values = lines.flatMap(({ marks, baseline, mdc }) => [
    ...marks.flatMap(({ value, low, high }) => [value, low, high]),
    ...(baseline !== null && mdc !== null ? [baseline - mdc, baseline + mdc] : []),
  ]);
  const known = [...values, ...(reference ? [reference.low, reference.high] : [])].filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const room = Math.max(0.08 * (high - low), 0.02 * Math.abs(high)) || 0.5;
  return [low - room, high + room];
}

const colourOf = (side) => SIDE_COLOUR[side] ?? PELVIS;

function referenceBand({ low, high }, { left, right, up }) {
  const box = { x: left, y: up(high), width: right - left, height: up(low) - up(high) };
  return svg("rect", { ...box, fill: REFERENCE_BAND, opacity: 0.55, class: "reference-band" });
}

function band({ side, baseline, mdc }, { left, right, up }, filled) {
  if (baseline === null) return [];
  const across = { x1: left, x2: right, stroke: colourOf(side) };
  const nodes = [svg("line", { ...across, y1: up(baseline), y2: up(baseline), "stroke-dasharray": "5 3" })];
  if (mdc === null) return nodes;
  const [top, bottom] = [up(baseline + mdc), up(baseline - mdc)];
  const edges = [top, bottom].map((y) => svg("line", { ...across, y1: y, y2: y, "stroke-width": 0.6 }));
  const box = { x: left, y: top, width: right - left, height: bottom - top, fill: CHANGE_BAND };
  return [...(filled ? [svg("rect", box)] : []), ...edges, ...nodes];
}

function treatment(x, letter, { top, bottom }) {
  const line = svg("line", { x1: x, x2: x, y1: top, y2: bottom, stroke: INVALID, "stroke-dasharray": "3 3" });
  return [line, text(x, top - 4, letter, { "text-anchor": "middle", "font-weight": 650 })];
}

function curve({ side, marks }, { right, across, up }) {
  const stroke = colourOf(side);
  const counted = marks.filter((mark) => mark.counts);
  const points = counted.map(({ number: visit, value }) => `${across(visit)},${up(value)}`).join(" ");
  const dash = SIDE_DASH[side]?.join(" ");
  const last = marks.at(-1);
  return [
    svg("polyline", { points, fill: "none", stroke, "stroke-width": 1.6, "stroke-dasharray": dash }),
    ...marks.filter(({ low, high }) => low !== null && high !== null).map(({ number: visit, low, high }) =>
      svg("line", { x1: across(visit), x2: across(visit), y1: up(low), y2: up(high), stroke, "stroke-width": 1.4 }),
    ),
    ...marks.map((mark) => sign(mark, across(mark.number), up(mark.value), stroke)),
    ...(side && last ? [text(right + 5, up(last.value) + 4, LETTERS[side], { fill: stroke, "font-weight": 650 })] : []),
  ];
}

function sign({ baseline, real, counts }, x, y, colour) {
  if (real !== 0) {
    const [tip, base] = [y - real * (MARK + 2), y + real * MARK];
    return svg("polygon", { points: `${x},${tip} ${x + MARK + 1},${base} ${x - MARK - 1},${base}`, fill: INK });
  }
  const box = { x: x - MARK + 1, y: y - MARK + 1, width: 2 * MARK - 2, height: 2 * MARK - 2 };
  if (baseline) return svg("rect", { ...box, fill: PANEL, stroke: colour, "stroke-width": 1.6 });
  const dot = { cx: x, cy: y, r: MARK - 1.5 };
  return svg("circle", counts ? { ...dot, fill: colour } : { ...dot, fill: PANEL, stroke: INVALID, "stroke-width": 1.6 });
}
