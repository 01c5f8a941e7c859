// The physio's side of the patient's screen: which cue, and what to aim at. The patient sees none of these numbers.
import { el, fill, say } from "./dom.js";
import { CUES, cuesOf } from "./feedback_cues.js";
import { feedbackAddress, keepTarget, keptTarget, usualTarget } from "./feedback_target.js";

export class FeedbackDialog {
  /** @param {{id: string}} session */
  constructor(session) {
    this.session = session.id;
    this.target = keptTarget(session.id) ?? usualTarget("cadence");
    this.cue = el("select", { id: "feedback-cue", onchange: () => this.choose(this.cue.value) });
    this.value = el("input", { id: "feedback-value", type: "number", onchange: () => this.aim() });
    this.unit = el("span", { class: "unit" });
    this.side = el(
      "select",
      { "aria-label": "Leg", onchange: () => this.aim() },
      el("option", { value: "left" }, "Left leg"),
      el("option", { value: "right" }, "Right leg"),
    );
    this.link = el("a", { class: "button", target: "_blank", rel: "noopener" }, "Open the patient's screen");
    const close = el("button", { type: "button", onclick: () => this.dialog.close() }, "Close");
    this.dialog = el(
      "dialog",
      { class: "feedback-dialog", "aria-label": "Screen for the patient" },
      el("h2", {}, "Screen for the patient"),
      el("p", { class: "quiet" }, "One cue and one sentence, to be read from four metres. No numbers are shown there."),
      el("label", { class: "field" }, "Cue", this.cue),
      el("label", { class: "field" }, el("span", {}, "Aim at ", this.unit), this.value),
      this.side,
      el("p", { class: "quiet" }, "A change is on the patient's screen at once when it is a window of this browser."),
      el("div", { class: "actions" }, close, this.link),
    );
    this.show();
  }

  /** Offer what the session can feed. */
  arrange(arranged, session) {
    const offered = cuesOf(arranged, session);
    fill(this.cue, ...offered.map((cue) => el("option", { value: cue }, CUES[cue].word)));
    for (const option of this.side.options) option.disabled = !arranged.sides.includes(option.value);
    if (!offered.includes(this.target.cue)) this.target = usualTarget(offered[0]);
    if (!arranged.sides.includes(this.target.side)) this.target.side = arranged.sides[0];
    this.show();
  }

  open() {
    keepTarget(this.session, this.target);
    if (!this.dialog.open) this.dialog.showModal();
  }

  /** @param {string} cue */
  choose(cue) {
    this.target = { ...usualTarget(cue), side: this.target.side };
    this.keep();
  }

  aim() {
    const { least, most, usual } = CUES[this.target.cue];
    const wished = this.value.valueAsNumber;
    const target = Number.isFinite(wished) ? Math.min(most, Math.max(least, wished)) : usual;
    this.target = { ...this.target, target, side: this.side.value };
    this.keep();
  }

  keep() {
    keepTarget(this.session, this.target);
    this.show();
  }

  show() {
    const { cue, target, side } = this.target;
    const { unit, least, most, step, sided } = CUES[cue];
    this.cue.value = cue;
    Object.assign(this.value, { min: least, max: most, step, value: target });
    say(this.unit, unit);
    this.side.hidden = !sided;
    this.side.value = side;
    this.link.href = feedbackAddress(this.session, this.target);
  }

  dispose() {
    this.dialog.remove();
  }
}
