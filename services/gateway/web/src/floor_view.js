// The floor: who moves now, trouble first, and what has been recorded.
import { el, fill, say } from "./dom.js";
import { FloorCard } from "./floor_card.js";
import { FloorNames } from "./floor_names.js";
import { countsOf, entriesOf, needsLook } from "./floor_states.js";
import { RecordedList } from "./recorded_list.js";
import { TroubleNotice } from "./trouble_notice.js";
import { nobody } from "./words.js";

/** Messages come twice a second; only when they stay away do ages grow by themselves. */
const OVERDUE_S = 0.55;
/** More cards than that are drawn narrower, so that sixteen still fit on a small screen. */
const ROOMY = 8;

/** @param {import("./pages.js").Place} place */
export const open = ({ host, app }) =>
  new FloorView(host, { startSession: () => app.startSession(), may: app.me.may });

export class FloorView {
  /** @param {HTMLElement} host @param {{startSession: () => void, may: string[]}} app */
  constructor(host, { startSession, may }) {
    /** @type {Map<string, FloorCard>} */
    this.cards = new Map();
    this.names = new FloorNames({ may, onChange: () => this.draw() });
    this.notice = new TroubleNotice();
    this.recorded = new RecordedList();
    this.live = el("div", { class: "cards" });
    this.counts = el("p", { class: "counts", role: "status" });
    this.wish = el("input", { type: "search", placeholder: "Find a code", "aria-label": "Find a code", oninput: () => this.draw() });
    this.none = el("p", { class: "quiet", hidden: true }, "Nobody here has such a code.");
    const { title, advice } = nobody(true);
    this.emptyTitle = el("h2", {}, title);
    this.emptyAdvice = el("p", {}, advice);
    const go = el("button", { class: "primary", type: "button", onclick: startSession }, "Start a session");
    go.hidden = !may.includes("work");
    this.empty = el("div", { class: "empty" }, this.emptyTitle, this.emptyAdvice, go);
    this.tools = el("span", { class: "floor-tools" }, this.wish, this.names.button, this.notice.node);
    const head = el("div", { class: "floor-head" }, el("h1", {}, "Now"), this.counts, el("span", { class: "spring" }), this.tools);
    fill(
      host,
      el("section", { "aria-label": "Running sessions" }, head, this.empty, this.none, this.live),
      this.recorded.node,
    );
  }

  /** The newest list of running sessions. @param {any} status */
  onFloor(status) {
    this.status = status;
    this.arrived = performance.now();
    this.draw();
  }

  /** Between messages nothing is drawn; when there are none, ages grow and cards turn grey. */
  tick() {
    if (this.status && performance.now() - this.arrived > 1000 * OVERDUE_S) this.draw();
  }

  draw() {
    if (!this.status) return;
    const entries = entriesOf(this.status, (performance.now() - this.arrived) / 1000);
    this.names.need(entries.map(({ session }) => session.patient));
    this.notice.hear(entries.filter(needsLook).map(({ session }) => session.id));
    say(this.counts, countsOf(entries));
    this.empty.hidden = entries.length > 0;
    this.tools.hidden = entries.length === 0;
    const { title, advice } = nobody(this.status.connected, this.status.preparing);
    say(this.emptyTitle, title);
    say(this.emptyAdvice, advice);
    const found = entries.filter((entry) => this.isWished(entry.session));
    this.none.hidden = found.length > 0 || entries.length === 0;
    this.live.classList.toggle("dense", found.length > ROOMY);
    this.live.classList.toggle("named", this.names.shown);
    this.show(found, new Set(entries.map(({ session }) => session.id)));
  }

  /** @param {any} session */
  isWished({ patient, title }) {
    const wish = this.wish.value.trim().toLowerCase();
    return [patient ?? "", title, this.names.of(patient) ?? ""].some((text) => text.toLowerCase().includes(wish));
  }

  /** @param {import("./floor_states.js").Entry[]} entries @param {Set<string>} running sessions */
  show(entries, running) {
    const shown = new Set(entries.map(({ session }) => session.id));
    for (const [id, card] of this.cards) {
      if (!shown.has(id)) {
        card.node.remove();
        this.cards.delete(id);
        if (!running.has(id)) setTimeout(() => this.recorded.refresh(), 500);
      }
    }
    const focused = document.activeElement;
    entries.forEach((entry, place) => {
      const card = this.cards.get(entry.session.id) ?? this.addCard(entry.session);
      card.show(entry, this.names.of(entry.session.patient));
      if (this.live.children[place] !== card.node) this.live.insertBefore(card.node, this.live.children[place] ?? null);
    });
    // A card that changes its place would lose the focus.
    if (focused instanceof HTMLElement && focused !== document.activeElement && this.live.contains(focused))
      focused.focus({ preventScroll: true });
  }

  /** @param {any} session */
  addCard(session) {
    const card = new FloorCard(session);
    this.cards.set(session.id, card);
    this.recorded.refresh();
    return card;
  }

  dispose() {
    this.recorded.dispose();
    this.notice.dispose();
  }
}
