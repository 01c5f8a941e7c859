// What to do while the sensors' places are being found, how well they were, and what it costs to go on without.

const GOOD = 0.7;
const FAIR = 0.4;

/** How well the worst sensor's place is known, as a word and a share. @param {number} quality 0 a guess, 1 certain */
export function qualityOf(quality) {
  const text = `${Math.round(100 * quality)} of 100, the worst sensor's`;
  if (quality >= GOOD) return { word: "Good", tone: "good", text };
  if (quality >= FAIR) return { word: "Fair", tone: "check", text };
  return { word: "Poor", tone: "check", text };
}

/**
 * The one thing to do now.
 * @param {{phase: string|null, message: string|null}} now @param {{absolute: boolean}|null} calibration
 */
export function heading({ phase, message }, calibration) {
  if (phase === null) return "Waiting for the first data";
  if (phase === "estimating") return calibration?.absolute === false ? "Going, but not absolute yet" : "Ready";
  return message || "Stand still, upright";
}

/** @param {{phase: string|null, message: string|null}} now @param {{absolute: boolean}|null} calibration */
export function duty({ phase, message }, calibration) {
  if (phase === null) return "Sensors on, straps closed. The person may sit until data come.";
  if (phase === "estimating")
    return calibration?.absolute === false
      ? message || "Stand still and upright for a second; or go on, angles are then right as changes."
      : "The sensors' places are found. Begin whenever the person is.";
  if (phase === "waiting") return "Arms hanging, looking ahead, two seconds. Gravity shows how each sensor sits.";
  return "A few easy movements show how each joint turns. What is recorded meanwhile counts.";
}

/** @param {{sensors: number, cameras: number}} worn */
export function costOfSkipping({ sensors, cameras }) {
  const cost = "Without standing still, each angle may be off by a constant; ranges, times and counts do not depend on it.";
  if (sensors === 0 && cameras > 0) return `It may be skipped. ${cost}`;
  return `It may be skipped: calibration then goes on by itself on the live page, and the live numbers come later. ${cost}`;
}
