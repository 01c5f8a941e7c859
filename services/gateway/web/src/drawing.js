// Drawings of a report: as wide as their place, with units on the axes and the same said in words.
import { svg } from "./dom.js";
import { GRID, SOFT_INK } from "./palette.js";
import { number } from "./units.js";

/** Draws anew whenever the host's width changes. `draw` takes the width in px and gives the nodes; `height` is fixed. */
export class Drawing {
  constructor(host, { label, height, draw }) {
    this.root = svg("svg", { role: "img", "aria-label": label, height, class: "drawing" });
    host.append(this.root);
    this.observer = new ResizeObserver(() => {
      const width = host.clientWidth;
      if (width === 0) return;
      this.root.setAttribute("width", width);
      this.root.setAttribute("viewBox", `0 0 ${width} ${height}`);
      this.root.replaceChildren(...draw(width));
    });
    this.observer.observe(host);
  }

  dispose() {
    this.observer.disconnect();
  }
}

/** Round values that divide a span into about `count` parts. */
export function ticksOf(low, high, count) {
  const rough = Math.max(1e-9, high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= rough);
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.floor(high / step + 1e-9) - first + 1 }, (_, i) => (first + i) * step);
}

/** Decimals that tell round values apart. */
export const digitsOf = ([first, second]) =>
  second === undefined ? 0 : Math.max(0, -Math.floor(Math.log10(second - first) + 1e-9));

export function text(x, y, words, attributes = {}) {
  const node = svg("text", { x, y, "font-size": 12, fill: SOFT_INK, ...attributes });
  node.append(words);
  return node;
}

/** Grid lines across and numbers below, at `place(value)`. */
export function bottomAxis(values, place, { top, bottom, title, middle }) {
  return [
    ...values.flatMap((value) => [
      svg("line", { x1: place(value), x2: place(value), y1: top, y2: bottom, stroke: GRID }),
      text(place(value), bottom + 16, number(value, Number.isInteger(value) ? 0 : 1), { "text-anchor": "middle" }),
    ]),
    text(middle, bottom + 34, title, { "text-anchor": "middle" }),
  ];
}

/** Grid lines along and numbers at the left. */
export function leftAxis(values, place, { left, right, title, middle }) {
  return [
    ...values.flatMap((value) => [
      svg("line", { x1: left, x2: right, y1: place(value), y2: place(value), stroke: GRID }),
      text(left - 7, place(value) + 4, number(value, digitsOf(values)), { "text-anchor": "end" }),
    ]),
    text(0, 0, title, { "text-anchor": "middle", transform: `translate(11 ${middle}) rotate(-90)` }),
  ];
}
