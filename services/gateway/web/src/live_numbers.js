// The numbers of a running session: the last stride of each side, and the session so far.
import { el, say } from "./dom.js";
import { number } from "./units.js";

const LONGEST_STRIDE_S = 3;

const PER_SIDE = [
  { name: "Step length", unit: "m", bothLegs: true, of: (stride) => stride.step_length_m, digits: 2 },
  {
    name: "Stance",
    unit: "%",
    of: (stride) => (stride.stance_fraction === null ? null : 100 * stride.stance_fraction),
    digits: 0,
  },
  { name: "Stride time", unit: "s", of: (stride) => stride.stride_time_s, digits: 2 },
  { name: "Strides", unit: "", of: (stride) => stride.index + 1, digits: 0 },
];

export class LiveNumbers {
  constructor() {
    this.newest = {};
    this.speed = tile("Speed", "m/s");
    this.cadence = tile("Cadence", "steps/min");
    this.cells = PER_SIDE.map((row) => ({
      ...row,
      left: el("td", { class: "number" }, "–"),
      right: el("td", { class: "number" }, "–"),
      node: el("tr"),
    }));
    this.heads = {
      left: el("th", { scope: "col", class: "number left" }, "Left"),
      right: el("th", { scope: "col", class: "number right" }, "Right"),
    };
    const head = el("tr", {}, el("th", { scope: "col" }, "Last stride"), this.heads.left, this.heads.right);
    const rows = this.cells.map((row) => {
      const unit = row.unit ? el("span", { class: "unit" }, ` ${row.unit}`) : null;
      row.node.append(el("th", { scope: "row" }, row.name, unit), row.left, row.right);
      return row.node;
    });
    this.node = el(
      "div",
      { class: "numbers" },
      el("div", { class: "tiles" }, this.speed.node, this.cadence.node),
      el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows)),
    );
  }

  /** Legs alone: what needs the other leg or the pelvis is not shown, nor a leg that is not worn. */
  only(sides) {
    const both = sides.length === 2;
    this.speed.node.hidden = !both;
    for (const side of ["left", "right"]) this.heads[side].hidden = !sides.includes(side);
    for (const row of this.cells) {
      row.node.hidden = Boolean(row.bothLegs) && !both;
      for (const side of ["left", "right"]) row[side].hidden = !sides.includes(side);
    }
  }

  /** On the spot: nobody gets anywhere, so there is neither a speed nor a length. */
  onTheSpot() {
    this.speed.node.hidden = true;
    for (const row of this.cells) if (row.unit === "m") row.node.hidden = true;
  }

  onPose(pose) {
    this.at = pose.at_s;
    say(this.cadence.value, number(pose.cadence_per_min, 0));
  }

  onStride(stride) {
    this.newest[stride.side] = stride;
    if (stride.walking_speed !== null) say(this.speed.value, number(stride.walking_speed, 2));
    for (const row of this.cells) say(row[stride.side], number(row.of(stride), row.digits));
  }

  onMetrics(metrics) {
    const speed = metrics.metrics.find((metric) => metric.name === "walking_speed" && metric.side === null);
    say(this.speed.note, speed && speed.value !== null ? `session ${number(speed.value, 2)}` : "");
  }

  /** Grey what is not of now: everything without data, and a side that has not stepped for a while. */
  tick(stale) {
    this.node.classList.toggle("stale", stale);
    let anyFresh = false;
    for (const side of ["left", "right"]) {
      const stride = this.newest[side];
      const old = stale || !stride || this.at - stride.end_s > LONGEST_STRIDE_S;
      anyFresh ||= !old;
      for (const row of this.cells) row[side].classList.toggle("stale", old);
    }
    this.speed.node.classList.toggle("stale", !anyFresh);
  }
}

function tile(name, unit) {
  const value = el("span", { class: "value" }, "–");
  const note = el("span", { class: "quiet" });
  return {
    value,
    note,
    node: el(
      "div",
      { class: "tile" },
      el("span", { class: "name" }, name),
      el("span", {}, value, el("span", { class: "unit" }, ` ${unit}`)),
      note,
    ),
  };
}
