// The pure modules of the live pages. Run by test_page_modules.py, or: node --test tests/unit/gateway/live_pages.test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const load = (name) => import(new URL(name, sources));
const { countsOf, entriesOf, needsLook } = await load("floor_states.js");
const { factsOf } = await load("floor_card.js");
const { StrideMemory } = await load("stride_memory.js");
const { ratioOf } = await load("symmetry_strip.js");
const { CUES, CueProgress, cuesOf, sentenceOf } = await load("feedback_cues.js");
const { feedbackAddress, targetFrom, targetOfAddress } = await load("feedback_target.js");
const { LiveSocket } = await load("live_socket.js");
const { stateOf } = await load("words.js");

const session = (changes) => ({
  id: "a",
  title: "Walk",
  task: "walk",
  patient: "K7QM",
  started_unix_s: 100,
  age_s: 0.1,
  phase: "estimating",
  message: "",
  sensors: [{ sensor: "s", state: "ok" }],
  sensor_segments: { s: "shank_left" },
  cameras: [],
  misplaced: {},
  recording_stopped: null,
  elapsed_s: 75,
  cadence_per_min: 101.6,
  strides: 12,
  repetitions: 0,
  task_phases: [],
  ...changes,
});
const floor = (...sessions) => ({ sessions, silent: [], connected: true });
const lost = { sensors: [{ sensor: "s", state: "missing" }] };

test("trouble comes first, then who began first", () => {
  const entries = entriesOf(
    floor(
      session({ id: "late", started_unix_s: 300 }),
      session({ id: "early", started_unix_s: 200 }),
      session({ id: "waits", phase: "calibrating" }),
      session({ id: "lost", ...lost, started_unix_s: 900 }),
    ),
    0,
  );
  assert.deepEqual(entries.map(({ session: { id } }) => id), ["lost", "waits", "early", "late"]);
  assert.deepEqual(entries.map(needsLook), [true, false, false, false]);
  assert.equal(countsOf(entries), "4 live, 1 needs a look");
  assert.equal(countsOf([]), "");
  assert.equal(countsOf(entries.slice(1)), "3 live, none needs a look");
});

test("a card goes grey within a second of its last data, and shows ages that do not flicker between messages", () => {
  const at = (since_s) => entriesOf(floor(session({ age_s: 0.1 })), since_s)[0];
  assert.deepEqual([at(0.5).stale, at(0.5).age_s], [false, 0.1]);
  assert.equal(at(0.95).stale, true);
  assert.ok(Math.abs(at(0.95).age_s - 1.05) < 1e-9);
  assert.match(at(2).word, /^Delayed \(2\.1 s\)$/);
});

test("a session without data is not grey but says so", () => {
  const [entry] = entriesOf(floor(session({ age_s: null, phase: null })), 9);
  assert.deepEqual([entry.word, entry.stale, entry.age_s], ["No data yet", false, null]);
});

test("a recording that has stopped is said, and why", () => {
  const of = (recording_stopped) => stateOf({ ...session({ recording_stopped }), segments: {}, silent: [], heard: true });
  assert.deepEqual(of("disk"), { word: "Recording stopped - disk nearly full", tone: "lost", light: "Not recording" });
  assert.equal(of("refused").word, "Recording stopped - the disk refuses");
  assert.equal(of(null).word, "Live");
});

test("facts are those of what is done", () => {
  assert.deepEqual(factsOf(session({})), [["Time", "1:15"], ["Cadence", "102 /min"], ["Strides", "12"]]);
  assert.deepEqual(factsOf(session({ task: "squat", repetitions: 4 }))[1], ["Repetitions", "4"]);
});

const picture = (x, heading = 0) => ({ points: { knee_left: [x, 0.5, 0] }, valid: {}, heading, sides: ["left"] });

/** Strides of 1 s whose knee swings `swing` far, m and rad alike. */
function walk(memory, swings) {
  swings.forEach((swing, index) => {
    for (let i = 0; i <= 20; i++) {
      const value = swing * Math.sin((2 * Math.PI * i) / 20);
      memory.add(index + i / 20 + (i === 0 ? 1e-6 : 0), picture(value), { knee_flexion_left: value, hip_flexion_left: value });
    }
    memory.onStride({ side: "left", start_s: index, end_s: index + 1, valid: true, turning: false });
  });
}

test("the best stride is the one closest to the mean, the previous one the last", () => {
  const memory = new StrideMemory();
  walk(memory, [0.1, 0.3, 0.32, 0.6]);
  assert.equal(memory.chosen("best", "left").start_s, 2);
  assert.equal(memory.chosen("previous", "left").start_s, 3);
  assert.equal(memory.chosen("best", "right"), null);
  assert.equal(memory.chosen("off", "left"), null);
});

test("two strides have no best one, and turning or refused strides are not kept", () => {
  const memory = new StrideMemory();
  walk(memory, [0.2, 0.2]);
  memory.onStride({ side: "left", start_s: 1, end_s: 2, valid: true, turning: true });
  memory.onStride({ side: "left", start_s: 1, end_s: 2, valid: false, turning: false });
  assert.equal(memory.chosen("best", "left"), null);
  assert.equal(memory.strides.left.length, 2);
});

test("a ghost walks in the rhythm of the last stride, faces as the person does, and stops with her", () => {
  const memory = new StrideMemory();
  walk(memory, [0.3, 0.3, 0.3]);
  const quarter = memory.ghost("previous", "left", 3.25, 0);
  assert.ok(Math.abs(quarter.points.knee_left[0] - 0.3) < 1e-3);
  const [x, , z] = memory.ghost("previous", "left", 4.25, Math.PI / 2).points.knee_left;
  assert.ok(Math.abs(x) < 1e-3 && Math.abs(z + 0.3) < 1e-3, "to the left is towards minus z");
  assert.equal(memory.ghost("previous", "left", 6, 0), null);
});

test("a session that begins anew forgets the strides before", () => {
  const memory = new StrideMemory();
  walk(memory, [0.3, 0.3, 0.3]);
  memory.add(0.2, picture(0), {});
  assert.equal(memory.chosen("previous", "left"), null);
});

test("what is kept of the past is bounded", () => {
  const memory = new StrideMemory();
  walk(memory, Array(60).fill(0.3));
  assert.ok(memory.pictures.length < 400);
  assert.equal(memory.strides.left.length, 10);
});

test("a symmetry ratio is named by its formula", () => {
  assert.deepEqual(ratioOf(0.6, 0.5, "right"), { name: "paretic / non-paretic", value: 0.5 / 0.6 });
  assert.deepEqual(ratioOf(0.6, 0.5, null), { name: "larger / smaller", value: 1.2 });
});

const stride = (changes) => ({
  side: "left", start_s: 0, end_s: 1, stride_time_s: 1, step_time_s: 0.5, walking_speed: 0.8, valid: true, turning: false,
  ...changes,
});
const after = (target, ...strides) => {
  const progress = new CueProgress({ side: "left", ...target });
  for (const each of strides) progress.onStride(stride(each));
  return progress.now();
};

test("cues follow the strides", () => {
  assert.equal(after({ cue: "speed", target: 0.8 }).state, "waiting");
  assert.equal(after({ cue: "speed", target: 0.8 }, {}).state, "in");
  assert.equal(after({ cue: "speed", target: 1.0 }, {}).state, "low");
  assert.equal(after({ cue: "speed", target: 0.6 }, {}).state, "high");
  assert.equal(after({ cue: "cadence", target: 120 }, {}).state, "in");
  assert.equal(after({ cue: "cadence", target: 100 }, {}).state, "high");
  assert.equal(after({ cue: "cadence", target: 100 }, { valid: false }).state, "waiting");
});

test("a foot that takes long is asked for sooner", () => {
  const target = { cue: "symmetry", target: 10, side: "left" };
  const slowLeft = after(target, { side: "right", step_time_s: 0.5 }, { side: "left", step_time_s: 0.65 });
  assert.equal(slowLeft.state, "low");
  assert.equal(sentenceOf(target, slowLeft), "Left foot forward sooner");
  const even = after(target, { side: "right", step_time_s: 0.5 }, { side: "left", step_time_s: 0.52 });
  assert.equal(sentenceOf(target, even), "Even steps, keep going");
});

test("the bend of a knee is its largest within the stride of its leg", () => {
  const progress = new CueProgress({ cue: "knee", target: 50, side: "left" });
  const bent = (at_s, degrees) => ({ at_s, angles: { knee_flexion_left: (degrees * Math.PI) / 180 } });
  progress.onPose({ ...bent(0.9, 20), trail: [bent(-0.1, 80), bent(0.6, 42)] });
  progress.onStride(stride({ side: "right" }));
  assert.equal(progress.now().state, "waiting");
  progress.onStride(stride({}));
  assert.deepEqual([progress.now().state, Math.round(10 * progress.now().place)], ["low", -8]);
});

test("repetitions that count fill the ring", () => {
  const target = { cue: "repetitions", target: 3, side: "left" };
  const progress = new CueProgress(target);
  const words = [sentenceOf(target, progress.now())];
  [true, false, true].forEach((valid, index) => {
    progress.onRepetition({ degree_of_freedom: "knee_flexion", side: "left", index, valid });
    words.push(sentenceOf(target, progress.now()));
  });
  assert.deepEqual(words, ["Begin when you are ready", "Nearly there", "Nearly there", "Done, well done"]);
});

test("every cue has a sentence for every state, short enough to be read from afar and without a number", () => {
  for (const cue of Object.keys(CUES))
    for (const state of ["waiting", "low", "in", "high"]) {
      if (state === "high" && ["knee", "repetitions"].includes(cue)) continue;
      const text = sentenceOf({ cue, target: 10, side: "right" }, { state, done: 4 });
      assert.ok(text.length > 3 && text.length <= 26, `${cue} ${state}: ${text}`);
      assert.doesNotMatch(text, /\d|wrong|bad|fail|not /i);
    }
});

test("cues are offered where they are measured", () => {
  const walking = { counted: false, sides: ["left", "right"], legs: null };
  assert.deepEqual(cuesOf(walking, { task: "walk" }), ["speed", "cadence", "symmetry", "knee"]);
  assert.deepEqual(cuesOf(walking, { task: "marching" }), ["cadence", "symmetry", "knee"]);
  assert.deepEqual(cuesOf({ ...walking, sides: ["left"], legs: ["left"] }, { task: "walk" }), ["cadence", "knee"]);
  assert.deepEqual(cuesOf({ ...walking, counted: true }, { task: "squat" }), ["repetitions"]);
});

test("a target goes round by its address, and nonsense in one is no target", () => {
  const target = { cue: "knee", target: 55, side: "right" };
  assert.deepEqual(targetOfAddress(feedbackAddress("s1", target)), target);
  assert.equal(targetOfAddress("#/feedback/s1"), null);
  assert.equal(targetFrom({ cue: "toString", target: 1 }), null);
  assert.equal(targetFrom({ cue: "knee", target: "1e9" }).target, CUES.knee.most);
  assert.equal(targetFrom({ cue: "knee", target: "x" }).target, CUES.knee.usual);
});

test("a gateway that accepts and then is too busy to speak is given longer each time", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const opened = [];
  globalThis.location = { protocol: "http:", host: "here" };
  globalThis.WebSocket = class {
    constructor() {
      opened.push(this);
    }
    close() {}
  };
  const socket = new LiveSocket("/a", { onMessage() {} });
  const silences = [];
  for (let round = 0; round < 4; round++) {
    opened.at(-1).onopen();
    const before = opened.length;
    let waited = 0;
    for (; opened.length === before; waited += 250) context.mock.timers.tick(250);
    silences.push(waited);
  }
  assert.deepEqual(silences, [4250, 8250, 16250, 16250]);
  opened.at(-1).onopen();
  opened.at(-1).onmessage({ data: "{}" });
  context.mock.timers.tick(4000);
  context.mock.timers.tick(250);
  assert.equal(opened.length, 6, "one that has spoken is missed after the usual silence");
  socket.close();
});
