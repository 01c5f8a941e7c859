// The angle of a knee, to be read from three metres, and the range that it has covered so far.
import { el, say, svg } from "./dom.js";
import { GRID, INK, SIDE_COLOUR, faint } from "./palette.js";
import { degrees, number } from "./units.js";

const SCALE = { low: -20, high: 150, width: 430, height: 34 };
const TICKS = [0, 30, 60, 90, 120];

export class KneePanel {
  constructor(sides) {
    this.readouts = sides.map((side) => new Readout(side, sides.length > 1));
    this.node = el(
      "section",
      { class: "panel knee-panel", "aria-label": "Knee angle" },
      ...this.readouts.map((readout) => readout.node),
    );
  }

  add(pose, trail) {
    for (const readout of this.readouts) readout.add(pose, trail);
  }

  tick(stale) {
    this.node.classList.toggle("stale", stale);
  }
}

/** Least and largest of a knee's valid angles, in rad. */
export class Range {
  constructor() {
    this.reset();
  }

  reset() {
    this.least = null;
    this.largest = null;
  }

  add(angle) {
    if (angle === undefined || angle === null) return;
    this.least = this.least === null ? angle : Math.min(this.least, angle);
    this.largest = this.largest === null ? angle : Math.max(this.largest, angle);
  }
}

class Readout {
  constructor(side, named) {
    this.name = `knee_flexion_${side}`;
    this.range = new Range();
    this.value = el("output", { class: `knee-now ${side}` }, "–");
    this.spread = el("span", { class: "knee-spread quiet" });
    this.cells = { least: el("dd"), largest: el("dd"), covered: el("dd") };
    const again = { class: "quiet-button", type: "button", onclick: () => this.again() };
    this.scale = new Scale(side, named ? 15 : 11);
    this.node = el(
      "div",
      { class: "readout" },
      el(
        "div",
        { class: "panel-head" },
        el("h2", {}, `${side === "left" ? "Left" : "Right"} knee flexion`),
        el("span", { class: "spring" }),
        this.spread,
      ),
      el("div", { class: named ? "knee-row narrow" : "knee-row" }, this.value, this.facts(again)),
      this.scale.node,
    );
  }

  facts(again) {
    return el(
      "div",
      { class: "knee-facts" },
      el(
        "dl",
        {},
        fact("Least", this.cells.least),
        fact("Largest", this.cells.largest),
        fact("Range", this.cells.covered),
      ),
      el("button", again, "Start range anew"),
    );
  }

  add(pose, trail) {
    for (const each of [...trail, pose]) this.range.add(each.angles[this.name]);
    const value = degrees(pose.angles[this.name]);
    const spread = degrees(pose.angles_std[this.name]);
    say(this.value, shownDegrees(value));
    say(this.spread, spread === null ? "not known now" : `± ${number(2 * spread, 1)}° (2 SD)`);
    this.showRange(value);
  }

  showRange(value) {
    const [least, largest] = [degrees(this.range.least), degrees(this.range.largest)];
    say(this.cells.least, shownDegrees(least));
    say(this.cells.largest, shownDegrees(largest));
    say(this.cells.covered, shownDegrees(least === null ? null : largest - least));
    this.scale.show(value, least, largest);
  }

  again() {
    this.range.reset();
    this.showRange(null);
  }
}

const shownDegrees = (value) => (value === null ? "–" : `${number(value, 0)}°`);
const fact = (name, value) => el("div", {}, el("dt", {}, name), value);

/** A ruler in degrees: the range covered, and where the knee is now. Says nothing that the numbers do not say. */
class Scale {
  constructor(side, letters) {
    const { width, height } = SCALE;
    this.covered = svg("rect", { y: 2, height: 9, rx: 4, fill: faint(SIDE_COLOUR[side], 0.55), visibility: "hidden" });
    const mark = { fill: SIDE_COLOUR[side], stroke: "#fff", "stroke-width": 2, visibility: "hidden" };
    this.now = svg("circle", { cy: 6.5, r: 7.5, ...mark });
    const ticks = TICKS.flatMap((tick) => {
      const label = svg("text", {
        x: place(tick),
        y: 17 + letters,
        "text-anchor": "middle",
        "font-size": letters,
        fill: INK,
      });
      label.append(`${tick}°`);
      return [svg("line", { x1: place(tick), x2: place(tick), y1: 12, y2: 17, stroke: INK, opacity: 0.5 }), label];
    });
    const ground = svg("rect", { x: 0, y: 2, width, height: 9, rx: 4, fill: GRID });
    const size = { viewBox: `0 -3 ${width} ${height + 3}`, class: "knee-scale", "aria-hidden": "true" };
    this.node = svg("svg", size, ground, this.covered, ...ticks, this.now);
  }

  show(value, least, largest) {
    this.covered.setAttribute("visibility", least === null ? "hidden" : "visible");
    this.now.setAttribute("visibility", value === null ? "hidden" : "visible");
    if (least !== null) {
      this.covered.setAttribute("x", String(place(least)));
      this.covered.setAttribute("width", String(Math.max(2, place(largest) - place(least))));
    }
    if (value !== null) this.now.setAttribute("cx", String(place(value)));
  }
}

function place(angle) {
  const share = (angle - SCALE.low) / (SCALE.high - SCALE.low);
  return SCALE.width * Math.min(1, Math.max(0, share));
}
