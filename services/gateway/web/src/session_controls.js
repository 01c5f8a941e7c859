// What the operator can do to a running session: say that the person stands, and end it.
import { post } from "./api.js";
import { el, say } from "./dom.js";

const MARK_LENGTHS = [3, 5, 10];

export class SessionControls {
  /** `onTrouble` takes a sentence; `newest` gives the session time on the screen, s. */
  constructor(session, { onTrouble, newest }) {
    this.session = session;
    this.onTrouble = onTrouble;
    this.newest = newest;
    this.length = el(
      "select",
      { "aria-label": "Seconds of standing" },
      ...MARK_LENGTHS.map((seconds) => el("option", { value: seconds }, `last ${seconds} s`)),
    );
    this.markButton = el(
      "button",
      { class: "mark", type: "button", title: "The person stands upright and still", onclick: () => this.mark() },
      "Standing now",
    );
    this.stopButton = el("button", { class: "danger", type: "button", onclick: () => this.stop() }, "Stop");
    this.node = el("span", { class: "actions" }, this.length, this.markButton, this.stopButton);
  }

  /** The last seconds on this screen were standing. Whether they were is answered by the next skeletons' notice. */
  async mark() {
    this.markButton.disabled = true;
    try {
      const wish = { last_s: Number(this.length.value), at_s: this.newest() ?? null };
      await post("/sessions/{session}/marks", { session: this.session.id, body: wish });
    } catch (problem) {
      this.onTrouble(problem.message);
    } finally {
      this.markButton.disabled = false;
    }
  }

  async stop() {
    this.stopButton.disabled = true;
    try {
      await post("/sessions/{session}/stop", { session: this.session.id });
      say(this.stopButton, "Stopping …");
    } catch (problem) {
      this.stopButton.disabled = false;
      this.onTrouble(problem.message);
    }
  }
}
