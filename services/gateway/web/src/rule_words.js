// Verdicts and the rules they come from, in sentences with their numbers. Never normal or abnormal.
import { AIDS, FOOTWEAR, GROUPS, ORTHOSES, PACES, STARTS } from "./condition_words.js";
import { GRADES } from "./trust_words.js";
import { degrees, number, shown } from "./units.js";

export const VERDICTS = {
  real_change: { word: "real change", tone: "good" },
  within_measurement_error: { word: "within measurement error", tone: "done" },
  cannot_tell: { word: "cannot tell", tone: "wait" },
};
export const JOINT_WORDS = {
  recovery: { word: "speaks for recovery", tone: "good" },
  compensation_possible: { word: "compensation possible", tone: "check" },
  cannot_tell: { word: "cannot tell", tone: "wait" },
};
export const DIRECTIONS = { better: "for the better", worse: "for the worse" };
export const TREATMENTS = {
  gait_training: "Gait training",
  treadmill_training: "Treadmill training",
  robot_training: "Robot-assisted training",
  strength_training: "Strength training",
  balance_training: "Balance training",
  electrical_stimulation: "Electrical stimulation",
  botulinum_toxin: "Botulinum toxin",
  medication_change: "Change of medication",
  aid_change: "Change of walking aid",
  orthosis_change: "Change of orthosis",
  surgery: "Surgery",
  pause: "Pause of therapy",
  other: "Another treatment",
};

const THINGS = {
  aid: "walking aid",
  orthosis: "orthosis",
  footwear: "footwear",
  physical_assistance: "physical assistance",
  speed_instruction: "pace asked for",
  start: "start",
  timed_from_m: "begin of the timed zone",
  timed_to_m: "end of the timed zone",
  test_duration_s: "duration of the test",
  walkway_m: "length of the walkway",
  walk_path: "path",
  estimator: "estimator",
  sensors: "sensors",
  software: "software",
  datum: "zero of the angles",
};
const VALUES = { aid: AIDS, orthosis: ORTHOSES, footwear: FOOTWEAR, speed_instruction: PACES, start: STARTS };
const OCCASIONS = { between_days: "between days", within_occasion: "within one occasion" };

const thing = (what) => THINGS[what] ?? what.replaceAll("_", " ");
const group = (name) => (GROUPS[name] ?? "a group that is not said").toLowerCase();
const angle = (value) => `${number(degrees(value), 1)}°`;
const speed = (value) => `${number(value, 2)} m/s`;

function valueOf(what, value) {
  if (value === null || value === undefined || value === "") return "not said";
  if (typeof value === "boolean") return value ? "yes" : "no";
  const word = VALUES[what]?.[value];
  if (word) return word.toLowerCase();
  return what.endsWith("_m") ? `${number(value, 1)} m` : what.endsWith("_s") ? `${number(value, 0)} s` : String(value);
}

/** A number of a measure with its unit; changes bear their sign. */
export function sayer(unit, name) {
  const { factor, unit: sign, digits } = shown(unit, name);
  const places = Math.max(1, digits);
  const plain = (value) => `${number(value * factor, places)}${sign ? ` ${sign}` : ""}`.replace(" °", "°");
  return { plain, change: (value) => (value > 0 ? `+${plain(value)}` : plain(value)) };
}

const interval = ({ change, low, high }, say) =>
  `Change ${say.change(change)} (95 % interval ${say.change(low)} to ${say.change(high)})`;

const SENTENCES = {
  change_beyond_mdc: (p, say) =>
    `${interval(p, say)}: larger than the MDC of ${say.plain(p.mdc)} and our own error together (${say.plain(p.limit)}).`,
  change_within_mdc: (p, say) => `${interval(p, say)}: the whole interval lies within the MDC of ${say.plain(p.mdc)}.`,
  interval_reaches_mdc: (p, say) =>
    `${interval(p, say)}: the interval reaches across the MDC of ${say.plain(p.mdc)}; for a real change it takes ${say.plain(p.limit)}.`,
  own_error_not_smaller: (p, say) =>
    `Our own 95 % interval of the change (± ${say.plain(p.half_interval)}) is not smaller than the MDC of ${say.plain(p.mdc)}.`,
  below_smallest_change: (p, say) =>
    `Change ${say.change(p.change)}: below ${say.plain(p.smallest)} it is never called progress.`,
  no_baseline: () => "No baseline is set: choose the visit that changes count from.",
  no_baseline_value: ({ visit }) => `Visit ${visit}, the baseline, has no value of it.`,
  baseline_only: ({ visit }) => `Visit ${visit} is the baseline; a later visit is needed.`,
  no_value: ({ because }) => (because ? `No value: ${because}.` : "No value at this visit."),
  no_interval: () => "The value has no 95 % interval.",
  not_final: () => "The session's numbers are not final.",
  grade_too_low: ({ grade }) => `Trust in the value is too low: ${(GRADES[grade]?.word ?? grade).toLowerCase()}.`,
  too_few_strides: ({ strides, least }) => `${strides} strides; at least ${least} are needed.`,
  population_unsaid: () => "The patient's group is not said, so no published threshold can be chosen.",
  population_changed: ({ now, baseline }) =>
    `The patient's group is ${group(now)} now and was ${group(baseline)} when the baseline was set.`,
  no_threshold: ({ population, occasion }) =>
    `No published threshold of this measure fits: ${group(population)}, ${OCCASIONS[occasion] ?? occasion}.`,
  no_baseline_speed: ({ visit }) => `Visit ${visit} has no walking speed, so no speed band can be chosen.`,
  difference: ({ what, now, baseline }) =>
    `Not like with like: ${thing(what)} ${valueOf(what, now)} now, ${valueOf(what, baseline)} at the baseline.`,
  unsaid: ({ what }) => `Nobody said: ${thing(what)}.`,
  reference_changed: ({ set, now, baseline }) =>
    `Reference set ${set} is ${now ?? "absent"} now and was ${baseline ?? "absent"} at the baseline.`,
  speed_up_sides_closer: (p) =>
    `Speed rose by ${speed(p.speed_change)} and the legs' curves came ${angle(Math.abs(p.distance_change))} closer.`,
  speed_up_other_motion_grew: (p) =>
    `Speed rose by ${speed(p.speed_change)} while ${thing(p.motion)} grew by ${motion(p)}.`,
  sides_closer_and_other_motion_grew: (p) =>
    `The legs' curves came ${angle(Math.abs(p.distance_change))} closer, but ${thing(p.motion)} grew by ${motion(p)}.`,
  speed_not_up: (p) =>
    `Speed did not surely rise: ${speed(p.speed_change)} (95 % interval ${speed(p.low)} to ${speed(p.high)}).`,
  sides_not_closer: (p) =>
    `The legs' curves did not surely come closer: ${angle(p.distance_change)} (95 % interval ${angle(p.low)} to ${angle(p.high)}).`,
};

const motion = ({ motion: what, motion_change }) =>
  what.startsWith("circumduction") ? `${number(100 * motion_change, 1)} cm` : angle(motion_change);

/** One rule as a sentence; of a rule that this page does not know, its name. */
export function ruleSentence({ code, parameters }, say) {
  return SENTENCES[code]?.(parameters, say) ?? `${code.replaceAll("_", " ")}.`;
}
