// One running session: skeleton, curves, numbers, sensors. What is older than a second is grey, always.
import { ChartPanel } from "./chart_panel.js";
import { el, fill, say } from "./dom.js";
import { SIDES, figureOf } from "./figure.js";
import { KneePanel } from "./knee_panel.js";
import { LiveSocket } from "./live_socket.js";
import { LiveNumbers } from "./live_numbers.js";
import { PatientLink } from "./patient_link.js";
import { PhaseStrip } from "./phase_strip.js";
import { RepetitionCounter } from "./repetition_counter.js";
import { SensorList } from "./sensor_list.js";
import { SessionControls } from "./session_controls.js";
import { Skeleton2d } from "./skeleton2d.js";
import { Skeleton3d, canDraw3d } from "./skeleton3d.js";
import { clock } from "./units.js";
import { STALE_S, lastData, misplacedText, stateOf } from "./words.js";
import { kneesOf } from "./worn.js";

const JOINTS = [
  { joint: "hip_flexion", title: "Hip flexion", range: [-30, 50] },
  { joint: "knee_flexion", title: "Knee flexion", range: [-10, 80] },
];
const VIEWS = { side: "Side", front: "Front", back: "Back" };

export class LiveView {
  constructor(host, session, { onEnd }) {
    this.session = session;
    this.segments = {};
    this.sensors = [];
    this.misplaced = session.misplaced;
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
    this.warning = el("p", { class: "banner warning", role: "alert", hidden: true });
    this.link = new PatientLink(this.session);
    this.controls = new SessionControls(this.session, {
      onTrouble: (text) => this.advise(text),
      newest: () => this.atS,
    });
    this.title = el("h1", { title: this.session.title }, this.session.title);
    this.stage = el("div", { class: "stage" });
    this.sensorList = new SensorList();
    this.charts = JOINTS.map((joint) => new ChartPanel(joint));
    this.curves = el("div", { class: "curves" }, ...this.charts.map((chart) => chart.node));
    this.strip = new PhaseStrip();
    this.counter = new RepetitionCounter();
    this.strides = el("section", { class: "panel numbers-panel", "aria-label": "Numbers" }, this.numbers.node);
    this.key = el("p", { class: "key" });
    this.showKey(SIDES);
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
        this.controls.node,
      ),
      this.advice,
      this.warning,
      el(
        "div",
        { class: "live" },
        this.strip.node,
        el(
          "section",
          { class: "panel body-panel", "aria-label": "Skeleton" },
          this.viewButtons(),
          this.stage,
          this.key,
        ),
        this.curves,
        el("div", { class: "side-column" }, this.counter.node, this.strides, this.sensorList.node),
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
      this.arrange(message);
      this.segments = Object.fromEntries(message.sensors.map((sensor) => [sensor.name, sensor.segment]));
      this.link.show(message.patient);
    },
    calibration(calibration) {
      this.misplaced = calibration.misplaced;
      this.warn();
      this.sensorList.showDatum(calibration.datum);
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
      this.warn();
      this.atS = pose.at_s;
      const figure = this.body && figureOf(pose, this.body);
      if (figure) this.skeleton.show(figure, kneeAngles(pose));
      for (const chart of this.charts) chart.add(pose, pose.trail);
      this.knee?.add(pose, pose.trail);
      this.strip.show(pose.at_s);
      this.numbers.onPose(pose);
      this.sensorList.show(pose.sensors, this.segments);
      this.tick();
    },
    status(status) {
      this.status = status;
      this.heard(status.age_s);
    },
    gait_event(event) {
      if (this.task === "knee_flexion") return;
      for (const chart of this.charts) chart.rolling.mark(event);
    },
    stride(stride) {
      this.numbers.onStride(stride);
    },
    task_phase(phase) {
      this.strip.onPhase(phase);
    },
    repetition(repetition) {
      this.counter.onRepetition(repetition);
    },
    metrics(metrics) {
      this.numbers.onMetrics(metrics);
    },
  };

  /** Once it is known what is worn and what is to be done: show that, and nothing that cannot be. */
  arrange({ sensors, task }) {
    if (this.arranged) return;
    this.arranged = true;
    this.task = task;
    this.strip.node.hidden = task !== "timed_up_and_go";
    this.counter.node.hidden = task !== "knee_flexion";
    this.strides.hidden = task === "knee_flexion";
    const knees = kneesOf(sensors);
    if (!knees) return;
    this.knee = new KneePanel(knees);
    this.curves.prepend(this.knee.node);
    for (const chart of this.charts) {
      chart.only(knees);
      chart.node.hidden = chart.joint !== "knee_flexion";
    }
    this.numbers.only(knees);
    this.showKey(knees);
  }

  showKey(sides) {
    const names = sides.map((side) => el("b", { class: side }, side === "left" ? "L left" : "R right"));
    fill(this.key, ...names, el("span", {}, "grey: not known now"), el("span", {}, "pale: not measured"));
  }

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
      misplaced: this.misplaced,
      silent,
      heard: this.open && (this.status?.connected ?? false),
    });
    say(this.word, word);
    this.word.dataset.tone = tone;
    say(this.ageText, lastData(age_s));
    const stale = age_s === null || age_s > STALE_S;
    this.skeleton.setStale(stale);
    for (const chart of this.charts) chart.node.classList.toggle("stale", stale);
    this.sensorList.tick(stale);
    this.numbers.tick(stale);
    this.knee?.tick(stale);
    this.strip.node.classList.toggle("stale", stale);
  }

  /** What is worn otherwise than declared, unless the estimator's own message says it and what to do. */
  warn() {
    const warning = this.message ? "" : misplacedText(this.misplaced);
    say(this.warning, warning);
    this.warning.hidden = warning === "";
  }

  advise(text) {
    say(this.advice, text);
    this.advice.hidden = text === "";
  }

  dispose() {
    clearInterval(this.timer);
    this.socket.close();
    this.skeleton.dispose();
    for (const chart of this.charts) chart.dispose();
  }
}

/** Angle of each knee that is known, with one standard deviation; rad. */
function kneeAngles(pose) {
  const known = SIDES.filter((side) => pose.angles[`knee_flexion_${side}`] !== undefined);
  return Object.fromEntries(
    known.map((side) => {
      const name = `knee_flexion_${side}`;
      return [side, { value: pose.angles[name], std: pose.angles_std[name] ?? 0 }];
    }),
  );
}
