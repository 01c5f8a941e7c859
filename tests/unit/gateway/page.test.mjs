// The page's pure modules. Run by test_page_modules.py, or: node --test tests/unit/gateway/page.test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const { figureOf, headingOf, between, rotate, Stage } = await import(new URL("figure.js", sources));
const { byTrouble, connectionOf, jointName, lastData, metricGroup, metricName, segmentName, stateOf } = await import(
  new URL("words.js", sources)
);
const { bytes, clock, degrees, number, shown } = await import(new URL("units.js", sources));
const { LiveSocket } = await import(new URL("live_socket.js", sources));

const QUARTER = Math.SQRT1_2;
const LEVEL = [1, 0, 0, 0];
const BODY = { thigh_length_m: 0.42, shank_length_m: 0.41, hip_width_m: 0.18 };

const close = (actual, expected) =>
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-9, `${actual}`));

const bone = (position, quat = LEVEL, valid = true) => ({ position, quat_world_from_segment: quat, valid });

const standing = () => ({
  segments: {
    pelvis: bone([0, 1, 0]),
    thigh_left: bone([0, 0.95, -0.09]),
    shank_left: bone([0, 0.53, -0.09], LEVEL, false),
    thigh_right: bone([0, 0.95, 0.09]),
    shank_right: bone([0, 0.53, 0.09]),
  },
});

const now = (changes) => ({
  age_s: 0.1,
  phase: "estimating",
  message: "",
  sensors: [{ sensor: "a", state: "ok" }],
  segments: { a: "shank_left" },
  silent: [],
  heard: true,
  ...changes,
});

test("a quarter turn about each axis follows the right hand", () => {
  close(rotate([QUARTER, 0, 0, QUARTER], [1, 0, 0]), [0, 1, 0]);
  close(rotate([QUARTER, 0, QUARTER, 0], [1, 0, 0]), [0, 0, -1]);
  close(rotate([QUARTER, QUARTER, 0, 0], [0, 1, 0]), [0, 0, 1]);
});

test("facing left is a positive heading", () => {
  assert.ok(Math.abs(headingOf([QUARTER, 0, QUARTER, 0]) - Math.PI / 2) < 1e-9);
});

test("ankles hang below the knees by the shank's length and validity is kept per bone", () => {
  const figure = figureOf(standing(), BODY);
  close(figure.points.ankle_left, [0, 0.53 - 0.41, -0.09]);
  assert.equal(figure.valid.shank_left, false);
  assert.equal(figure.valid.shank_right, true);
});

test("a pose that lacks a bone is not drawn rather than guessed", () => {
  const pose = standing();
  delete pose.segments.shank_right;
  assert.equal(figureOf(pose, BODY), null);
  assert.equal(figureOf({ segments: {} }, BODY), null);
});

test("between two figures turns the short way round", () => {
  const figure = figureOf(standing(), BODY);
  const middle = between({ ...figure, heading: 3.1 }, { ...figure, heading: -3.1 }, 0.5);
  assert.ok(Math.abs(Math.abs(middle.heading) - Math.PI) < 1e-9);
});

test("no foot sinks into the floor", () => {
  const stage = new Stage();
  const figure = figureOf(standing(), BODY);
  stage.follow(figure, 0.05);
  figure.points.ankle_right = [0, -0.2, 0.09];
  stage.follow(figure, 0.05);
  assert.equal(stage.ground, -0.2);
});

test("each state has its word, the worst first", () => {
  assert.equal(stateOf(now()).word, "Live");
  assert.equal(stateOf(now({ age_s: null })).word, "No data yet");
  assert.equal(stateOf(now({ phase: "calibrating" })).word, "Calibrating - stand still");
  assert.equal(
    stateOf(now({ phase: "calibrating", message: "Walk a few steps" })).word,
    "Calibrating - walk a few steps",
  );
  assert.equal(stateOf(now({ age_s: 1.44 })).word, "Delayed (1.4 s)");
  assert.equal(stateOf(now({ age_s: 4, silent: ["estimation"] })).word, "Archive only (recording continues)");
  assert.equal(stateOf(now({ age_s: 4, silent: ["estimation", "archive"] })).word, "Delayed (4.0 s)");
  assert.equal(stateOf(now({ age_s: 4, silent: ["estimation"], heard: false })).word, "Delayed (4.0 s)");
  const lost = now({ sensors: [{ sensor: "a", state: "missing" }], phase: "calibrating" });
  assert.equal(stateOf(lost).word, "Left shank sensor lost");
  assert.equal(stateOf(now({ sensors: [{ sensor: "a", state: "stuck" }] })).word, "Check left shank sensor");
});

test("trouble is sorted first", () => {
  const states = [now(), now({ age_s: 9 }), now({ age_s: null }), now({ age_s: 2 })].map(stateOf);
  assert.deepEqual(
    states.toSorted(byTrouble).map((state) => state.tone),
    ["lost", "check", "wait", "good"],
  );
});

test("the line to the gateway is told apart from the services behind it", () => {
  assert.match(connectionOf(false, null).word, /Connection lost/);
  assert.match(connectionOf(true, { connected: false, silent: [] }).word, /No live data/);
  assert.match(connectionOf(true, { connected: true, silent: ["archive"] }).word, /Not recording/);
  assert.equal(connectionOf(true, { connected: true, silent: [] }).word, "Connected");
});

test("names are written for readers", () => {
  assert.equal(segmentName("shank_left"), "Left shank");
  assert.equal(segmentName("pelvis"), "Pelvis");
  assert.deepEqual(jointName("knee_flexion_right"), ["Knee flexion", "right"]);
  assert.equal(metricName("step_length_ratio_larger_to_smaller"), "Step length");
  assert.equal(metricGroup({ name: "stride_time_cv", side: null }), "variability");
  assert.equal(metricGroup({ name: "stride_time_sd", side: null }), null);
  assert.equal(metricGroup({ name: "stance_fraction", side: "left" }), "sides");
  assert.equal(metricGroup({ name: "rhythm_side_distance", side: null }), "legs");
  assert.equal(metricGroup({ name: "rhythm_distance_exemplar", side: "left" }), "sides");
  assert.equal(lastData(0.21), "last data 0.2 s ago");
});

test("numbers are shown in the reader's units", () => {
  assert.equal(degrees(Math.PI), 180);
  assert.equal(degrees(null), null);
  assert.equal(number(-3.21, 1), "−3.2");
  assert.equal(number(-0.01, 1), "0.0");
  assert.equal(number(null, 1), "–");
  assert.equal(clock(65.9), "1:05");
  assert.equal(clock(3661), "1:01:01");
  assert.equal(bytes(1_500_000), "1.5 MB");
  assert.deepEqual(shown("1", "stance_fraction"), { factor: 100, unit: "%", digits: 0 });
  assert.equal(shown("rad", "knee_flexion_range").unit, "°");
});

test("a lost line is opened again within two seconds, an ended one is not", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const opened = [];
  globalThis.location = { protocol: "http:", host: "here" };
  globalThis.WebSocket = class {
    constructor(url) {
      this.url = url;
      opened.push(this);
    }
    close() {}
  };
  let ended = 0;
  const states = [];
  const socket = new LiveSocket("/a", { onMessage() {}, onState: (open) => states.push(open), onEnd: () => ended++ });
  assert.equal(opened[0].url, "ws://here/v1/live/a");
  for (let round = 0; round < 5; round++) {
    opened.at(-1).onclose({ code: 1006 });
    context.mock.timers.tick(2000);
    assert.equal(opened.length, round + 2);
  }
  opened.at(-1).onopen();
  assert.deepEqual(states, [false, false, false, false, false, true]);
  context.mock.timers.tick(4000);
  assert.equal(states.at(-1), false, "silence is a lost line");
  context.mock.timers.tick(2000);
  opened.at(-1).onclose({ code: 1000 });
  context.mock.timers.tick(10000);
  assert.equal(ended, 1);
  assert.equal(opened.length, 7);
  assert.equal(socket.closed, true);
});
