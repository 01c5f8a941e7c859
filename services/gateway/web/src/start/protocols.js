// What can be asked of a person: how it is done, what it needs, and what can measure it.
import { TASKS } from "../words.js";

/** What measures the person, in words. */
export const WORN = {
  lower_body: "Sensors: pelvis and both legs",
  knee: "Sensors: single knee",
  camera: "Camera: whole body",
  camera_and_sensors: "Camera and sensors together",
};

/** With both, one may also be left aside. @type {Record<string, string[]>} */
const FITTING = { camera_and_sensors: ["camera_and_sensors", "camera", "lower_body"] };

const LEGS = ["lower_body"];
const LEG_OR_LEGS = ["lower_body", "knee"];
const CAMERA = ["camera", "camera_and_sensors"];

/**
 * @typedef {{how: string, needs: string, worn: string[]}} Protocol
 * @type {Record<string, Protocol>}
 */
const PROTOCOLS = {
  walk: {
    how: "Walk to and fro at a comfortable pace, at least ten strides with each leg.",
    needs: "A free way of 5 m or more, or a treadmill.",
    worn: [...LEG_OR_LEGS, ...CAMERA],
  },
  timed_up_and_go: {
    how: "Rise from a chair, walk to the line, turn, walk back and sit down. Repeat as often as you like.",
    needs: "A chair and a line on the floor, 3 m away unless you say otherwise.",
    worn: LEG_OR_LEGS,
  },
  six_minute_walk: {
    how: "Walk up and down a corridor for six minutes, as far as possible. Rests are allowed and counted.",
    needs: "A straight corridor of known length, and a chair near by.",
    worn: LEGS,
  },
  ten_metre_walk: {
    how: "Walk along a marked way, three times. The middle part is timed.",
    needs: "A straight way of 10 m or more with room to slow down.",
    worn: LEGS,
  },
  marching: {
    how: "March on the spot and lift the knees, half a minute or longer.",
    needs: "Something to hold on to within reach.",
    worn: LEGS,
  },
  knee_flexion: {
    how: "Bend and stretch one knee, sitting or lying, as far as it goes. Each repetition is counted.",
    needs: "A chair or a couch.",
    worn: ["knee"],
  },
  squat: {
    how: "Bend both knees and come up again, the arms raised or at the sides.",
    needs: "The whole body in the camera's view, 2 to 3.5 m away.",
    worn: CAMERA,
  },
  stepping: {
    how: "Step on the spot, each knee in turn.",
    needs: "The whole body in the camera's view, 2 to 3.5 m away.",
    worn: CAMERA,
  },
  trunk_tilt_sagittal: {
    how: "Lean forward from the hips and come up again, standing or sitting.",
    needs: "The whole body in the camera's view, 2 to 3.5 m away.",
    worn: CAMERA,
  },
  trunk_tilt_frontal: {
    how: "Lean to one side, come up, lean to the other.",
    needs: "The whole body in the camera's view, 2 to 3.5 m away.",
    worn: CAMERA,
  },
};

/** What is not chosen here: the recording or the simulated person says it. */
export const AS_SOURCE = {
  name: "As the source says",
  how: "A recording or a simulated person brings its own task. Of somebody in the room, choose one below.",
  needs: "Nothing more.",
  worn: Object.keys(WORN),
};

/** @param {string} task empty: what the source says */
export const protocolOf = (task) => (task in PROTOCOLS ? { name: TASKS[task], ...PROTOCOLS[task] } : AS_SOURCE);

/** Tasks in the order in which they are offered. */
export const OFFERED = ["", ...Object.keys(PROTOCOLS)];

/** What may measure a task, in words. @param {string} task */
export const measuredBy = (task) => protocolOf(task).worn.map((worn) => WORN[worn]);

/** @param {{worn: string|null}} source @param {string} task whether that source can tell of the task */
export const canTell = ({ worn }, task) => worn === null || protocolOf(task).worn.includes(worn);

/** What the estimators for a source are made for. @param {string|null|undefined} worn */
export const estimatorsFor = (worn) => (worn ? (FITTING[worn] ?? [worn]) : Object.keys(WORN));
