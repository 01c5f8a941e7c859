// One running session: skeleton, curves, numbers, sensors. What is older than a second is grey, always.
import { AnglesPanel } from "./angles_panel.js";
import { arrangementOf } from "./arrangement.js";
import { CameraPanel } from "./camera_panel.js";
import { UNCALIBRATED } from "./camera_words.js";
import { ChartPanel } from "./chart_panel.js";
import { el, fill, say } from "./dom.js";
import { figureOf } from "./figure.js";
import { KneePanel } from "./knee_panel.js";
import { LiveSocket } from "./live_socket.js";
import { LiveNumbers } from "./live_numbers.js";
import { PatientLink } from "./patient_link.js";
import { RepetitionCounter } from "./repetition_counter.js";
import { SensorList } from "./sensor_list.js";
import { SessionControls } from "./session_controls.js";
import { Skeleton2d } from "./skeleton2d.js";
import { Skeleton3d, canDraw3d } from "./skeleton3d.js";
import { clock } from "./units.js";
import { stripOf } from "./task_strips.js";
import { SIDES } from "./vectors.js";
import { STALE_S, lastData, misplacedText, stateOf } from "./words.js";

export class LiveView {
  constructor(host, session, { onEnd }) {
    this.session = session;
    this.segments = {};
    this.sensors = [];
    this.cameras = [];
    this.charts = [];
    this.panels = [];
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
    this.views = el("div", { class: "views", role: "group", "aria-label": "View from" });
    this.curves = el("div", { class: "curves" });
    this.strip = null;
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
      (this.live = el(
        "div",
        { class: "live" },
        el(
          "section",
          { class: "panel body-panel", "aria-label": "Skeleton" },
          this.views,
          this.stage,
          this.key,
        ),
        this.curves,
        el("div", { class: "side-column" }, this.counter.node, this.strides, this.sensorList.node),
      )),
    );
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.skeleton = calm || !canDraw3d() ? new Skeleton2d(this.stage) : new Skeleton3d(this.stage);
  }

  offerViews(views) {
    const buttons = Object.entries(views).map(([view, name]) =>
      el("button", { type: "button", onclick: (event) => this.look(view, event.currentTarget) }, name),
    );
    fill(this.views, ...buttons);
    this.look(Object.keys(views)[0], buttons[0]);
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
      this.body = { ...message.body, floor_m: message.cameras[0]?.floor_m ?? null };
      this.arrange(message);
      this.segments = Object.fromEntries(message.sensors.map((sensor) => [sensor.name, sensor.segment]));
      this.link.show(message.patient);
    },
    calibration(calibration) {
      this.misplaced = calibration.misplaced;
      this.absolute = calibration.absolute;
      this.warn();
      this.sensorList.showDatum(calibration.datum);
      this.camera?.showCalibration(calibration);
    },
    patient(message) {
      this.link.show(message.patient);
    },
    pose(pose) {
      this.phase = pose.phase;
      this.message = pose.message;
      this.sensors = pose.sensors;
      this.cameras = pose.cameras;
      this.heard(pose.age_s);
      say(this.elapsed, clock(pose.at_s));
      this.advise([pose.notice, pose.phase === "estimating" ? pose.message : ""].filter(Boolean).join(". "));
      this.warn();
      this.atS = pose.at_s;
      const figure = this.body && figureOf(pose, this.body);
      if (figure) this.skeleton.show(figure, kneeAngles(pose));
      else if (this.camera) this.skeleton.clear();
      for (const chart of this.charts) chart.add(pose, pose.trail);
      for (const panel of this.panels) panel.add(pose, pose.trail);
      this.strip?.show(pose.at_s);
      this.numbers.onPose(pose);
      this.sensorList.show(pose.sensors, this.segments);
      this.tick();
    },
    status(status) {
      this.status = status;
      this.heard(status.age_s);
    },
    gait_event(event) {
      if (this.arranged.counted) return;
      for (const chart of this.charts) chart.rolling.mark(event);
    },
    stride(stride) {
      this.strip?.onStride?.(stride);
      this.numbers.onStride(stride);
    },
    task_phase(phase) {
      this.strip?.onPhase(phase);
    },
    repetition(repetition) {
      this.counter.onRepetition(repetition);
    },
    metrics(metrics) {
      this.numbers.onMetrics(metrics);
    },
  };

  /** Once it is known what is worn and what is to be done: show that, and nothing that cannot be. */
  arrange(session) {
    if (this.arranged) return;
    const { charts, sides, views, counted, legs, wholeBody } = (this.arranged = arrangementOf(session));
    this.strip = stripOf(session);
    if (this.strip) this.live.prepend(this.strip.node);
    this.counter.node.hidden = !counted;
    this.strides.hidden = counted;
    this.sensorList.node.hidden = session.sensors.length === 0;
    this.offerViews(views);
    this.charts = charts.map((chart) => new ChartPanel(chart));
    this.curves.append(...this.charts.map((chart) => chart.node));
    for (const chart of this.charts) chart.start();
    if (legs) this.showLegsAlone(legs);
    if (session.task === "marching") this.numbers.onTheSpot();
    if (wholeBody) this.showWholeBody(wholeBody, session.cameras);
    this.showKey(sides);
  }

  showLegsAlone(legs) {
    const knee = new KneePanel(legs);
    this.panels.push(knee);
    this.curves.prepend(knee.node);
    this.numbers.only(legs);
  }

  showWholeBody(wholeBody, cameras) {
    const angles = new AnglesPanel(wholeBody);
    this.camera = new CameraPanel(cameras);
    this.panels.push(angles, this.camera);
    this.counter.showWholeBody(wholeBody);
    this.sensorList.node.before(angles.node, this.camera.node);
    this.views.append(el("span", { class: "spring" }), this.camera.chips);
    this.live.classList.add("whole-body");
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
      cameras: this.cameras,
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
    for (const panel of this.panels) panel.tick(stale);
    this.strip?.node.classList.toggle("stale", stale);
  }

  /** What is worn otherwise than declared or not calibrated, unless the estimator's own message says what to do. */
  warn() {
    const found = [misplacedText(this.misplaced), this.absolute === false ? UNCALIBRATED : ""];
    const warning = this.message ? "" : found.filter(Boolean).join(" ");
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
