// A joint's rolling curve with its newest angles above it.
import { RollingChart } from "./charts.js";
import { el, say } from "./dom.js";
import { SIDES } from "./figure.js";
import { degrees, number } from "./units.js";

export class ChartPanel {
  constructor({ joint, title, range }) {
    this.joint = joint;
    this.range = range;
    this.now = Object.fromEntries(SIDES.map((side) => [side, el("b", { class: side })]));
    this.host = el("div", { class: "chart" });
    this.node = el(
      "section",
      { class: "panel chart-panel", "aria-label": title },
      el(
        "div",
        { class: "panel-head" },
        el("h2", {}, title),
        el("span", { class: "spring" }),
        ...Object.values(this.now),
      ),
      this.host,
    );
  }

  start() {
    this.rolling = new RollingChart(this.host, this.joint, this.range);
  }

  /** Name these sides only. */
  only(sides) {
    for (const side of SIDES) this.now[side].hidden = !sides.includes(side);
  }

  add(pose, trail) {
    this.rolling.add([...trail, pose]);
    for (const side of SIDES) {
      const value = degrees(pose.angles[`${this.joint}_${side}`]);
      say(this.now[side], `${side === "left" ? "L" : "R"} ${number(value, 0)}${value === null ? "" : "°"}`);
    }
  }

  dispose() {
    this.rolling.dispose();
  }
}
