// An exercise as it is done: how many, how far the last one went, how fast.
import { el, say } from "./dom.js";
import { degrees, number } from "./units.js";
import { jointName } from "./words.js";

const LONGEST_PAUSE_S = 10;

export class RepetitionCounter {
  constructor() {
    this.newest = new Map();
    this.count = el("output", { class: "count", "aria-live": "polite" }, "0");
    this.name = el("span", { class: "quiet" });
    this.cells = { range: el("dd"), peak: el("dd"), flexing: el("dd"), extending: el("dd"), tempo: el("dd") };
    this.refused = el("p", { class: "quiet" });
    this.node = el(
      "section",
      { class: "panel counter", "aria-label": "Repetitions", hidden: true },
      el("div", { class: "panel-head" }, el("h2", {}, "Repetitions"), el("span", { class: "spring" }), this.name),
      el(
        "div",
        { class: "counter-row" },
        this.count,
        el(
          "dl",
          {},
          fact("Last range", this.cells.range),
          fact("Largest angle", this.cells.peak),
          fact("Flexing", this.cells.flexing),
          fact("Extending", this.cells.extending),
          fact("Tempo", this.cells.tempo),
        ),
      ),
      this.refused,
    );
    for (const cell of Object.values(this.cells)) say(cell, "–");
  }

  onRepetition(repetition) {
    this.node.hidden = false;
    const before = this.newest.get(repetition.degree_of_freedom);
    this.newest.set(repetition.degree_of_freedom, repetition);
    const [joint, side] = jointName(repetition.degree_of_freedom);
    say(this.name, side ? `${joint}, ${side}` : joint);
    say(this.count, String([...this.newest.values()].reduce((sum, each) => sum + each.index + 1, 0)));
    const { range, largest, flexing_s, extending_s } = measuresOf(repetition);
    say(this.cells.range, angle(range));
    say(this.cells.peak, angle(largest));
    say(this.cells.tempo, tempo(before, repetition));
    say(this.cells.flexing, `${number(flexing_s, 1)} s`);
    say(this.cells.extending, `${number(extending_s, 1)} s`);
    say(this.refused, repetition.valid ? "" : `Does not count: ${repetition.rejected_because ?? "not known"}`);
  }
}

const angle = (radians) => `${number(degrees(radians), 0)}°`;

/** From start to start, as metrics do; a rest between sets is no tempo. */
function tempo(before, repetition) {
  const follows = before?.index === repetition.index - 1 && repetition.start_s - before.end_s < LONGEST_PAUSE_S;
  return follows ? `${number(60 / (repetition.start_s - before.start_s), 0)} /min` : "–";
}

const fact = (name, value) => el("div", {}, el("dt", {}, name), value);

/** Least and largest angle of a repetition, what lies between them, and the time of each way; rad and s. */
export function measuresOf({ start_angle, turn_angle, end_angle, start_s, turn_s, end_s }) {
  const angles = [start_angle, turn_angle, end_angle];
  const [smallest, largest] = [Math.min(...angles), Math.max(...angles)];
  const ways = [turn_s - start_s, end_s - turn_s];
  const [flexing_s, extending_s] = 2 * turn_angle > start_angle + end_angle ? ways : ways.toReversed();
  return { smallest, largest, range: largest - smallest, flexing_s, extending_s };
}
