// What a timed test shows while it is done, above everything else.
import { PhaseStrip } from "./phase_strip.js";
import { WalkStrip } from "./walk_strip.js";

/** Null for tasks that are not timed. */
export function stripOf({ task, conditions, walkway_m }) {
  if (task === "six_minute_walk") return new WalkStrip({ duration_s: conditions?.test_duration_s, walkway_m });
  return task === "timed_up_and_go" || task === "ten_metre_walk" ? new PhaseStrip(task) : null;
}
