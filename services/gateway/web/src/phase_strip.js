// A timed test as it is done: its parts in order, the running one counting, and the time that is the test's result.
import { el, say } from "./dom.js";
import { number } from "./units.js";
import { PHASES, TASKS, ZONE_PHASES } from "./words.js";

const DONE_STEPWISE = {
  timed_up_and_go: { parts: PHASES, first: "sit_to_stand", last: "turn_to_sit", result: "Total" },
  ten_metre_walk: { parts: ZONE_PHASES, first: "timed_zone", last: "timed_zone", result: "Timed zone" },
};

export class PhaseStrip {
  /** @param {"timed_up_and_go"|"ten_metre_walk"} task */
  constructor(task) {
    this.task = task;
    this.of = DONE_STEPWISE[task];
    this.phases = new Map();
    this.attempt = 0;
    this.title = el("h2", {}, TASKS[task]);
    this.parts = Object.entries(this.of.parts).map(([phase, name]) => {
      const time = el("span", { class: "part-time" }, "–");
      return { phase, time, node: el("li", { "data-state": "waiting" }, el("span", {}, name), time) };
    });
    this.total = el("b", { class: "part-time" }, "–");
    this.spread = el("span", { class: "quiet" });
    this.spoken = el("p", { class: "unseen", "aria-live": "polite" });
    this.node = el(
      "section",
      { class: "panel strip", "aria-label": TASKS[task] },
      this.title,
      el("ol", { class: "parts" }, ...this.parts.map((part) => part.node)),
      el("div", { class: "strip-total" }, el("span", {}, this.of.result), this.total, this.spread),
      this.spoken,
    );
  }

  /** A phase that begins or has ended; the first one of a new attempt clears the strip. */
  onPhase(phase) {
    if (phase.attempt < this.attempt) return;
    if (phase.attempt > this.attempt) this.phases.clear();
    this.attempt = phase.attempt;
    this.phases.set(phase.phase, phase);
    say(this.title, this.attempt === 0 ? TASKS[this.task] : `${TASKS[this.task]}, attempt ${this.attempt + 1}`);
    this.show(phase.end_s ?? phase.start_s);
    say(this.spoken, this.words());
  }

  /** Session time goes on: the running phase counts. */
  show(now_s) {
    for (const { phase, time, node } of this.parts) {
      const known = this.phases.get(phase);
      node.dataset.state = stateOfPart(known);
      say(time, known ? seconds((known.end_s ?? Math.max(now_s, known.start_s)) - known.start_s) : "–");
    }
    const { from, to, spread_s, given_up } = this.extent();
    say(this.total, from === null || given_up ? "–" : seconds((to ?? Math.max(now_s, from)) - from));
    say(this.spread, given_up ? "given up" : spread_s === null ? "" : `± ${number(2 * spread_s, 1)} s`);
  }

  words() {
    const running = this.parts.find(({ node }) => node.dataset.state === "running");
    if (running) return this.of.parts[running.phase];
    const { to, given_up } = this.extent();
    if (given_up) return "Given up";
    return to === null ? "" : `${this.of.result} ${this.total.textContent}`;
  }

  extent() {
    return extentOf([...this.phases.values()], this.of);
  }
}

function stateOfPart(phase) {
  if (!phase) return "waiting";
  return phase.end_s === null ? "running" : isGivenUp(phase) ? "given-up" : "done";
}

const seconds = (value) => `${number(value, 1)} s`;

/** A part that has an end but no deviation of it was not seen to its end. */
export const isGivenUp = (phase) => phase.end_s !== null && phase.end_std_s === null;

/**
 * From the start of the `first` part to the end of the `last`; `to` is null, and so is the deviation, until that has
 * ended. A timed up and go that was seen late counts from what was seen first; a timed zone does not.
 * @param {any[]} phases @param {{ first: string, last: string }} [task]
 */
export function extentOf(phases, { first: begin, last: finish } = DONE_STEPWISE.timed_up_and_go) {
  const first = phases.find((each) => each.phase === begin) ?? (begin === finish ? undefined : phases[0]);
  const last = phases.find((each) => each.phase === finish);
  const given_up = phases.some(isGivenUp);
  if (!first) return { from: null, to: null, spread_s: null, given_up };
  if (!last || last.end_s === null || given_up) return { from: first.start_s, to: null, spread_s: null, given_up };
  return { from: first.start_s, to: last.end_s, spread_s: Math.hypot(first.start_std_s, last.end_std_s), given_up };
}
