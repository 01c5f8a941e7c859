// Every sentence about a state, in one place: the same words everywhere. Never normal or abnormal.

import { cameraWord, seesNobody } from "./camera_words.js";

const SIDES = { left: "Left", right: "Right" };

/** `shank_left` as "Left shank". */
export function segmentName(segment) {
  const [part, side] = segment.split("_");
  return side in SIDES ? `${SIDES[side]} ${part}` : part.charAt(0).toUpperCase() + part.slice(1);
}

/** `knee_flexion_left` as ["Knee flexion", "left"]. */
export function jointName(name) {
  const side = name.endsWith("_left") ? "left" : name.endsWith("_right") ? "right" : null;
  const words = (side ? name.slice(0, -side.length - 1) : name).replaceAll("_", " ");
  return [words.charAt(0).toUpperCase() + words.slice(1), side];
}

/** Names that end in a direction, not in a side. */
const DIRECTED = { trunk_lean_right: "Trunk lean to the right" };

/** Name of an angle whose side is said elsewhere, or of a movement. */
export const angleTitle = (name) => DIRECTED[name] ?? jointName(name)[0];

const METRICS = {
  stance_fraction: "Stance",
  knee_flexion_peak_swing: "Peak knee flexion in swing",
  knee_flexion_at_contact: "Knee flexion at contact",
  knee_flexion_range: "Knee flexion range",
  hip_flexion_range: "Hip flexion range",
  hip_flexion_peak: "Peak hip flexion",
  hip_extension_peak: "Peak hip extension",
  rhythm_side_distance: "Distance between the legs",
  rhythm_side_shape: "Difference in shape between the legs",
  rhythm_side_timing: "Right leg later than half a stride",
  rhythm_distance_previous_trial: "Distance from the previous trial",
  rhythm_shape_previous_trial: "Difference in shape from the previous trial",
  rhythm_distance_previous_visit: "Distance from the previous visit",
  rhythm_shape_previous_visit: "Difference in shape from the previous visit",
  rhythm_distance_exemplar: "Distance from the exemplar",
  rhythm_shape_exemplar: "Difference in shape from the exemplar",
  repetitions_counted: "Repetitions counted",
  repetitions_rejected: "Repetitions left out",
  repetition_range: "Range",
  repetition_flexion_largest: "Peak flexion",
  repetition_flexion_smallest: "Least flexion (extension deficit)",
  repetition_time_out: "Time there",
  repetition_time_back: "Time back",
  repetition_hold: "Hold",
  repetition_time_flexing: "Time flexing",
  repetition_time_extending: "Time extending",
  repetition_peak_velocity: "Peak velocity",
  repetition_range_slope: "Trend of the range",
  repetition_tempo: "Tempo",
  tug_time: "Timed up and go",
  tug_turn_rate: "Largest turn rate",
  tug_turn_to_sit_rate: "Largest turn rate before sitting",
  tug_rise_rate: "Largest thigh rate in rising",
  tug_steps: "Steps",
  tug_sit_to_stand_time: "Time to stand up",
  tug_walk_out_time: "Time to walk out",
  tug_turn_time: "Time to turn",
  tug_walk_back_time: "Time to walk back",
  tug_turn_to_sit_time: "Time to turn and sit",
  tug_attempts: "Attempts completed",
  tug_attempts_aborted: "Attempts not seen to their end",
  six_minute_walk_distance: "Six-minute walk distance",
  ten_metre_walk_speed: "Ten-metre walk speed",
  ten_metre_walk_time: "Ten-metre walk time",
  strides_counted: "Strides counted",
  strides_turning: "Strides while turning",
  strides_rejected: "Strides left out",
};
const ENDINGS = {
  _ratio_larger_to_smaller: ", larger / smaller side",
  _ratio_paretic_to_non_paretic: ", paretic / non-paretic",
  _cv: ", variation",
  _sd: ", standard deviation",
  _fraction: "",
};

/** Name of a metric for the screen. */
export function metricName(name) {
  if (name in METRICS) return METRICS[name];
  for (const [ending, words] of Object.entries(ENDINGS))
    if (name.endsWith(ending)) return metricName(name.slice(0, -ending.length)) + words;
  return jointName(name.replace(/^(repetition|six_minute_walk|ten_metre_walk)_/, ""))[0];
}

/** What a sensor's state means to a therapist. */
export const SENSOR_WORDS = {
  ok: { word: "Good", tone: "good" },
  calibrating: { word: "Calibrating", tone: "wait" },
  missing: { word: "Lost", tone: "lost" },
  stuck: { word: "Check sensor – it stands still", tone: "check" },
  rejected: { word: "Check sensor – readings refused", tone: "check" },
  unused: { word: "Not used", tone: "done" },
};

/** What a person is asked to do. */
export const TASKS = {
  walk: "Walk",
  timed_up_and_go: "Timed up and go",
  six_minute_walk: "Six-minute walk",
  ten_metre_walk: "Ten-metre walk",
  marching: "Marching on the spot",
  knee_flexion: "Knee bending",
  squat: "Squat",
  stepping: "Stepping on the spot",
  trunk_tilt_sagittal: "Trunk tilt, forward",
  trunk_tilt_frontal: "Trunk tilt, to the side",
};

/** The parts of a timed up and go, in order. */
export const PHASES = {
  sit_to_stand: "Stand up",
  walk_out: "Walk out",
  turn: "Turn",
  walk_back: "Walk back",
  turn_to_sit: "Turn and sit",
};

/** The parts of a ten-metre walk, in order. */
export const ZONE_PHASES = { run_up: "Run-up", timed_zone: "Timed zone", run_out: "Run-out" };

/** What goes on in a six-minute walk. */
export const WALK_PHASES = { walk: "Walking", turn: "Turning", rest: "Resting" };

const MISPLACED = {
  other_leg: {
    word: () => "Sides may be swapped",
    text: (side) => `Sides may be swapped: the sensors of the ${side} leg seem to be on the ${OTHER[side]} leg.`,
  },
  swapped: {
    word: () => "Thigh and shank may be swapped",
    text: (side) => `Thigh and shank sensor of the ${side} leg seem to be swapped.`,
  },
  thigh_upside_down: {
    word: (side) => `${SIDES[side]} thigh sensor upside down`,
    text: (side) => `The ${side} thigh sensor seems to be worn upside down.`,
  },
  shank_upside_down: {
    word: (side) => `${SIDES[side]} shank sensor upside down`,
    text: (side) => `The ${side} shank sensor seems to be worn upside down.`,
  },
};
const OTHER = { left: "right", right: "left" };

/** All that is worn otherwise than declared, as sentences; empty when nothing is. */
export function misplacedText(misplaced) {
  return foundMisplaced(misplaced)
    .map(({ side, what }) => MISPLACED[what].text(side))
    .join(" ");
}

function foundMisplaced(misplaced) {
  return Object.entries(misplaced ?? {}).flatMap(([side, found]) =>
    found.filter((what) => what in MISPLACED).map((what) => ({ side, what })),
  );
}

const ORDER = { lost: 0, check: 1, wait: 2, good: 3, done: 4 };

/** A number older than this is grey. */
export const STALE_S = 1;

/**
 * The one word for a running session, worst thing first.
 * @param {{age_s: number|null, phase: string|null, message: string|null, sensors: {sensor: string, state: string}[],
 *   cameras: {state: string, people: number}[], segments: Record<string, string>, misplaced: Record<string, string[]>, silent: string[],
 *   preparing?: string[], recording_stopped?: string|null, heard: boolean}} now
 * @returns {{word: string, tone: "lost"|"check"|"wait"|"good", light: string}}
 */
export function stateOf(now) {
  const { word, tone, light } = /** @type {any} */ (judge(now));
  return { word, tone, light: light ?? { lost: "Lost", check: "Check sensor", wait: "Wait", good: "Good" }[tone] };
}

function calibratingStep(message) {
  return message ? message.charAt(0).toLowerCase() + message.slice(1) : "stand still";
}

/** Why the archive writes nothing of a session just now. */
const NOT_RECORDED = {
  disk: "Recording stopped - disk nearly full",
  refused: "Recording stopped - the disk refuses",
};

function judge(now) {
  const { age_s, phase, message, sensors, cameras, segments, misplaced, silent, preparing, heard } = now;
  const estimating = !silent.includes("estimation");
  if (age_s !== null && age_s > STALE_S) {
    if (heard && !estimating && !silent.includes("archive")) {
      return { word: "Archive only (recording continues)", tone: "check" };
    }
    return {
      word: `Delayed (${age_s < 100 ? age_s.toFixed(1) : Math.round(age_s)} s)`,
      tone: age_s > 5 ? "lost" : "check",
      light: age_s > 5 ? "Lost" : "Delayed",
    };
  }
  if (now.recording_stopped) return { word: NOT_RECORDED[now.recording_stopped], tone: "lost", light: "Not recording" };
  if (age_s === null) return { word: preparing?.includes("estimation") ? "Getting ready" : "No data yet", tone: "wait" };
  const lost = sensors.find((each) => each.state === "missing");
  if (lost) return { word: `${segmentName(segments[lost.sensor] ?? lost.sensor)} sensor lost`, tone: "lost" };
  const doubtful = sensors.find((each) => each.state === "stuck" || each.state === "rejected");
  if (doubtful)
    return {
      word: `Check ${segmentName(segments[doubtful.sensor] ?? doubtful.sensor).toLowerCase()} sensor`,
      tone: "check",
    };
  const away = (cameras ?? []).find(seesNobody);
  if (away) return cameraWord(away);
  const [worst] = foundMisplaced(misplaced);
  if (worst) return { word: MISPLACED[worst.what].word(worst.side), tone: "check" };
  if (phase !== "estimating") return { word: `Calibrating - ${calibratingStep(message)}`, tone: "wait" };
  return { word: "Live", tone: "good" };
}

/** Trouble first. */
export const byTrouble = (a, b) => ORDER[a.tone] - ORDER[b.tone];

/** How long ago data came. */
export function lastData(age_s) {
  if (age_s === null) return "no data yet";
  return `last data ${age_s < 10 ? age_s.toFixed(1) : Math.round(age_s)} s ago`;
}

/** A stored session's state. */
export const STORED_WORDS = {
  created: { word: "Starting", tone: "wait" },
  live: { word: "Live", tone: "good" },
  finished: { word: "Finished", tone: "done" },
  interrupted: { word: "Interrupted", tone: "check" },
  failed: { word: "Not started", tone: "lost" },
};

/** What stands where the cards would be. */
export function nobody(connected, preparing = []) {
  if (connected && preparing.length > 0) {
    return { title: "Getting ready", advice: `${gettingReady(preparing)}. Sessions may be started; they are recorded.` };
  }
  if (connected) {
    return {
      title: "Nobody walks just now",
      advice: "Start a recorded or simulated walk, or switch on a device: it shows up here by itself.",
    };
  }
  return {
    title: "No live data",
    advice: "The services behind the gateway are not heard. What they run shows up here as soon as they are back.",
  };
}

/** What a first start does: services are there, and not at work yet. Empty when all are at work. */
export function gettingReady(preparing) {
  if (!preparing?.length) return "";
  const what = preparing.includes("estimation") ? "estimators are" : "analyses are";
  return `Getting ready: ${what} being compiled, about a minute and a half`;
}

/** What the header says about the line to the gateway and to the services behind it. */
export function connectionOf(socketOpen, status) {
  if (!socketOpen) return { word: "Connection lost – trying again", tone: "lost" };
  if (!status) return { word: "Connecting", tone: "wait" };
  if (!status.connected) return { word: "No live data – stored sessions can be read", tone: "check" };
  if (status.silent.includes("archive")) return { word: "Not recording – the archive is silent", tone: "lost" };
  if (status.preparing?.length > 0) return { word: gettingReady(status.preparing), tone: "wait" };
  if (status.silent.length > 0) return { word: `Silent: ${status.silent.join(", ")}`, tone: "check" };
  return { word: "Connected", tone: "good" };
}
