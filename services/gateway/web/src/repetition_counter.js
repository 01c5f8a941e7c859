// An exercise as it is done: how many, how far the last one went, how fast, and how equal the sides are.
import { el, fill, say } from "./dom.js";
import { SideBars } from "./side_bars.js";
import { degrees, number } from "./units.js";
import { SIDES } from "./vectors.js";
import { angleTitle, jointName } from "./words.js";

const LONGEST_PAUSE_S = 10;

export class RepetitionCounter {
  constructor() {
    this.newest = new Map();
    this.count = el("output", { class: "count", "aria-live": "polite" }, "0");
    this.name = el("span", { class: "quiet" });
    /** @type {Record<string, HTMLElement>} */
    this.cells = { range: el("dd"), peak: el("dd"), flexing: el("dd"), extending: el("dd"), tempo: el("dd") };
    this.facts = el(
      "dl",
      {},
      fact("Last range", this.cells.range),
      fact("Largest angle", this.cells.peak),
      fact("Flexing", this.cells.flexing),
      fact("Extending", this.cells.extending),
      fact("Tempo", this.cells.tempo),
    );
    this.refused = el("p", { class: "quiet" });
    this.node = el(
      "section",
      { class: "panel counter", "aria-label": "Repetitions", hidden: true },
      el("div", { class: "panel-head" }, el("h2", {}, "Repetitions"), el("span", { class: "spring" }), this.name),
      el("div", { class: "counter-row" }, this.count, this.facts),
      this.refused,
    );
    for (const cell of Object.values(this.cells)) say(cell, "–");
  }

  /** For exercises of the whole body: there, hold and back instead of flexing and extending, and both sides. */
  showWholeBody({ compared }) {
    this.cells = { range: el("dd"), hold: el("dd"), there: el("dd"), back: el("dd"), tempo: el("dd"), each: el("dd") };
    fill(
      this.facts,
      fact("Last range", this.cells.range),
      fact("Hold", this.cells.hold),
      fact("There", this.cells.there),
      fact("Back", this.cells.back),
      fact("Tempo", this.cells.tempo),
      (this.eachSide = fact("Left / right", this.cells.each)),
    );
    this.eachSide.hidden = true;
    for (const cell of Object.values(this.cells)) say(cell, "–");
    this.bars = compared && new SideBars(compared);
    if (this.bars) this.refused.before(this.bars.node);
  }

  onRepetition(repetition) {
    this.node.hidden = false;
    const { degree_of_freedom, side } = repetition;
    const movement = `${degree_of_freedom} ${side}`;
    const before = this.newest.get(movement);
    this.newest.set(movement, repetition);
    say(this.name, side ? `${jointName(degree_of_freedom)[0]}, ${side}` : angleTitle(degree_of_freedom));
    say(this.count, String([...this.newest.values()].reduce((sum, each) => sum + each.index + 1, 0)));
    const measures = measuresOf(repetition);
    this.tell({
      range: angle(measures.range),
      peak: angle(measures.largest),
      tempo: tempo(before, repetition),
      flexing: seconds(measures.flexing_s),
      extending: seconds(measures.extending_s),
      there: seconds(repetition.turn_s - repetition.start_s),
      back: seconds(repetition.end_s - repetition.turn_s),
      hold: seconds(repetition.hold_s),
      each: SIDES.map((one) => this.countOf(one)).join(" / "),
    });
    if (this.eachSide) this.eachSide.hidden = repetition.side === null;
    this.bars?.add({ ...repetition, range: measures.range });
    say(this.refused, repetition.valid ? "" : `Does not count: ${repetition.rejected_because ?? "not known"}`);
  }

  tell(texts) {
    for (const [name, cell] of Object.entries(this.cells)) say(cell, texts[name]);
  }

  countOf(side) {
    const own = [...this.newest.values()].filter((each) => each.side === side);
    return own.reduce((sum, each) => sum + each.index + 1, 0);
  }
}

const seconds = (value) => (value === null ? "–" : `${number(value, 1)} s`);
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
