// The floor: who walks now, trouble first, and what has been recorded.
import { get } from "./api.js";
import { isExercise } from "./arrangement.js";
import { el, fill, say, table } from "./dom.js";
import { extentOf } from "./phase_strip.js";
import { clock, number, when } from "./units.js";
import { PHASES, STALE_S, STORED_WORDS, byTrouble, lastData, misplacedText, nobody, stateOf } from "./words.js";

const PAGE = 20;
const COLUMNS = ["Session", "Patient", "Started", "Length#", "Strides#", "Speed#", "Cadence#", "State"];

/** @param {import("./pages.js").Place} place */
export const open = ({ host, app }) => new FloorView(host, { startSession: () => app.startSession() });

export class FloorView {
  constructor(host, { startSession }) {
    this.cards = new Map();
    this.offset = 0;
    this.live = el("div", { class: "cards" });
    const { title, advice } = nobody(true);
    this.emptyTitle = el("h2", {}, title);
    this.emptyAdvice = el("p", {}, advice);
    const go = el("button", { class: "primary", type: "button", onclick: startSession }, "Start a session");
    this.empty = el("div", { class: "empty" }, this.emptyTitle, this.emptyAdvice, go);
    this.rows = el("tbody");
    this.total = el("span", { class: "quiet" });
    this.filter = el(
      "select",
      { "aria-label": "Show sessions in state", onchange: () => this.turn(0) },
      el("option", { value: "" }, "All"),
      ...Object.entries(STORED_WORDS).map(([state, { word }]) => el("option", { value: state }, word)),
    );
    this.newer = el("button", { type: "button", onclick: () => this.turn(this.offset - PAGE) }, "Newer");
    this.older = el("button", { type: "button", onclick: () => this.turn(this.offset + PAGE) }, "Older");
    fill(
      host,
      el("section", { "aria-label": "Running sessions" }, el("h1", {}, "Now"), this.empty, this.live),
      el(
        "section",
        { class: "panel", "aria-label": "Recorded sessions" },
        el(
          "div",
          { class: "panel-head" },
          el("h2", {}, "Sessions"),
          this.total,
          el("span", { class: "spring" }),
          this.filter,
          this.newer,
          this.older,
        ),
        table(COLUMNS, this.rows),
      ),
    );
    this.refresh();
    this.timer = setInterval(() => this.refresh(), 5000);
  }

  turn(offset) {
    this.offset = Math.max(0, offset);
    this.refresh();
  }

  async refresh() {
    const state = /** @type {any} */ (this.filter.value || null);
    const page = await get("/sessions", { limit: PAGE, offset: this.offset, state }).catch(() => null);
    if (!page) return;
    say(this.total, `${page.total} in all`);
    this.newer.disabled = this.offset === 0;
    this.older.disabled = this.offset + PAGE >= page.total;
    fill(
      this.rows,
      page.items.length > 0
        ? page.items.map(row)
        : el("tr", {}, el("td", { colspan: 8, class: "quiet" }, "No sessions yet.")),
    );
  }

  /** The newest list of running sessions. */
  onFloor(status) {
    this.status = status;
    this.arrived = performance.now();
    this.tick();
  }

  /** Ages grow between messages, and when there are none. */
  tick() {
    if (!this.status) return;
    const since = (performance.now() - this.arrived) / 1000;
    const entries = this.status.sessions.map((session) => {
      const age_s = session.age_s === null ? null : session.age_s + Math.max(0, since - 0.5);
      const state = stateOf({
        ...session,
        age_s,
        segments: session.sensor_segments,
        silent: this.status.silent,
        heard: this.status.connected,
      });
      return { session, age_s, ...state };
    });
    entries.sort((x, y) => byTrouble(x, y) || x.session.started_unix_s - y.session.started_unix_s);
    this.empty.hidden = entries.length > 0;
    const { title, advice } = nobody(this.status.connected);
    say(this.emptyTitle, title);
    say(this.emptyAdvice, advice);
    this.show(entries);
  }

  show(entries) {
    const kept = new Set(entries.map((entry) => entry.session.id));
    for (const [id, card] of this.cards) {
      if (!kept.has(id)) {
        card.node.remove();
        this.cards.delete(id);
        setTimeout(() => this.refresh(), 500);
      }
    }
    entries.forEach((entry, place) => {
      const card = this.cards.get(entry.session.id) ?? this.addCard(entry.session);
      card.show(entry);
      if (this.live.children[place] !== card.node) this.live.insertBefore(card.node, this.live.children[place] ?? null);
    });
  }

  addCard(session) {
    const card = new Card(session);
    this.cards.set(session.id, card);
    this.refresh();
    return card;
  }

  dispose() {
    clearInterval(this.timer);
  }
}

class Card {
  constructor(session) {
    this.title = el("h2");
    this.code = el("span", { class: "code" });
    this.word = el("p", { class: "chip" });
    this.advice = el("p", { class: "advice" });
    this.facts = ["time", "second", "third"].map(() => ({ name: el("dt"), value: el("dd") }));
    this.age = el("p", { class: "quiet" });
    const facts = el("dl", { class: "facts" }, ...this.facts.map(({ name, value }) => el("div", {}, name, value)));
    this.node = el(
      "a",
      { class: "card", href: `#/sessions/${session.id}` },
      this.title,
      this.word,
      facts,
      this.advice,
      el("div", { class: "card-foot" }, this.age, this.code),
    );
  }

  show({ session, age_s, word, tone }) {
    say(this.title, session.title);
    say(this.code, session.patient ?? "unassigned");
    say(this.word, word);
    this.word.title = word;
    this.word.dataset.tone = tone;
    this.node.dataset.tone = tone;
    factsOf(session).forEach(([name, value], place) => {
      say(this.facts[place].name, name);
      say(this.facts[place].value, value);
    });
    say(this.advice, (session.phase === "estimating" && session.message) || misplacedText(session.misplaced));
    this.advice.title = this.advice.textContent;
    say(this.age, lastData(age_s));
    this.node.classList.toggle("stale", age_s !== null && age_s > STALE_S);
  }
}

/** Three facts that matter for what the person does. */
function factsOf(session) {
  const time = ["Time", clock(session.elapsed_s)];
  if (isExercise(session.task)) return [time, ["Repetitions", String(session.repetitions)], ["", ""]];
  if (session.task === "timed_up_and_go") return [time, ...timedFacts(session.task_phases)];
  const cadence = session.cadence_per_min === null ? "–" : `${number(session.cadence_per_min, 0)} /min`;
  return [time, ["Cadence", cadence], ["Strides", String(session.strides)]];
}

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

const withUnit = (value, digits, unit) => (value ? `${number(value, digits)} ${unit}` : "–");

function row(session) {
  const { word, tone } = STORED_WORDS[session.state];
  const best = session.highlights;
  return el(
    "tr",
    {},
    el("td", {}, el("a", { href: `#/sessions/${session.id}` }, session.title)),
    el(
      "td",
      {},
      session.patient ? el("span", { class: "code" }, session.patient) : el("span", { class: "quiet" }, "unassigned"),
    ),
    el("td", {}, when(session.started ?? session.created)),
    el("td", { class: "number" }, session.ended ? clock(session.duration_s) : "–"),
    el("td", { class: "number" }, best?.strides ? String(best.strides) : "–"),
    el("td", { class: "number" }, withUnit(best?.walking_speed, 2, "m/s")),
    el("td", { class: "number" }, withUnit(best?.cadence_per_min, 0, "/min")),
    el("td", {}, el("span", { class: "chip small", "data-tone": tone }, word)),
  );
}
