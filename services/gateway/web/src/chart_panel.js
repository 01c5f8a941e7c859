// A joint's rolling curve with its newest angles above it.
import { RollingChart, angleName } from "./charts.js";
import { el, say } from "./dom.js";
import { SIDES } from "./vectors.js";
import { degrees, number } from "./units.js";

const BAND =
  "The band is two standard deviations to either side of the estimate. Ticks below: contact of a foot with its letter, toe-off dotted.";

export class ChartPanel {
  constructor({ joint, title, range, sides = SIDES }) {
    this.joint = joint;
    this.range = range;
    this.sides = sides;
    this.now = sides.map((side) => el("b", { class: side }));
    this.host = el("div", { class: "chart" });
    this.node = el(
      "section",
      { class: "panel chart-panel", "aria-label": title },
      el(
        "div",
        { class: "panel-head" },
        el("h2", {}, title),
        el("span", { class: "quiet", title: BAND }, "± 2 SD"),
        el("span", { class: "spring" }),
        ...this.now,
      ),
      this.host,
    );
  }

  start() {
    this.rolling = new RollingChart(this.host, this.joint, this.range, this.sides);
  }

  add(pose, trail) {
    this.rolling.add([...trail, pose]);
    this.sides.forEach((side, place) => {
      const value = degrees(pose.angles[angleName(this.joint, side)]);
      const letter = side === null ? "" : side === "left" ? "L " : "R ";
      say(this.now[place], `${letter}${number(value, 0)}${value === null ? "" : "°"}`);
    });
  }

  dispose() {
    this.rolling.dispose();
  }
}
