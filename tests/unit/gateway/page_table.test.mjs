// The table of pages, addresses of the API, and who is told that the sign-in has ended. Run by test_page_modules.py.
import assert from "node:assert/strict";
import { test } from "node:test";

const sources = new URL("../../../services/gateway/web/src/", import.meta.url);
const { PAGES, addressOf, isFor, pageOf } = await import(new URL("pages.js", sources));
const { ApiProblem, address, get, post, remove, whenSignedOut } = await import(new URL("api.js", sources));
const { drawPassword } = await import(new URL("administration/first_password.js", sources));
const { actionWord, outcomeOf, verdictOn } = await import(new URL("administration/audit_words.js", sources));

const VIEWER = { login: "k.berger", may: ["known", "read"] };
const ADMIN = { login: "s.lind", may: ["known", "read", "work", "names", "administer", "operate"] };

test("an address names one page, with the parts that its pattern names", () => {
  assert.equal(pageOf("").page.name, "floor");
  assert.equal(pageOf("#/").page.name, "floor");
  const { page, params } = pageOf("#/patients/K7QM3F");
  assert.deepEqual([page.name, params], ["patient", { patient: "K7QM3F" }]);
  assert.deepEqual(pageOf("#/first-run").params, {});
  assert.deepEqual(pageOf("#/first-run/7KQM3F9TPX").params, { code: "7KQM3F9TPX" });
  for (const nowhere of ["#/nothing", "#/patients/a/b", "#/patients/<b>", "#/patients/%2e%2e"]) {
    assert.equal(pageOf(nowhere), null, nowhere);
  }
});

test("every page has a name, an address and a title of its own", () => {
  assert.equal(new Set(PAGES.map(({ name }) => name)).size, PAGES.length);
  assert.equal(new Set(PAGES.map(({ pattern }) => pattern)).size, PAGES.length);
  for (const { name, title, pattern, under, permission } of PAGES) {
    assert.ok(title, name);
    assert.ok(permission === null || ADMIN.may.includes(permission), name);
    if (under) assert.ok(PAGES.some((page) => page.name === under && page.nav), `${name} is under a page of the navigation`);
    const params = Object.fromEntries([...pattern.matchAll(/:(\w+)/g)].map(([, word]) => [word, "X1"]));
    assert.equal(pageOf(addressOf(name, params)).page.name, name);
  }
});

test("a page is for whoever has its permission", () => {
  const named = (name) => PAGES.find((page) => page.name === name);
  assert.deepEqual([isFor(named("audit"), ADMIN), isFor(named("audit"), VIEWER)], [true, false]);
  assert.deepEqual([isFor(named("bin"), VIEWER), isFor(named("floor"), VIEWER)], [false, true]);
  assert.deepEqual([isFor(named("sign-in"), null), isFor(named("floor"), null)], [true, false]);
});

test("what is in a path is encoded, and what is null is not asked", () => {
  assert.equal(address("/patients/{code}", { code: "a/b?c" }), "/v1/patients/a%2Fb%3Fc");
  assert.equal(address("/sessions", { limit: 20, state: null, offset: 0 }), "/v1/sessions?limit=20&offset=0");
  assert.equal(address("/patients/{code}/visits", { code: "X", limit: 1 }), "/v1/patients/X/visits?limit=1");
});

function answering(status, body) {
  const asked = [];
  globalThis.fetch = async (url, { method, body: sent }) => {
    asked.push([method, url, sent]);
    const json = async () => {
      if (body === undefined) throw new SyntaxError("no body");
      return body;
    };
    return { ok: status < 400, status, statusText: "Status", json };
  };
  return asked;
}

test("a body is sent beside what stands in the address", async () => {
  const asked = answering(201, { code: "K7QM3F" });
  const wish = { code: "K7QM3F", body: { date: "2026-11-22", kind: "surgery" } };
  assert.deepEqual(await post("/patients/{code}/treatments", wish), { code: "K7QM3F" });
  assert.deepEqual(asked, [["POST", "/v1/patients/K7QM3F/treatments", '{"date":"2026-11-22","kind":"surgery"}']]);
  answering(204);
  assert.equal(await remove("/keys/{key}", { key: "a1" }), undefined);
});

test("a sign-in that has ended is told, a wrong password is not that", async () => {
  let told = 0;
  whenSignedOut(() => (told += 1));
  const answer = { title: "Unauthorized", detail: "You are not signed in.", next_step: "Sign in.", faults: [] };
  answering(401, answer);
  await assert.rejects(get("/patients"), (problem) => problem instanceof ApiProblem && problem.status === 401);
  assert.equal(told, 1);
  await assert.rejects(post("/sign-in", { body: { login: "a", password: "b" } }), /You are not signed in\. Sign in\./);
  assert.equal(told, 1);
  answering(403, { ...answer, title: "Confirm your password" });
  await assert.rejects(post("/sign-out"), (problem) => problem.title === "Confirm your password");
  assert.equal(told, 1);
});

test("passwords to hand over are long, and never the same", () => {
  const drawn = Array.from({ length: 200 }, drawPassword);
  assert.equal(new Set(drawn).size, drawn.length);
  for (const password of drawn) assert.match(password, /^[2-9a-z]{4}(-[2-9a-z]{4}){3}$/);
  const letters = drawn.join("").replaceAll("-", "");
  const counts = [...new Set(letters)].map((letter) => letters.split(letter).length - 1);
  assert.equal(counts.length, 30);
  // 3200 letters, 107 of each; six standard deviations.
  assert.ok(counts.every((count) => Math.abs(count - 107) < 61), counts.join(" "));
});

test("the audit in words", () => {
  assert.equal(actionWord("read_patient"), "Read patient");
  assert.equal(outcomeOf(200).word, "Done");
  assert.equal(outcomeOf(403).tone, "lost");
  const whole = { intact: true, entries: 12, broken_entry: null, fault: null, signed_entry: null, signed_at: null };
  assert.deepEqual([verdictOn(whole).tone, verdictOn({ ...whole, intact: false, broken_entry: 7 }).tone], ["good", "lost"]);
  assert.match(verdictOn({ ...whole, intact: false, broken_entry: 7, fault: "It was changed." }).text, /entry 7.*changed/);
});
