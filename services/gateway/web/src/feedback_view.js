// The patient's own screen: one cue, one sentence. What is not of now is not shown: then it says "One moment".
import { el, fill, say } from "./dom.js";
import { CueProgress, sentenceOf } from "./feedback_cues.js";
import { Ring, Scale, person } from "./feedback_figure.js";
import { keptTarget, targetOfAddress, usualTarget, whenChosenElsewhere } from "./feedback_target.js";
import { LiveSocket } from "./live_socket.js";
import { STALE_S } from "./words.js";

/** @param {import("./pages.js").Place} place */
export const open = ({ host, params }) => new FeedbackView(host, params.session);

export class FeedbackView {
  /** @param {HTMLElement} host @param {string} session */
  constructor(host, session) {
    this.session = session;
    this.heardAt = -Infinity;
    this.phase = null;
    this.ended = false;
    this.picture = el("div", { class: "feedback-picture" });
    this.sentence = el("p", { class: "feedback-sentence", role: "status" });
    this.node = el(
      "div",
      { class: "feedback-screen" },
      el("h1", { class: "unseen" }, "Your movement"),
      this.picture,
      this.sentence,
      el("a", { class: "feedback-back", href: `#/sessions/${session}` }, "Back to the session"),
    );
    fill(host, this.node);
    this.aim();
    this.forget = whenChosenElsewhere(() => this.aim());
    this.socket = new LiveSocket(`/${session}`, { onMessage: (message) => this.on(message), onEnd: () => this.end() });
    this.timer = setInterval(() => this.show(), 200);
  }

  /** What the physio has chosen, newest first: in this browser, in the address, or the usual. */
  aim() {
    this.target = keptTarget(this.session) ?? targetOfAddress(location.hash) ?? usualTarget("cadence");
    this.progress = new CueProgress(this.target);
    this.figure = this.target.cue === "repetitions" ? new Ring() : new Scale(this.target.cue);
    fill(this.picture, person(this.target), this.figure.node);
    this.show();
  }

  /** @param {any} message */
  on(message) {
    switch (message.kind) {
      case "pose":
        this.heardAt = performance.now() - 1000 * message.age_s;
        this.phase = message.phase;
        this.progress.onPose(message);
        break;
      case "stride":
        this.progress.onStride(message);
        break;
      case "repetition":
        this.progress.onRepetition(message);
    }
  }

  end() {
    this.ended = true;
    this.show();
  }

  show() {
    const { state, words } = this.now();
    this.node.dataset.state = state;
    say(this.sentence, words);
    const progress = this.progress.now();
    this.figure.show(state === "rest" ? { ...progress, place: null } : progress, this.target.target);
  }

  now() {
    if (this.ended) return { state: "rest", words: "Finished, thank you" };
    if (performance.now() - this.heardAt > 1000 * STALE_S) return { state: "rest", words: "One moment" };
    if (this.phase !== "estimating") return { state: "rest", words: "Please stand still" };
    const progress = this.progress.now();
    return { state: progress.state, words: sentenceOf(this.target, progress) };
  }

  dispose() {
    clearInterval(this.timer);
    this.forget();
    this.socket.close();
  }
}
