// The page's pure modules. Run by test_page_modules.py, or: node --test tests/unit/gateway/page.test.mjs
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const { figureOf, headingOf, between, kneeFan, rotate } = await import(new URL("figure.js", sources));
const { Stage } = await import(new URL("stage.js", sources));
const { byTrouble, connectionOf, jointName, lastData, metricName, nobody, segmentName, stateOf } = await import(
  new URL("words.js", sources)
);
const { misplacedText } = await import(new URL("words.js", sources));
const { bytes, clock, degrees, number, shown } = await import(new URL("units.js", sources));
const { kneesOf } = await import(new URL("worn.js", sources));
const { measuresOf } = await import(new URL("repetition_counter.js", sources));
const { extentOf } = await import(new URL("phase_strip.js", sources));
const { attemptsOf } = await import(new URL("phase_timeline.js", sources));
const { ticksOf } = await import(new URL("drawing.js", sources));
const { Range } = await import(new URL("knee_panel.js", sources));
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

test("a pose without a whole leg is not drawn rather than guessed", () => {
  const pose = standing();
  delete pose.segments.shank_right;
  delete pose.segments.thigh_left;
  assert.equal(figureOf(pose, BODY), null);
  assert.equal(figureOf({ segments: {} }, BODY), null);
});

test("of a knee session one leg is drawn, from its hip, and nothing else", () => {
  const { thigh_left, shank_left } = standing().segments;
  const figure = figureOf({ segments: { thigh_left, shank_left } }, BODY);
  assert.deepEqual(figure.sides, ["left"]);
  assert.equal(figure.whole, false);
  close(figure.points.hip_left, [0, 0, 0]);
  close(figure.points.ankle_left, [0, -0.83, 0]);
  assert.ok(!Object.keys(figure.points).some((name) => name.endsWith("right") || /pelvis|neck/.test(name)));
});

test("both legs without a pelvis are drawn side by side", () => {
  const { pelvis, ...legs } = standing().segments;
  const figure = figureOf({ segments: legs }, BODY);
  assert.deepEqual(figure.sides, ["left", "right"]);
  assert.equal(figure.points.hip_right[2] - figure.points.hip_left[2], 0.18);
  assert.equal("pelvis_top" in figure.points, false);
});

const lifted = (angle) => [Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)];
const seatedLeg = (knee) => ({
  segments: {
    thigh_right: bone([0, 0.5, 0.09], lifted(Math.PI / 2)),
    shank_right: bone([0.42, 0.5, 0.09], lifted(Math.PI / 2 - knee)),
  },
});

test("a leg that sits faces forward, has a seat, and keeps the floor under a shank that is stretched out", () => {
  const stage = new Stage();
  const bent = figureOf(seatedLeg(Math.PI / 2), BODY);
  assert.ok(Math.abs(bent.heading) < 1e-9);
  stage.follow(bent, 0.05);
  assert.equal(stage.seated, true);
  assert.ok(Math.abs(stage.ground + 0.41) < 1e-9);
  stage.follow(figureOf(seatedLeg(0), BODY), 0.05);
  assert.ok(Math.abs(stage.ground + 0.41) < 1e-9);
  assert.equal(stage.seatHeight(bent) > 0.3, true);
  const { thigh_right, shank_right } = standing().segments;
  stage.follow(figureOf({ segments: { thigh_right, shank_right } }, BODY), 0.05);
  assert.equal(stage.seatHeight(bent), null);
});

test("the fan at a knee opens from the straight leg to the shank, as wide as its deviation", () => {
  const fan = kneeFan(figureOf(seatedLeg(Math.PI / 2), BODY), "right", 0.05);
  close(fan.open.at(0), [1, 0, 0]);
  close(fan.open.at(-1), [0, -1, 0]);
  const width = Math.acos(fan.spread[0].reduce((sum, value, axis) => sum + value * fan.spread.at(-1)[axis], 0));
  assert.ok(Math.abs(width - 0.2) < 1e-6);
  const doubtful = seatedLeg(1);
  doubtful.segments.shank_right.valid = false;
  assert.equal(kneeFan(figureOf(doubtful, BODY), "right", 0.05), null);
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

test("what is worn otherwise than declared is said in plain words", () => {
  assert.equal(stateOf(now({ misplaced: { left: ["other_leg"] } })).word, "Sides may be swapped");
  assert.equal(stateOf(now({ misplaced: { left: ["other_leg"] } })).tone, "check");
  assert.equal(stateOf(now({ misplaced: { right: ["swapped"] } })).word, "Thigh and shank may be swapped");
  assert.equal(stateOf(now({ misplaced: { right: ["shank_upside_down"] } })).word, "Right shank sensor upside down");
  assert.equal(stateOf(now({ misplaced: {}, age_s: 0.1 })).word, "Live");
  assert.match(misplacedText({ left: ["thigh_upside_down", "other_leg"] }), /left thigh .* upside down.*right leg/);
  assert.equal(misplacedText({}), "");
  assert.equal(misplacedText(undefined), "");
});

test("only what the sensors can tell is shown", () => {
  const worn = (...segments) => segments.map((segment) => ({ segment }));
  assert.deepEqual(kneesOf(worn("thigh_left", "shank_left")), ["left"]);
  assert.deepEqual(kneesOf(worn("thigh_left", "shank_left", "thigh_right", "shank_right")), ["left", "right"]);
  assert.equal(kneesOf(worn("pelvis", "thigh_left", "shank_left")), null);
  assert.equal(kneesOf(worn("foot_left")), null);
});

test("a repetition is measured the same way whichever end it rests at", () => {
  const times = { start_s: 1, turn_s: 2, end_s: 4 };
  const flexing = measuresOf({ start_angle: 0.1, turn_angle: 1.9, end_angle: 0, ...times });
  assert.deepEqual(
    [flexing.smallest, flexing.largest, flexing.range, flexing.flexing_s, flexing.extending_s],
    [0, 1.9, 1.9, 1, 2],
  );
  const seated = measuresOf({ start_angle: 1.6, turn_angle: 0.1, end_angle: 1.5, ...times });
  assert.deepEqual([seated.smallest, seated.largest, seated.flexing_s, seated.extending_s], [0.1, 1.6, 2, 1]);
});

test("a timed test lasts from standing up until the person sits", () => {
  const phase = (name, start_s, end_s) => ({ phase: name, start_s, end_s, start_std_s: 0.03, end_std_s: 0.04 });
  assert.deepEqual(extentOf([]), { from: null, to: null, spread_s: null, given_up: false });
  const given_up = extentOf([phase("sit_to_stand", 2, 3), { ...phase("walk_out", 3, 5), end_std_s: null }]);
  assert.deepEqual([given_up.from, given_up.to, given_up.given_up], [2, null, true]);
  assert.equal(extentOf([phase("sit_to_stand", 2, 3), phase("walk_out", 3, null)]).to, null);
  const done = extentOf([phase("sit_to_stand", 2, 3), phase("turn_to_sit", 9, 12)]);
  assert.deepEqual([done.from, done.to], [2, 12]);
  assert.ok(Math.abs(done.spread_s - 0.05) < 1e-12);
  const attempts = attemptsOf([
    { attempt: 0, ...phase("sit_to_stand", 2, 3) },
    { attempt: 1, ...phase("sit_to_stand", 22, 23) },
  ]);
  assert.deepEqual(
    attempts.map((each) => [each.attempt, each.from]),
    [
      [0, 2],
      [1, 22],
    ],
  );
});

test("axes are divided into round parts", () => {
  assert.deepEqual(ticksOf(0, 12.5, 6), [0, 5, 10]);
  assert.deepEqual(ticksOf(0, 4, 5), [0, 1, 2, 3, 4]);
  assert.deepEqual(ticksOf(-10, 120, 7), [0, 20, 40, 60, 80, 100, 120]);
});

test("the range so far takes known angles only", () => {
  const range = new Range();
  range.add(undefined);
  assert.equal(range.least, null);
  for (const angle of [0.4, 0.1, undefined, 1.1]) range.add(angle);
  assert.deepEqual([range.least, range.largest], [0.1, 1.1]);
  range.reset();
  assert.equal(range.largest, null);
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

test("a first start says what it does instead of being silent", () => {
  const first = { connected: true, silent: [], preparing: ["estimation"] };
  const said = "Getting ready: estimators are being compiled, about a minute and a half";
  assert.deepEqual(connectionOf(true, first), { word: said, tone: "wait" });
  assert.match(connectionOf(true, { ...first, silent: ["archive"] }).word, /Not recording/);
  assert.equal(connectionOf(true, { ...first, preparing: [] }).word, "Connected");
  assert.match(nobody(true, ["segmentation"]).advice, /analyses are being compiled/);
  assert.equal(nobody(true).title, "Nobody walks just now");
  assert.equal(stateOf(now({ age_s: null, preparing: ["estimation"] })).word, "Getting ready");
  assert.equal(stateOf(now({ age_s: null, preparing: ["segmentation"] })).word, "No data yet");
});

test("names are written for readers", () => {
  assert.equal(segmentName("shank_left"), "Left shank");
  assert.equal(segmentName("pelvis"), "Pelvis");
  assert.deepEqual(jointName("knee_flexion_right"), ["Knee flexion", "right"]);
  assert.equal(metricName("step_length_ratio_larger_to_smaller"), "Step length, larger / smaller side");
  assert.equal(metricName("stance_time_ratio_paretic_to_non_paretic"), "Stance time, paretic / non-paretic");
  assert.equal(metricName("stride_time_cv"), "Stride time, variation");
  assert.equal(metricName("double_support_fraction"), "Double support");
  assert.equal(metricName("tug_time"), "Timed up and go");
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
