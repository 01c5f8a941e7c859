// One running session: skeleton, curves, numbers, sensors. What is older than a second is grey, always.
import { AnglesPanel } from "./angles_panel.js";
import { arrangementOf } from "./arrangement.js";
import { CameraPanel } from "./camera_panel.js";
import { UNCALIBRATED } from "./camera_words.js";
import { ChartPanel } from "./chart_panel.js";
import { el, fill, say, tell } from "./dom.js";
import { FeedbackDialog } from "./feedback_dialog.js";
import { entriesOf, needsLook } from "./floor_states.js";
import { KneePanel } from "./knee_panel.js";
import { LiveSocket } from "./live_socket.js";
import { LiveNumbers } from "./live_numbers.js";
import { PatientLink } from "./patient_link.js";
import { RepetitionCounter } from "./repetition_counter.js";
import { SensorPanel } from "./sensor_panel.js";
import { SessionControls } from "./session_controls.js";
import { Shortcuts, fullScreenButton, toggleFullScreen } from "./shortcuts.js";
import { SkeletonPanel } from "./skeleton_panel.js";
import { SymmetryStrip } from "./symmetry_strip.js";
import { clock } from "./units.js";
import { stripOf } from "./task_strips.js";
import { STALE_S, lastData, misplacedText, stateOf } from "./words.js";

export class LiveView {
  constructor(host, session, { onEnd }) {
    this.host = host;
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
    this.phase = this.message = this.atS = null;
    this.absolute = true;
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
    this.others = el("a", { class: "others", href: "#/", hidden: true });
    this.elapsed = el("span", { class: "elapsed" });
    this.advice = el("p", { class: "banner", role: "status", hidden: true });
    this.warning = el("p", { class: "banner warning", role: "alert", hidden: true });
    this.link = new PatientLink(this.session);
    this.controls = new SessionControls(this.session, {
      onTrouble: (text) => tell(this.advice, text),
      newest: () => this.atS,
    });
    this.title = el("h1", { title: this.session.title }, this.session.title);
    this.body = new SkeletonPanel(this.session.conditions?.paretic_side);
    this.sensorPanel = new SensorPanel();
    this.curves = el("div", { class: "curves" });
    this.strip = null;
    this.counter = new RepetitionCounter();
    this.symmetry = new SymmetryStrip(this.session.conditions?.paretic_side);
    this.strides = el(
      "section",
      { class: "panel numbers-panel", "aria-label": "Numbers" },
      this.numbers.node,
      this.symmetry.node,
    );
    this.live = el(
      "div",
      { class: "live" },
      this.body.node,
      this.curves,
      el("div", { class: "side-column" }, this.counter.node, this.strides, this.sensorPanel.node),
    );
    fill(host, this.head(), this.advice, this.warning, this.live, this.feedback.dialog, this.shortcuts.dialog);
  }

  head() {
    this.feedback = new FeedbackDialog(this.session);
    this.shortcuts = new Shortcuts([
      { key: "M", does: "Mark: standing now", run: () => this.controls.mark() },
      { key: "P", does: "Screen for the patient", run: () => this.feedback.open() },
      { key: "G", does: "Next ghost: none, best stride, previous stride", run: () => this.body.nextGhost() },
      { key: "1", does: "First view of the body", run: () => this.body.lookNth(0) },
      { key: "2", does: "Second view", run: () => this.body.lookNth(1) },
      { key: "3", does: "Third view", run: () => this.body.lookNth(2) },
      { key: "F", does: "Full screen, and back", run: () => toggleFullScreen(this.host) },
    ]);
    return el(
      "div",
      { class: "session-head" },
      this.title,
      this.word,
      this.elapsed,
      this.ageText,
      el("span", { class: "spring" }),
      this.others,
      this.link.node,
      this.controls.node,
      el(
        "span",
        { class: "actions" },
        el("button", { type: "button", class: "for-patient", onclick: () => this.feedback.open() }, "Patient screen"),
        fullScreenButton(() => toggleFullScreen(this.host)),
        this.shortcuts.button,
      ),
    );
  }

  on(message) {
    this.handlers[message.kind]?.call(this, message);
  }

  handlers = {
    session(message) {
      this.lengths = { ...message.body, floor_m: message.cameras[0]?.floor_m ?? null };
      this.arrange(message);
      this.segments = Object.fromEntries(message.sensors.map((sensor) => [sensor.name, sensor.segment]));
      this.link.show(message.patient);
    },
    calibration(calibration) {
      this.misplaced = calibration.misplaced;
      this.absolute = calibration.absolute;
      this.warn();
      this.sensorPanel.showDatum(calibration.datum);
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
      tell(this.advice, [pose.notice, pose.phase === "estimating" ? pose.message : ""].filter(Boolean).join(". "));
      this.warn();
      this.atS = pose.at_s;
      this.body.show(pose, this.lengths, Boolean(this.camera));
      for (const chart of this.charts) chart.add(pose, pose.trail);
      for (const panel of this.panels) panel.add(pose, pose.trail);
      this.strip?.show(pose.at_s);
      this.numbers.onPose(pose);
      this.sensorPanel.show(pose.sensors, this.segments, pose.at_s);
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
      this.symmetry.onStride(stride);
      this.body.onStride(stride);
    },
    data_quality(quality) {
      this.sensorPanel.onQuality(quality);
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
    const arranged = (this.arranged = arrangementOf(session));
    const { charts, sides, counted, legs, wholeBody } = arranged;
    this.strip = stripOf(session);
    if (this.strip) this.live.prepend(this.strip.node);
    this.counter.node.hidden = !counted;
    this.strides.hidden = counted;
    this.symmetry.node.hidden = sides.length < 2;
    this.sensorPanel.node.hidden = session.sensors.length === 0;
    this.body.arrange(arranged);
    this.feedback.arrange(arranged, session);
    this.charts = charts.map((chart) => new ChartPanel(chart));
    this.curves.append(...this.charts.map((chart) => chart.node));
    for (const chart of this.charts) chart.start();
    if (legs) this.showLegsAlone(legs);
    if (session.task === "marching") this.numbers.onTheSpot();
    if (wholeBody) this.showWholeBody(wholeBody, session.cameras);
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
    this.sensorPanel.node.before(angles.node, this.camera.node);
    this.body.views.append(this.camera.chips);
    this.live.classList.add("whole-body");
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
    const { word, tone } = stateOf({
      age_s,
      phase: this.phase,
      message: this.message,
      sensors: this.sensors,
      cameras: this.cameras,
      segments: this.segments,
      misplaced: this.misplaced,
      silent: this.status?.silent ?? [],
      preparing: this.status?.preparing,
      recording_stopped: this.status?.recording_stopped,
      heard: this.open && (this.status?.connected ?? false),
    });
    say(this.word, word);
    this.word.dataset.tone = tone;
    say(this.ageText, lastData(age_s));
    const stale = age_s === null || age_s > STALE_S;
    for (const chart of this.charts) chart.node.classList.toggle("stale", stale);
    for (const part of [this.body, this.sensorPanel, this.numbers, this.symmetry, ...this.panels]) part.tick(stale);
    this.strip?.node.classList.toggle("stale", stale);
  }

  /** Whoever watches one patient hears of the others. @param {any} status the newest list of all that run */
  onFloor(status) {
    const others = entriesOf(status, 0).filter((entry) => entry.session.id !== this.session.id && needsLook(entry));
    this.others.hidden = others.length === 0;
    say(this.others, `${others.length} other${others.length === 1 ? " needs" : "s need"} a look`);
  }

  /** What is worn otherwise than declared or not calibrated, unless the estimator's own message says what to do. */
  warn() {
    const found = [misplacedText(this.misplaced), this.absolute === false ? UNCALIBRATED : ""];
    tell(this.warning, this.message ? "" : found.filter(Boolean).join(" "));
  }

  dispose() {
    clearInterval(this.timer);
    this.socket.close();
    this.body.dispose();
    this.shortcuts.dispose();
    this.feedback.dispose();
    for (const chart of this.charts) chart.dispose();
  }
}
