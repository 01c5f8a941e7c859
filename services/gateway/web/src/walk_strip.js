// A walk for time as it is done: what remains, what goes on, laps, rests, and how far so far.
import { el, say, svg } from "./dom.js";
import { INVALID, PHASE_COLOURS } from "./palette.js";
import { clock, number } from "./units.js";
import { TASKS, WALK_PHASES } from "./words.js";

const USUAL_S = 360;
const MINUTE_S = 60;
const BAR = { width: 600, height: 14 };

export class WalkStrip {
  /** @param {{duration_s: number|null|undefined, walkway_m: number|null}} test */
  constructor({ duration_s, walkway_m }) {
    this.duration_s = duration_s ?? USUAL_S;
    this.phases = [];
    this.strides = [];
    this.cells = {
      remaining: el("b", { class: "part-time" }, clock(this.duration_s)),
      minute: el("b", {}, "–"),
      laps: el("b", {}, "0"),
      rests: el("b", {}, "none"),
      distance: el("b", { class: "part-time" }, "–"),
    };
    this.now = el("p", { class: "chip big" }, "Not begun");
    this.bar = svg("svg", { class: "minutes", viewBox: `0 0 ${BAR.width} ${BAR.height}`, preserveAspectRatio: "none" });
    this.bar.setAttribute("aria-hidden", "true");
    this.spoken = el("p", { class: "unseen", "aria-live": "polite" });
    const { remaining, minute, laps, rests, distance } = this.cells;
    const lap = walkway_m ? `Lengths of ${number(walkway_m, walkway_m % 1 === 0 ? 0 : 1)} m` : "Lengths";
    this.node = el(
      "section",
      { class: "panel strip walk-strip", "aria-label": TASKS.six_minute_walk },
      el("h2", {}, TASKS.six_minute_walk),
      this.now,
      el(
        "dl",
        {},
        fact("Remaining", remaining),
        fact("Minute", minute),
        fact(lap, laps),
        fact("Rests", rests),
        fact("Distance so far", distance),
      ),
      this.bar,
      this.spoken,
    );
  }

  /** A part that begins, or the same one when it has ended. */
  onPhase(phase) {
    this.phases = withPhase(this.phases, phase);
    if (phase.end_s !== null) this.strides = this.strides.filter((stride) => stride.start_s >= phase.end_s);
    this.show(phase.end_s ?? phase.start_s);
    say(this.spoken, this.now.textContent);
  }

  onStride(stride) {
    this.strides.push(stride);
  }

  /** Session time goes on. */
  show(now_s) {
    const walk = walkSoFar(this.phases, this.strides, now_s, this.duration_s);
    if (walk === null) return;
    say(this.cells.remaining, clock(Math.ceil(walk.remaining_s)));
    say(this.cells.minute, walk.minute === null ? "–" : `${walk.minute} of ${Math.ceil(this.duration_s / MINUTE_S)}`);
    say(this.cells.laps, String(walk.lengths));
    say(this.cells.rests, walk.rests === 0 ? "none" : `${walk.rests}, ${clock(walk.rested_s)} in all`);
    say(this.cells.distance, walk.distance_m === null ? "–" : `${number(walk.distance_m, 0)} m`);
    say(this.now, walk.over ? "Time is over" : (WALK_PHASES[walk.phase] ?? "–"));
    this.now.dataset.tone = walk.over ? "done" : walk.phase === "rest" ? "wait" : "good";
    const drawn = `${this.phases.length} ${Math.floor(walk.elapsed_s)}`;
    if (drawn !== this.drawn) this.drawMinutes(walk);
    this.drawn = drawn;
  }

  drawMinutes({ elapsed_s, from_s }) {
    const place = (time_s) => (BAR.width * Math.min(this.duration_s, Math.max(0, time_s))) / this.duration_s;
    const parts = this.phases.map((phase) => {
      const [left, right] = [phase.start_s - from_s, (phase.end_s ?? from_s + elapsed_s) - from_s].map(place);
      const box = { x: left, y: 0, height: BAR.height, width: Math.max(0, right - left) };
      return svg("rect", { ...box, fill: PHASE_COLOURS[phase.phase] });
    });
    const minutes = Array.from({ length: Math.ceil(this.duration_s / MINUTE_S) - 1 }, (_, i) => place((i + 1) * MINUTE_S));
    const lines = minutes.map((x) => svg("line", { x1: x, x2: x, y1: 0, y2: BAR.height, stroke: INVALID }));
    this.bar.replaceChildren(...parts, ...lines);
  }
}

const fact = (name, value) => el("div", {}, el("dt", {}, name), el("dd", {}, value));

/** The parts with this one added, or put in place of the one that it ends. */
export function withPhase(phases, phase) {
  const same = phases.findIndex(
    (each) => each.phase === phase.phase && (each.end_s === null || each.start_s === phase.start_s),
  );
  return same < 0 ? [...phases, phase] : phases.with(same, phase);
}

/**
 * Where a walk for time stands at session time `now_s`; null before it begins. Metres are those of the parts that have
 * ended, and of the running one the mean over the legs of the strides since it began; null where nobody measures them.
 */
export function walkSoFar(phases, strides, now_s, duration_s) {
  if (phases.length === 0) return null;
  const from_s = Math.min(...phases.map((each) => each.start_s));
  const newest = phases.reduce((last, each) => (each.start_s >= last.start_s ? each : last));
  const over = now_s - from_s >= duration_s;
  const elapsed_s = Math.min(duration_s, Math.max(0, now_s - from_s));
  const rests = phases.filter((each) => each.phase === "rest");
  return {
    from_s,
    elapsed_s,
    over,
    remaining_s: duration_s - elapsed_s,
    minute: over ? null : Math.floor(elapsed_s / MINUTE_S) + 1,
    phase: newest.phase,
    lengths: phases.filter((each) => each.phase === "turn" && each.end_s !== null).length,
    rests: rests.length,
    rested_s: rests.reduce((sum, each) => sum + Math.min(each.end_s ?? now_s, from_s + duration_s) - each.start_s, 0),
    distance_m: distanceOf(phases, strides),
  };
}

function distanceOf(phases, strides) {
  const known = phases.filter((each) => each.distance_m !== null && each.distance_m !== undefined);
  const running = phases.find((each) => each.end_s === null);
  const ongoing = running ? strides.filter((each) => each.start_s >= running.start_s && each.stride_length_m !== null) : [];
  if (known.length === 0 && ongoing.length === 0) return null;
  const sides = new Set(ongoing.map((each) => each.side)).size;
  const metres = ongoing.reduce((sum, each) => sum + each.stride_length_m, 0) / Math.max(1, sides);
  return known.reduce((sum, each) => sum + each.distance_m, metres);
}
