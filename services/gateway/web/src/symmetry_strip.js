// Stride by stride: how long each step took, and how equal they are, against a zone to aim at.
import { el, say, svg } from "./dom.js";
import { GRID, INK, SIDE_COLOUR, SOFT_INK } from "./palette.js";
import { number } from "./units.js";
import { SIDES } from "./vectors.js";

const BAR = { width: 240, height: 30 };
/** Natural logarithm of left / right at the ends of the bar. */
const REACH = Math.log(1.6);
/** A setting to aim at, not a boundary between health and illness: 10 % to either side. */
const ZONE = Math.log(1.1);
const KEPT = 8;

export class SymmetryStrip {
  /** @param {string|null|undefined} paretic side, as the session's conditions say */
  constructor(paretic) {
    this.paretic = paretic ?? null;
    /** @type {Record<string, any>} */
    this.newest = {};
    /** @type {number[]} */
    this.ratios = [];
    this.times = Object.fromEntries(SIDES.map((side) => [side, el("b", { class: side }, "–")]));
    this.bar = svg("svg", { viewBox: `0 0 ${BAR.width} ${BAR.height}`, role: "img", "aria-label": "No steps yet" });
    this.dots = svg("g");
    this.bar.append(
      svg("rect", { x: 0, y: 11, width: BAR.width, height: 8, rx: 4, fill: GRID }),
      svg("rect", { x: place(ZONE), y: 5, width: place(-ZONE) - place(ZONE), height: 20, rx: 5, fill: "#BFE0CC" }),
      svg("line", { x1: place(0), x2: place(0), y1: 3, y2: 27, stroke: SOFT_INK, "stroke-dasharray": "3 3" }),
      this.dots,
    );
    this.said = el("p", { class: "quiet" }, "Target zone: steps within 10 % of each other");
    this.node = el(
      "div",
      { class: "symmetry", role: "group", "aria-label": "Step time" },
      el("div", { class: "symmetry-row" }, this.times.left, el("span", {}, "Step time"), this.times.right),
      this.bar,
      this.said,
    );
  }

  /** @param {any} stride */
  onStride(stride) {
    if (stride.step_time_s === null) return;
    this.newest[stride.side] = stride;
    say(this.times[stride.side], `${stride.side === "left" ? "L" : "R"} ${number(stride.step_time_s, 2)} s`);
    const { left, right } = this.newest;
    if (!left || !right || !stride.valid) return;
    this.ratios = [...this.ratios, Math.log(left.step_time_s / right.step_time_s)].slice(-KEPT);
    this.draw();
    const { name, value } = ratioOf(left.step_time_s, right.step_time_s, this.paretic);
    const inside = Math.abs(this.ratios.at(-1)) <= ZONE;
    const words = `Step time ${name} ${number(value, 2)}, ${inside ? "within" : "outside"} the target zone (10 % of each other)`;
    say(this.said, words);
    this.bar.setAttribute("aria-label", words);
  }

  draw() {
    const last = this.ratios.length - 1;
    const dots = this.ratios.map((ratio, at) => {
      const cx = place(ratio);
      if (at === last) return svg("circle", { cx, cy: 15, r: 7, fill: INK });
      return svg("circle", { cx, cy: 15, r: 4, fill: ratio > 0 ? SIDE_COLOUR.left : SIDE_COLOUR.right, opacity: 0.35 });
    });
    this.dots.replaceChildren(...dots);
  }

  /** @param {boolean} stale */
  tick(stale) {
    this.node.classList.toggle("stale", stale);
  }
}

/** The longer left step is to the left, beside its number. @param {number} logarithm of left / right */
function place(logarithm) {
  const share = Math.min(1, Math.max(-1, logarithm / REACH));
  return BAR.width / 2 - (share * (BAR.width - 16)) / 2;
}

/**
 * Symmetry ratio: paretic / non-paretic where a side is declared, else larger / smaller, named as such.
 * @param {number} left @param {number} right @param {string|null} paretic
 */
export function ratioOf(left, right, paretic) {
  if (paretic === "left") return { name: "paretic / non-paretic", value: left / right };
  if (paretic === "right") return { name: "paretic / non-paretic", value: right / left };
  return { name: "larger / smaller", value: Math.max(left, right) / Math.min(left, right) };
}
