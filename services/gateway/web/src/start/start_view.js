// Starting a session, step by step. Browser and page go back alike; nothing is begun before the last step.
import { post } from "../api.js";
import { el, fill, say } from "../dom.js";
import { CalibrationStep } from "./calibration_step.js";
import { PatientStep } from "./patient_step.js";
import { ProtocolStep } from "./protocol_step.js";
import { SensorsStep } from "./sensors_step.js";

const STEPS = ["Patient", "Protocol", "Sensors", "Calibration"];
const CALIBRATION = 3;

/** @param {import("../pages.js").Place} place */
export const open = ({ host, params, app }) =>
  new StartView(host, { mayName: app.me.may.includes("names"), patient: params.patient, session: params.session });

class StartView {
  /** @param {HTMLElement} host @param {{mayName: boolean, patient?: string, session?: string}} known */
  constructor(host, { mayName, patient, session }) {
    const protocol = new ProtocolStep();
    this.parts = session ? [] : [new PatientStep({ mayName, preselected: patient }), protocol, new SensorsStep(() => protocol.task)];
    this.session = session ?? null;
    this.place = session ? CALIBRATION : 0;
    this.list = el("ol", { class: "steps", "aria-label": "Steps" });
    this.title = el("h2", { tabindex: "-1" });
    this.body = el("div");
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.back = el("button", { type: "button", onclick: () => history.back() }, "Back");
    this.onward = el("button", { class: "primary", type: "submit" });
    this.actions = el("div", { class: "actions" }, this.back, this.onward);
    const form = el("form", { class: "panel start-step", novalidate: true, onsubmit: (event) => this.submit(event) },
      this.title, this.body, this.problem, this.actions);
    fill(host, el("h1", {}, "Start a session"), this.list, form);
    this.stepBack = (event) => this.turn(event.state?.step ?? 0);
    window.addEventListener("popstate", this.stepBack);
    if (session) this.calibrate(session);
    else this.show();
  }

  get part() {
    return this.place === CALIBRATION ? this.calibration : this.parts[this.place];
  }

  /** @param {number} place */
  turn(place) {
    if (this.session !== null || place === this.place || place >= CALIBRATION) return;
    this.place = place;
    this.show();
    this.title.focus();
  }

  show() {
    const { part, place } = this;
    fill(this.list, ...STEPS.map((name, step) => this.mark(name, step)));
    say(this.title, part.title);
    fill(this.body, part.node);
    this.complain("");
    this.back.hidden = place === 0 || this.session !== null;
    say(this.onward, place === CALIBRATION - 1 ? "Begin" : "Next");
    part.enter();
  }

  /** @param {string} name @param {number} step */
  mark(name, step) {
    const current = step === this.place;
    const done = this.session === null && step < this.place;
    const said = step < this.place ? (this.parts[step]?.summary ?? "") : "";
    const words = [el("b", {}, `${step + 1}  ${name}`), el("span", { class: "quiet" }, said)];
    const inside = done ? el("button", { type: "button", onclick: () => history.go(step - this.place) }, ...words) : el("span", {}, ...words);
    return el("li", { "aria-current": current ? "step" : null, "data-done": String(step < this.place) }, inside);
  }

  /** @param {SubmitEvent} event */
  async submit(event) {
    event.preventDefault();
    if (this.session !== null) {
      this.goLive(this.session);
      return;
    }
    this.onward.disabled = true;
    this.complain("");
    try {
      if (await this.part.finish()) await this.goOn();
    } catch (problem) {
      this.complain(problem.message);
    } finally {
      this.onward.disabled = false;
    }
  }

  async goOn() {
    if (this.place < CALIBRATION - 1) {
      history.pushState({ step: this.place + 1 }, "");
      this.turn(this.place + 1);
      return;
    }
    const wish = Object.assign({}, ...this.parts.map((part) => part.wish));
    const { id } = await post("/sessions", { body: wish });
    if (this.disposed) return;
    // A reload of this page, and going back to it, finds the session that was begun.
    history.replaceState(null, "", `#/start/session/${id}`);
    this.calibrate(id);
    this.title.focus();
  }

  /** @param {string} session */
  calibrate(session) {
    this.session = session;
    this.place = CALIBRATION;
    this.calibration = new CalibrationStep(session, {
      onReady: () => this.tellReady(),
      onGone: (id) => this.goLive(id),
    });
    this.show();
    this.tellReady();
  }

  tellReady() {
    const ready = this.calibration?.isReady;
    say(this.onward, ready ? "Go to the live page" : "Skip calibration");
    this.onward.classList.toggle("primary", Boolean(ready));
  }

  /** @param {string} session */
  goLive(session) {
    if (!this.disposed) location.hash = `#/sessions/${session}`;
  }

  /** @param {string} text */
  complain(text) {
    say(this.problem, text);
    this.problem.hidden = text === "";
  }

  dispose() {
    this.disposed = true;
    window.removeEventListener("popstate", this.stepBack);
    for (const part of this.parts) part.dispose();
    this.calibration?.dispose();
  }
}
