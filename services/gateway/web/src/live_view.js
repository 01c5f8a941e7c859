// One running session: skeleton, curves, numbers, sensors. What is older than a second is grey, always.
import { post } from "./api.js";
import { RollingChart } from "./charts.js";
import { el, fill, say } from "./dom.js";
import { figureOf } from "./figure.js";
import { LiveSocket } from "./live_socket.js";
import { LiveNumbers } from "./live_numbers.js";
import { PatientLink } from "./patient_link.js";
import { Skeleton2d } from "./skeleton2d.js";
import { Skeleton3d, canDraw3d } from "./skeleton3d.js";
import { clock, degrees, number } from "./units.js";
import { SENSOR_WORDS, STALE_S, lastData, segmentName, stateOf } from "./words.js";

const JOINTS = [
  { joint: "hip_flexion", title: "Hip flexion", range: [-30, 50] },
  { joint: "knee_flexion", title: "Knee flexion", range: [-10, 80] },
];
const MARK_LENGTHS = [3, 5, 10];
const VIEWS = { side: "Side", front: "Front", back: "Back" };

export class LiveView {
  constructor(host, session, { onEnd }) {
    this.session = session;
    this.segments = {};
    this.sensors = [];
    this.age = null;
    this.status = null;
    this.open = false;
    this.numbers = new LiveNumbers();
    this.build(host);
    this.socket = new LiveSocket(`/${session.id}`, {
      onMessage: (message) => this.on(message),
      onState: (open) => (this.open = open),
      onEnd,
    });
    this.timer = setInterval(() => this.tick(), 100);
  }

  build(host) {
    this.word = el("p", { class: "chip big", role: "status" });
    this.ageText = el("span", { class: "quiet age" });
    this.elapsed = el("span", { class: "elapsed" });
    this.advice = el("p", { class: "banner", role: "status", hidden: true });
    this.link = new PatientLink(this.session);
    this.markLength = el(
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
    this.title = el("h1", { title: this.session.title }, this.session.title);
    this.stage = el("div", { class: "stage" });
    this.sensorList = el("ul", { class: "sensors" });
    this.charts = JOINTS.map((joint) => chartPanel(joint));
    fill(
      host,
      el(
        "div",
        { class: "session-head" },
        this.title,
        this.word,
        this.elapsed,
        this.ageText,
        el("span", { class: "spring" }),
        this.link.node,
        el("span", { class: "actions" }, this.markLength, this.markButton, this.stopButton),
      ),
      this.advice,
      el(
        "div",
        { class: "live" },
        el(
          "section",
          { class: "panel body-panel", "aria-label": "Skeleton" },
          this.viewButtons(),
          this.stage,
          el(
            "p",
            { class: "key" },
            el("b", { class: "left" }, "L left"),
            el("b", { class: "right" }, "R right"),
            el("span", {}, "grey: not known now"),
            el("span", {}, "pale: not measured"),
          ),
        ),
        el("div", { class: "curves" }, ...this.charts.map((chart) => chart.node)),
        el("section", { class: "panel numbers-panel", "aria-label": "Numbers" }, this.numbers.node),
        el("section", { class: "panel", "aria-label": "Sensors" }, el("h2", {}, "Sensors"), this.sensorList),
      ),
    );
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.skeleton = calm || !canDraw3d() ? new Skeleton2d(this.stage) : new Skeleton3d(this.stage);
    for (const chart of this.charts) chart.start();
  }

  viewButtons() {
    const buttons = Object.entries(VIEWS).map(([view, name]) =>
      el(
        "button",
        {
          type: "button",
          "aria-pressed": String(view === "side"),
          onclick: (event) => this.look(view, event.currentTarget),
        },
        name,
      ),
    );
    return el("div", { class: "views", role: "group", "aria-label": "View from" }, ...buttons);
  }

  look(view, button) {
    for (const other of button.parentElement.children) other.setAttribute("aria-pressed", other === button);
    this.skeleton.look(view);
  }

  on(message) {
    this.handlers[message.kind]?.call(this, message);
  }

  handlers = {
    session(message) {
      this.body = message.body;
      this.segments = Object.fromEntries(message.sensors.map((sensor) => [sensor.name, sensor.segment]));
      this.link.show(message.patient);
    },
    patient(message) {
      this.link.show(message.patient);
    },
    pose(pose) {
      this.phase = pose.phase;
      this.message = pose.message;
      this.sensors = pose.sensors;
      this.heard(pose.age_s);
      say(this.elapsed, clock(pose.at_s));
      this.advise([pose.notice, pose.phase === "estimating" ? pose.message : ""].filter(Boolean).join(". "));
      this.atS = pose.at_s;
      const figure = this.body && figureOf(pose, this.body);
      if (figure) this.skeleton.show(figure);
      for (const chart of this.charts) chart.add(pose, pose.trail);
      this.numbers.onPose(pose);
      this.showSensors();
      this.tick();
    },
    status(status) {
      this.status = status;
      this.heard(status.age_s);
    },
    gait_event(event) {
      for (const chart of this.charts) chart.rolling.mark(event);
    },
    stride(stride) {
      this.numbers.onStride(stride);
    },
    metrics(metrics) {
      this.numbers.onMetrics(metrics);
    },
  };

  heard(age_s) {
    this.age = age_s;
    this.heardAt = performance.now();
  }

  currentAge() {
    return this.age === null || this.age === undefined ? null : this.age + (performance.now() - this.heardAt) / 1000;
  }

  tick() {
    const age_s = this.currentAge();
    const silent = this.status?.silent ?? [];
    const { word, tone } = stateOf({
      age_s,
      phase: this.phase,
      message: this.message,
      sensors: this.sensors,
      segments: this.segments,
      silent,
      heard: this.open && (this.status?.connected ?? false),
    });
    say(this.word, word);
    this.word.dataset.tone = tone;
    say(this.ageText, lastData(age_s));
    const stale = age_s === null || age_s > STALE_S;
    this.skeleton.setStale(stale);
    for (const chart of this.charts) chart.node.classList.toggle("stale", stale);
    this.sensorList.classList.toggle("stale", stale);
    this.numbers.tick(stale);
  }

  showSensors() {
    const text = this.sensors.map((each) => each.sensor + each.state).join();
    if (text === this.sensorText) return;
    this.sensorText = text;
    fill(
      this.sensorList,
      ...this.sensors.map((each) => {
        const { word, tone } = SENSOR_WORDS[each.state];
        return el(
          "li",
          {},
          el("span", {}, segmentName(this.segments[each.sensor] ?? each.sensor)),
          el("span", { class: "chip small", "data-tone": tone }, word),
        );
      }),
    );
  }

  advise(text) {
    say(this.advice, text);
    this.advice.hidden = text === "";
  }

  /** The last seconds on this screen were standing. Whether they were is answered by the next skeletons' notice. */
  async mark() {
    this.markButton.disabled = true;
    try {
      await post(`/sessions/${this.session.id}/marks`, { last_s: Number(this.markLength.value), at_s: this.atS ?? null });
    } catch (problem) {
      this.advise(problem.message);
    } finally {
      this.markButton.disabled = false;
    }
  }

  async stop() {
    this.stopButton.disabled = true;
    try {
      await post(`/sessions/${this.session.id}/stop`);
      say(this.stopButton, "Stopping …");
    } catch (problem) {
      this.stopButton.disabled = false;
      this.advise(problem.message);
    }
  }

  dispose() {
    clearInterval(this.timer);
    this.socket.close();
    this.skeleton.dispose();
    for (const chart of this.charts) chart.rolling.dispose();
  }
}

function chartPanel({ joint, title, range }) {
  const now = { left: el("b", { class: "left" }), right: el("b", { class: "right" }) };
  const host = el("div", { class: "chart" });
  const node = el(
    "section",
    { class: "panel chart-panel", "aria-label": title },
    el("div", { class: "panel-head" }, el("h2", {}, title), el("span", { class: "spring" }), now.left, now.right),
    host,
  );
  return {
    node,
    start() {
      this.rolling = new RollingChart(host, joint, range);
    },
    add(pose, trail) {
      this.rolling.add([...trail, pose]);
      for (const side of ["left", "right"]) {
        const value = degrees(pose.angles[`${joint}_${side}`]);
        say(now[side], `${side === "left" ? "L" : "R"} ${number(value, 0)}${value === null ? "" : "°"}`);
      }
    },
  };
}
