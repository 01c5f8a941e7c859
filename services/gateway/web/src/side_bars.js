// The same range of both sides beside each other: bars of equal scale, and how much they differ.
import { el, say } from "./dom.js";
import { degrees, number } from "./units.js";
import { SIDES } from "./vectors.js";
import { angleTitle } from "./words.js";

export class SideBars {
  /** `joint` is what is compared. */
  constructor(joint) {
    this.joint = joint;
    this.seen = {};
    this.bars = SIDES.map((side) => {
      const bar = el("span", { class: `bar ${side}` });
      const value = el("b", { class: side }, "–");
      const name = el("span", { class: "quiet" }, side === "left" ? "Left" : "Right");
      return { side, bar, value, node: el("div", { class: "side-bar" }, name, el("span", { class: "track" }, bar), value) };
    });
    this.difference = el("span", { class: "quiet" });
    this.node = el(
      "div",
      { class: "side-bars" },
      el(
        "div",
        { class: "panel-head" },
        el("span", { class: "quiet" }, `${angleTitle(joint)}, last range`),
        el("span", { class: "spring" }),
        this.difference,
      ),
      ...this.bars.map(({ node }) => node),
    );
  }

  /** A repetition of both sides tells each by its range, one of a side tells that side. */
  add({ ranges, side, range }) {
    if (side !== null) this.seen[side] = range;
    else for (const one of SIDES) this.seen[one] = ranges[`${this.joint}_${one}`] ?? this.seen[one];
    const largest = Math.max(0.01, ...Object.values(this.seen).filter((range) => range !== undefined));
    for (const { side: one, bar, value } of this.bars) {
      const known = this.seen[one];
      bar.style.width = `${known === undefined ? 0 : (100 * known) / largest}%`;
      say(value, known === undefined ? "–" : `${number(degrees(known), 0)}°`);
    }
    const { left, right } = this.seen;
    const both = left !== undefined && right !== undefined;
    say(this.difference, both ? `differ by ${number(Math.abs(degrees(left - right)), 0)}°` : "");
  }
}
