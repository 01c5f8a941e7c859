// Live pages of walking tests, and what a start dialog says of how a test is done.
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const load = (name) => import(new URL(name, sources));
const { walkSoFar, withPhase } = await load("walk_strip.js");
const { extentOf } = await load("phase_strip.js");
const { conditionWords } = await load("condition_words.js");
const { metricName } = await load("words.js");
const { shown } = await load("units.js");
const { valueOf } = await load("conditions_form.js");

const part = (phase, start_s, end_s, distance_m = null) => ({
  phase,
  start_s,
  end_s,
  distance_m,
  start_std_s: 0.1,
  end_std_s: end_s === null ? null : 0.1,
});
const stride = (side, start_s, stride_length_m) => ({ side, start_s, stride_length_m });

test("a part that ends takes the place of the one that began, whatever came between", () => {
  let phases = [];
  for (const each of [part("walk", 5, null), part("walk", 5.02, 30, 28), part("turn", 30, null), part("turn", 30, 32)])
    phases = withPhase(phases, each);
  assert.deepEqual(
    phases.map((each) => [each.phase, each.start_s, each.end_s]),
    [
      ["walk", 5.02, 30],
      ["turn", 30, 32],
    ],
  );
  phases = withPhase(phases, part("walk", 32, null));
  assert.equal(phases.length, 3);
  assert.equal(withPhase(phases, part("turn", 30, 32)).length, 3, "what is told twice is there once");
});

test("a walk for time counts down from its first step, with lengths, rests and metres", () => {
  assert.equal(walkSoFar([], [], 4, 360), null);
  const phases = [part("walk", 5, 30, 28), part("turn", 30, 32, 1), part("rest", 32, 50, 0), part("walk", 50, null)];
  const strides = [stride("left", 51, 1.2), stride("right", 51.6, 1.1), stride("left", 52.2, 1.3), stride("left", 20, 9)];
  const walk = walkSoFar(phases, strides, 125, 360);
  assert.equal(walk.remaining_s, 240);
  assert.equal(walk.minute, 3);
  assert.deepEqual([walk.phase, walk.lengths, walk.rests, walk.rested_s], ["walk", 1, 1, 18]);
  assert.ok(Math.abs(walk.distance_m - (29 + (1.2 + 1.1 + 1.3) / 2)) < 1e-9, `${walk.distance_m}`);
});

test("after its time a walk counts no further, and a rest not beyond the end", () => {
  const walk = walkSoFar([part("walk", 0, 100, 90), part("rest", 100, null)], [], 500, 360);
  assert.deepEqual([walk.over, walk.remaining_s, walk.minute, walk.rested_s], [true, 0, null, 260]);
});

test("metres that nobody measures are not made up", () => {
  const walk = walkSoFar([part("walk", 0, null)], [{ ...stride("left", 1, 1), stride_length_m: null }], 10, 360);
  assert.equal(walk.distance_m, null);
});

test("the result of a ten-metre walk is its timed zone alone", () => {
  const zone = { first: "timed_zone", last: "timed_zone" };
  assert.equal(extentOf([part("run_up", 1, 3)], zone).from, null);
  const { from, to, spread_s } = extentOf([part("run_up", 1, 3), part("timed_zone", 3, 8), part("run_out", 8, 10)], zone);
  assert.deepEqual([from, to], [3, 8]);
  assert.ok(Math.abs(spread_s - Math.hypot(0.1, 0.1)) < 1e-9);
});

test("how a test was done is told as far as somebody said so", () => {
  assert.deepEqual(conditionWords(null), []);
  const unsaid = { aid: null, orthosis: null, footwear: null, physical_assistance: null, start: null };
  assert.deepEqual(conditionWords(unsaid), []);
  const said = { ...unsaid, aid: "cane", physical_assistance: true, speed_instruction: "fast", start: "walking" };
  assert.deepEqual(conditionWords(said), [
    "Cane",
    "with physical assistance",
    "pace: as fast as is safe",
    "start: already walking",
  ]);
});

test("what is said in the start dialog goes out in seconds, metres and yes or no", () => {
  assert.equal(valueOf("test_duration_s", { value: "6" }), 360);
  assert.equal(valueOf("timed_from_m", { value: "2" }), 2);
  assert.equal(valueOf("physical_assistance", { value: "false" }), false);
  assert.equal(valueOf("aid", { value: "rollator" }), "rollator");
});

test("what a walking test amounts to is named and shown in its unit", () => {
  assert.equal(metricName("six_minute_walk_distance"), "Six-minute walk distance");
  assert.equal(metricName("six_minute_walk_speed_slope"), "Speed slope");
  assert.deepEqual(shown("1", "six_minute_walk_laps"), { factor: 1, unit: "", digits: 0 });
  assert.deepEqual(shown("1", "ten_metre_walk_trials_aborted"), { factor: 1, unit: "", digits: 0 });
  assert.deepEqual(shown("m", "six_minute_walk_distance"), { factor: 1, unit: "m", digits: 1 });
});
