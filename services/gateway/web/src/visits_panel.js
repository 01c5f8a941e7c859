// The visits of a patient, newest first: what was done, how, the main numbers, and from which visit progress counts.
import { put } from "./api.js";
import { conditionWords } from "./condition_words.js";
import { el, fill, say, table } from "./dom.js";
import { GRADES } from "./trust_words.js";
import { number, shown } from "./units.js";
import { STORED_WORDS, TASKS, metricName } from "./words.js";

const MAIN_NUMBERS = 2;

export class VisitsPanel {
  constructor(code, { onChange }) {
    this.code = code;
    this.onChange = onChange;
    this.rows = el("tbody");
    this.told = el("p", { class: "quiet", role: "status" });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Visits" },
      el("h2", {}, "Visits"),
      table(["Visit", "Day", "Test", "How", "Main numbers", "Report", "Progress counts from"], this.rows),
      this.told,
    );
  }

  /** @param {object[]} visits newest first, as the API gives them */
  show(visits) {
    const rows = visits.flatMap((visit) => visit.sessions.map((session, place) => this.row(visit, session, place)));
    const none = el("tr", {}, el("td", { colspan: 7, class: "quiet" }, "No session is linked to this patient yet."));
    fill(this.rows, ...(rows.length > 0 ? rows : [none]));
  }

  row({ visit, day, baseline, sessions }, session, place) {
    const first = place === 0 ? { rowspan: sessions.length } : null;
    const numbers = session.metrics.filter((metric) => metric.side === null).slice(0, MAIN_NUMBERS);
    return el(
      "tr",
      {},
      first && el("th", { scope: "rowgroup", ...first }, String(visit)),
      first && el("td", first, day),
      el("td", {}, TASKS[session.task] ?? session.title),
      el("td", { class: "quiet" }, conditionWords(session.conditions).join(", ") || "not said"),
      el("td", {}, ...(numbers.length > 0 ? numbers.map(mainNumber) : [STORED_WORDS[session.state].word])),
      el("td", {}, el("a", { href: `#/sessions/${session.session}` }, "Report")),
      first && el("td", first, baseline ? el("b", {}, "Baseline") : this.chooser(visit, sessions)),
    );
  }

  chooser(visit, sessions) {
    const usable = sessions.find((session) => session.usable);
    if (!usable) return el("span", { class: "quiet" }, "not usable: needs final numbers and how the test was done");
    const choose = () => this.choose(usable.session);
    return el(
      "button",
      { class: "quiet-button", type: "button", "aria-label": `Count progress from visit ${visit}`, onclick: choose },
      "Count from here",
    );
  }

  async choose(session) {
    try {
      await put("/patients/{code}/baseline", { code: this.code, body: { session } });
      say(this.told, "Thresholds are chosen by the speed at this visit and stay so.");
      this.onChange();
    } catch (problem) {
      say(this.told, problem.message);
    }
  }
}

function mainNumber({ name, unit, value, grade }) {
  const scale = shown(unit, name);
  const text = value === null ? "–" : `${number(value * scale.factor, scale.digits)} ${scale.unit}`;
  return el(
    "div",
    {},
    `${metricName(name)} ${text} `,
    el("span", { class: "quiet" }, `(trust: ${GRADES[grade].word.toLowerCase()})`),
  );
}
