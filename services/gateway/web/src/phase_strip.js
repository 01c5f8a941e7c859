// A timed up and go as it is done: five parts, the running one counting, and the total.
import { el, say } from "./dom.js";
import { number } from "./units.js";
import { PHASES } from "./words.js";

export class PhaseStrip {
  constructor() {
    this.phases = new Map();
    this.attempt = 0;
    this.title = el("h2", {}, "Timed up and go");
    this.parts = Object.entries(PHASES).map(([phase, name]) => {
      const time = el("span", { class: "part-time" }, "–");
      return { phase, time, node: el("li", { "data-state": "waiting" }, el("span", {}, name), time) };
    });
    this.total = el("b", { class: "part-time" }, "–");
    this.spread = el("span", { class: "quiet" });
    this.spoken = el("p", { class: "unseen", "aria-live": "polite" });
    this.node = el(
      "section",
      { class: "panel strip", "aria-label": "Timed up and go", hidden: true },
      this.title,
      el("ol", { class: "parts" }, ...this.parts.map((part) => part.node)),
      el("div", { class: "strip-total" }, el("span", {}, "Total"), this.total, this.spread),
      this.spoken,
    );
  }

  /** A phase that begins or has ended; the first one of a new attempt clears the strip. */
  onPhase(phase) {
    if (phase.attempt < this.attempt) return;
    if (phase.attempt > this.attempt) this.phases.clear();
    this.attempt = phase.attempt;
    this.phases.set(phase.phase, phase);
    this.node.hidden = false;
    say(this.title, this.attempt === 0 ? "Timed up and go" : `Timed up and go, attempt ${this.attempt + 1}`);
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
    const { from, to, spread_s, given_up } = extentOf([...this.phases.values()]);
    say(this.total, from === null || given_up ? "–" : seconds((to ?? Math.max(now_s, from)) - from));
    say(this.spread, given_up ? "given up" : spread_s === null ? "" : `± ${number(2 * spread_s, 1)} s`);
  }

  words() {
    const running = this.parts.find(({ node }) => node.dataset.state === "running");
    if (running) return PHASES[running.phase];
    if (extentOf([...this.phases.values()]).given_up) return "Given up";
    return this.phases.has("turn_to_sit") ? `Done in ${this.total.textContent}` : "";
  }
}

function stateOfPart(phase) {
  if (!phase) return "waiting";
  return phase.end_s === null ? "running" : isGivenUp(phase) ? "given-up" : "done";
}

const seconds = (value) => `${number(value, 1)} s`;

/** A part that has an end but no deviation of it was not seen to its end. */
export const isGivenUp = (phase) => phase.end_s !== null && phase.end_std_s === null;

/** From the first start to the end of the last part; `to` is null, and so is the deviation, until that has ended. */
export function extentOf(phases) {
  const first = phases.find((each) => each.phase === "sit_to_stand") ?? phases[0];
  const last = phases.find((each) => each.phase === "turn_to_sit");
  const given_up = phases.some(isGivenUp);
  if (!first) return { from: null, to: null, spread_s: null, given_up };
  if (!last || last.end_s === null || given_up) return { from: first.start_s, to: null, spread_s: null, given_up };
  return { from: first.start_s, to: last.end_s, spread_s: Math.hypot(first.start_std_s, last.end_std_s), given_up };
}
