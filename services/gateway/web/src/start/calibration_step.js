// The session has begun: stand still, move a little, and see how well the sensors' places were found.
import { get, post } from "../api.js";
import { BodyMap } from "../body_map.js";
import { UNCALIBRATED } from "../camera_words.js";
import { el, fill, say } from "../dom.js";
import { LiveSocket } from "../live_socket.js";
import { SENSOR_WORDS, misplacedText, segmentName, stateOf } from "../words.js";
import { costOfSkipping, duty, heading, qualityOf } from "./calibration_words.js";

const LOOK_MS = 250;
const AGAIN_MS = 400;
const RUNNING = ["created", "live"];
const MARKED_S = 3;

export class CalibrationStep {
  title = "Calibration";

  /** @param {string} session id @param {{onReady: () => void, onGone: (session: string) => void}} listener */
  constructor(session, { onReady, onGone }) {
    this.session = session;
    this.onReady = onReady;
    this.onGone = onGone;
    this.now = { phase: null, message: null, sensors: [], cameras: [], stood: null };
    this.segments = {};
    this.worn = { sensors: 0, cameras: 0 };
    this.calibration = null;
    this.status = { silent: [], connected: true };
    this.open = false;
    this.build();
    this.connect();
    this.timer = setInterval(() => this.show(), LOOK_MS);
    this.show();
  }

  connect() {
    this.socket = new LiveSocket(`/${this.session}`, {
      onMessage: (message) => this.hear(message),
      onState: (open) => (this.open = open),
      onEnd: () => this.lost(),
    });
  }

  /** The line says that nothing comes: the session is over, or has not quite begun. */
  async lost() {
    const session = await get("/sessions/{session}", { session: this.session }).catch(() => null);
    if (this.disposed) return;
    if (session && !RUNNING.includes(session.state)) this.onGone(this.session);
    else this.waiting = setTimeout(() => this.connect(), AGAIN_MS);
  }

  build() {
    this.head = el("h3", { class: "duty-head" });
    this.duty = el("p");
    this.word = el("p", { class: "chip big", role: "status" });
    this.bar = el("progress", { max: 1, value: 0 });
    this.stood = el("label", { class: "stood" }, "Stood still so far", this.bar);
    this.map = new BodyMap();
    this.sensors = el("ul", { class: "worn-list" });
    this.banner = el("p", { class: "banner", role: "alert", hidden: true });
    this.notice = el("p", { class: "quiet", role: "status" });
    this.facts = el("dl", { class: "facts-list" });
    this.mark = el("button", { type: "button", class: "mark", onclick: () => this.standing() }, "Standing now");
    this.cost = el("p", { class: "quiet" });
    this.node = el(
      "div",
      { class: "step-body two" },
      el(
        "div",
        { class: "step-part duty" },
        this.word,
        this.head,
        this.duty,
        this.stood,
        el("div", { class: "row" }, this.mark, this.notice),
        this.banner,
        this.cost,
      ),
      el(
        "div",
        { class: "step-part" },
        el("h3", {}, "Sensors"),
        el("div", { class: "worn-now" }, this.map.node, this.sensors),
        el("h3", {}, "Calibration"),
        this.facts,
      ),
    );
  }

  hear(message) {
    switch (message.kind) {
      case "session":
        this.segments = Object.fromEntries(message.sensors.map(({ name, segment }) => [name, segment]));
        this.worn = { sensors: message.sensors.length, cameras: message.cameras.length };
        break;
      case "pose":
        this.now = message;
        this.age_s = message.age_s;
        this.heardAt = performance.now();
        break;
      case "calibration":
        this.calibration = message;
        break;
      case "status":
        this.status = message;
        break;
    }
    this.show();
  }

  /** s since the newest skeleton; null before the first. */
  get age() {
    return this.heardAt === undefined ? null : this.age_s + (performance.now() - this.heardAt) / 1000;
  }

  get isReady() {
    return this.now.phase === "estimating" && this.calibration !== null;
  }

  show() {
    const { phase, message, sensors, cameras, stood, notice } = this.now;
    const misplaced = this.calibration?.misplaced ?? {};
    const { silent, connected } = this.status;
    const heard = this.open && connected;
    const state = stateOf({ age_s: this.age, phase, message, sensors, cameras, segments: this.segments, misplaced, silent, heard });
    say(this.word, state.word);
    this.word.dataset.tone = state.tone;
    say(this.head, heading(this.now, this.calibration));
    say(this.duty, duty(this.now, this.calibration));
    this.stood.hidden = stood === null || stood === undefined || phase === "estimating";
    this.bar.value = stood ?? 0;
    say(this.notice, notice ?? "");
    const trouble = [misplacedText(misplaced), this.calibration?.absolute === false ? UNCALIBRATED : ""].filter(Boolean).join(" ");
    say(this.banner, trouble);
    this.banner.hidden = trouble === "";
    say(this.cost, this.isReady ? "" : costOfSkipping(this.worn));
    this.showSensors(sensors);
    this.showFacts();
    if (this.isReady !== this.wasReady) {
      this.wasReady = this.isReady;
      this.onReady();
    }
  }

  showSensors(sensors) {
    const text = sensors.map(({ sensor, state }) => sensor + state).join();
    if (text === this.sensorText) return;
    this.sensorText = text;
    this.map.show(sensors.map(({ sensor, state }) => ({ segment: this.segments[sensor] ?? sensor, state })));
    fill(this.sensors, ...sensors.map(({ sensor, state }) => line(this.segments[sensor] ?? sensor, SENSOR_WORDS[state])));
  }

  showFacts() {
    const text = JSON.stringify(this.calibration);
    if (text === this.factText) return;
    this.factText = text;
    if (!this.calibration) {
      fill(this.facts, el("div", {}, el("dd", { class: "quiet" }, "Not yet.")));
      return;
    }
    const { word, tone, text: share } = qualityOf(this.calibration.quality);
    fill(
      this.facts,
      el("div", {}, el("dt", {}, "Quality"), el("dd", {}, el("span", { class: "chip small", "data-tone": tone }, word), ` ${share}`)),
      el("div", {}, el("dt", {}, "Zero is"), el("dd", {}, this.calibration.datum)),
      el("div", {}, el("dt", {}, "Angles"), el("dd", {}, this.calibration.absolute ? "absolute" : "right as changes; each may be off by a constant")),
      el("div", {}, el("dt", {}, "Worn as declared"), el("dd", {}, misplacedText(this.calibration.misplaced) || "yes")),
    );
  }

  /** The last seconds were standing. Whether they were is answered by the next skeletons. */
  async standing() {
    this.mark.disabled = true;
    try {
      await post("/sessions/{session}/marks", {
        session: this.session,
        body: { last_s: MARKED_S, at_s: this.now.at_s ?? null },
      });
    } catch (problem) {
      say(this.notice, problem.message);
    } finally {
      this.mark.disabled = false;
    }
  }

  enter() {}

  /** One may always go on: what is not found yet is looked for on the live page. */
  async finish() {
    return true;
  }

  get summary() {
    return this.isReady ? "done" : "";
  }

  dispose() {
    this.disposed = true;
    clearInterval(this.timer);
    clearTimeout(this.waiting);
    this.socket.close();
  }
}

/** @param {string} segment @param {{word: string, tone: string}} state */
function line(segment, { word, tone }) {
  return el("li", {}, el("span", {}, segmentName(segment)), el("span", { class: "chip small", "data-tone": tone }, word));
}
