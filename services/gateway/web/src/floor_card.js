// One person on the floor: who, how the sensors are, what is being done and how far.
import { isExercise } from "./arrangement.js";
import { el, say } from "./dom.js";
import { extentOf } from "./phase_strip.js";
import { clock, number } from "./units.js";
import { PHASES, TASKS, lastData, misplacedText } from "./words.js";

/** @typedef {import("./floor_states.js").Entry} Entry */

export class FloorCard {
  /** @param {any} session */
  constructor(session) {
    this.who = el("h2", { class: "who" });
    this.name = el("span", { class: "person", hidden: true });
    this.light = el("span", { class: "chip light" });
    this.task = el("p", { class: "task" });
    this.alarm = el("p", { class: "alarm" });
    this.facts = ["time", "second", "third"].map(() => ({ name: el("dt"), value: el("dd") }));
    this.age = el("p", { class: "quiet" });
    this.node = el(
      "a",
      { class: "card", href: `#/sessions/${session.id}` },
      el("div", { class: "card-head" }, this.who, this.light),
      this.name,
      this.task,
      el("dl", { class: "facts" }, ...this.facts.map(({ name, value }) => el("div", {}, name, value))),
      this.alarm,
      this.age,
    );
  }

  /** @param {Entry} entry @param {string|undefined} name from the clinic's directory, while names are shown */
  show({ session, age_s, word, tone, light, stale }, name) {
    say(this.who, session.patient ?? "Unassigned");
    this.who.classList.toggle("code", session.patient !== null);
    this.name.hidden = name === undefined;
    say(this.name, name ?? "");
    say(this.light, light);
    this.light.dataset.tone = this.node.dataset.tone = tone;
    const task = TASKS[session.task] ?? "";
    say(this.task, session.title.startsWith(task) ? session.title : `${task}: ${session.title}`);
    factsOf(session).forEach(([label, value], place) => {
      say(this.facts[place].name, label);
      say(this.facts[place].value, value);
    });
    const advice = (session.phase === "estimating" && session.message) || misplacedText(session.misplaced);
    say(this.alarm, tone === "good" ? advice : [word, advice].filter(Boolean).join(". "));
    this.alarm.title = this.alarm.textContent;
    say(this.age, lastData(age_s));
    this.node.classList.toggle("stale", stale);
  }
}

/** Three facts that matter for what the person does. @param {any} session @returns {[string, string][]} */
export function factsOf(session) {
  /** @type {[string, string]} */
  const time = ["Time", clock(session.elapsed_s)];
  if (isExercise(session.task)) return [time, ["Repetitions", String(session.repetitions)], ["", ""]];
  if (session.task === "timed_up_and_go") return [time, ...timedFacts(session.task_phases)];
  const cadence = session.cadence_per_min === null ? "–" : `${number(session.cadence_per_min, 0)} /min`;
  return [time, ["Cadence", cadence], ["Strides", String(session.strides)]];
}

/** @param {any[]} phases @returns {[string, string][]} */
function timedFacts(phases) {
  const running = phases.find((phase) => phase.end_s === null);
  const { from, to, given_up } = extentOf(phases);
  const total = to === null ? "–" : `${number(to - from, 1)} s`;
  const over = given_up ? "Given up" : to === null ? "–" : "Done";
  return [
    ["Part", running ? PHASES[running.phase] : over],
    ["Total", total],
  ];
}
