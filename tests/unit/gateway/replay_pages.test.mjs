// The parts of a replay that need no page: its clock, its pictures, what happened when, and what a timeline draws.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Happenings } from "../../../services/gateway/web/src/ended/happenings.js";
import { joined, nothingYet } from "../../../services/gateway/web/src/ended/history.js";
import { Player } from "../../../services/gateway/web/src/ended/player.js";
import { PoseStore, countUntil } from "../../../services/gateway/web/src/ended/pose_store.js";
import { strideAt, strideWords } from "../../../services/gateway/web/src/ended/stride_place.js";
import { lanesOf } from "../../../services/gateway/web/src/ended/timeline.js";

/** Animation frames by hand: `run(ms)` lets that much time pass, sixty frames a second. */
function frames() {
  const waiting = new Map();
  let [now, count] = [0, 0];
  globalThis.performance = { now: () => now };
  globalThis.requestAnimationFrame = (callback) => {
    waiting.set(++count, callback);
    return count;
  };
  globalThis.cancelAnimationFrame = (id) => waiting.delete(id);
  return (ms) => {
    for (const end = now + ms; now < end; ) {
      now += 1000 / 60;
      const due = [...waiting];
      waiting.clear();
      for (const [, callback] of due) callback(now);
    }
  };
}

function player(end_s, isReady = () => true) {
  const told = [];
  const made = new Player(end_s, { isReady, onTime: (jumped) => told.push(jumped), onState: () => {} });
  return { made, told };
}

test("a replay goes as fast as asked, and stops at the end", () => {
  const run = frames();
  const { made } = player(10);
  made.play();
  run(1000);
  assert.ok(Math.abs(made.at_s - 1) < 0.05, `${made.at_s}`);
  made.speed = 4;
  run(1000);
  assert.ok(Math.abs(made.at_s - 5) < 0.15, `${made.at_s}`);
  run(3000);
  assert.equal(made.at_s, 10);
  assert.equal(made.playing, false);
  made.play();
  assert.ok(made.at_s < 0.1, "it begins again");
});

test("a replay waits where there is nothing to show yet, and is sought within its bounds", () => {
  const run = frames();
  let ready = false;
  const { made, told } = player(10, (at_s) => ready || at_s < 2);
  made.seek(1.5);
  made.play();
  run(3000);
  assert.ok(made.at_s < 2 && made.waiting);
  ready = true;
  run(500);
  assert.ok(made.at_s > 2 && !made.waiting);
  made.seek(-4);
  assert.equal(made.at_s, 0);
  made.seek(99);
  assert.equal(made.at_s, 10);
  assert.equal(told.filter(Boolean).length, 3);
});

function store(poses) {
  const asked = [];
  globalThis.fetch = async (url) => {
    const query = new URL(url, "http://ambula").searchParams;
    const [from_s, to_s] = [Number(query.get("from_s")), Number(query.get("to_s"))];
    asked.push(from_s);
    const page = { poses: poses.filter(({ at_s }) => at_s >= from_s && at_s < to_s) };
    return { ok: true, json: async () => page };
  };
  const made = new PoseStore("s", 400, { onLoaded: () => {}, onTrouble: assert.fail });
  return { made, asked };
}
const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

test("pictures are had ten seconds at a time, with those that come next, and not all are kept", async () => {
  const poses = Array.from({ length: 4000 }, (_, k) => ({ at_s: k / 10 }));
  const { made, asked } = store(poses);
  made.need(5);
  await settled();
  assert.deepEqual(asked, [0, 10]);
  made.need(5);
  await settled();
  assert.deepEqual(asked, [0, 10], "nothing is asked for twice");
  assert.equal(made.at(5.04).at_s, 5);
  assert.equal(made.at(10).at_s, 10);
  assert.deepEqual(made.between(9.75, 10.05).map(({ at_s }) => at_s), [9.8, 9.9, 10]);
  for (let at_s = 0; at_s < 400; at_s += 10) {
    made.need(at_s + 5);
    await settled();
    assert.equal(made.at(at_s + 5).at_s, at_s + 5);
  }
  assert.ok(made.chunks.size <= 13, `${made.chunks.size} are kept`);
  assert.equal(made.isReady(5), false);
});

test("whoever drags over an hour asks for a few moments, the last one among them", async () => {
  const { made, asked } = store([]);
  for (let at_s = 0; at_s <= 395; at_s += 5) made.need(at_s);
  for (let turn = 0; turn < 5; turn += 1) await settled();
  assert.ok(asked.length <= 6, `${asked}`);
  assert.ok(asked.includes(390));
});

test("a picture of a moment may lie before a gap", async () => {
  const { made } = store([{ at_s: 8 }, { at_s: 14 }]);
  made.need(9);
  await settled();
  assert.equal(made.at(12).at_s, 8);
  assert.equal(made.at(7), null);
});

test("what happened is told once in its order, and anew after a jump back", () => {
  const told = [];
  const happenings = new Happenings();
  happenings.add([3, 1, 2].map((at_s) => ({ at_s, tell: () => told.push(at_s) })));
  assert.ok(happenings.needsReset(0));
  happenings.reset();
  happenings.advance(2.5);
  happenings.advance(2.5);
  assert.deepEqual(told, [1, 2]);
  assert.ok(happenings.needsReset(1.5));
  happenings.reset();
  happenings.advance(9);
  assert.deepEqual(told, [1, 2, 1, 2, 3]);
});

test("how many lie at or before a time", () => {
  const sorted = [1, 2, 2, 5].map((at_s) => ({ at_s }));
  assert.deepEqual([0, 1, 2, 4.9, 5, 9].map((at_s) => countUntil(sorted, at_s)), [0, 1, 3, 3, 4, 4]);
});

test("a moment is in the stride that ends first, and in none between two", () => {
  const stride = (side, start_s, end_s, valid = true) => ({ side, index: 4, start_s, end_s, valid, rejected_because: "turn" });
  const strides = [stride("left", 1, 2.1), stride("right", 1.5, 2.6), stride("left", 4, 5, false)];
  const ends = strides.map(({ end_s }) => ({ at_s: end_s }));
  const places = [0.5, 1, 1.6, 2.2, 3, 4.5, 6].map((at_s) => strideAt(strides, ends, at_s));
  assert.deepEqual(places, [null, 0, 0, 1, null, 2, null]);
  assert.equal(strideWords(strides[1]), "Right stride 5");
  assert.equal(strideWords(strides[2]), "Left stride 5, does not count: turn");
});

test("a loss that goes on over the end of a page is one loss", () => {
  const loss = (source, start_s, end_s) => ({ source, kind: "missing", start_s, end_s });
  const first = [loss("a", 10, 12), loss("b", 590, null), loss("c", 595, null)];
  const second = [loss("b", 599, 610), loss("a", 700, 705)];
  assert.deepEqual(joined(first, second, 600), [
    loss("a", 10, 12),
    loss("b", 590, 610),
    loss("c", 595, 600),
    loss("a", 700, 705),
  ]);
});

test("a timeline has a lane only for what there is", () => {
  const stride = (side, start_s, more) => ({ side, start_s, end_s: start_s + 1, valid: true, turning: false, ...more });
  const past = {
    ...nothingYet(),
    strides: [stride("left", 1), stride("right", 1.5, { valid: false }), stride("left", 2, { turning: true })],
    losses: [{ source: "imu7", kind: "missing", start_s: 4, end_s: null }],
  };
  const lanes = lanesOf(past, ["left", "right"], { imu7: "shank_left" });
  assert.deepEqual(lanes.map(({ name }) => name), ["Turns", "L strides", "R strides", "Losses"]);
  assert.deepEqual(lanes[2].parts.map(({ look }) => look), ["refused"]);
  assert.deepEqual(lanes[3].parts, [{ from_s: 4, to_s: null, look: "lost", text: "Left shank" }]);
  const timed = { ...past, phases: [{ task: "timed_up_and_go", phase: "turn", start_s: 3, end_s: 4 }] };
  assert.deepEqual(lanesOf(timed, [], {})[0], {
    name: "Parts",
    height: 16,
    parts: [{ from_s: 3, to_s: 4, look: "turn", text: "Turn" }],
  });
  assert.deepEqual(lanesOf(nothingYet(), ["left", "right"], {}), []);
});
