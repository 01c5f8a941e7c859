// A session that is over as it was on the live page: the same figure, curves and numbers, at any moment of it.
import { AnglesPanel } from "../angles_panel.js";
import { get, linkTo } from "../api.js";
import { arrangementOf } from "../arrangement.js";
import { CameraPanel } from "../camera_panel.js";
import { ChartPanel } from "../chart_panel.js";
import { el, fill, say, tell } from "../dom.js";
import { KneePanel } from "../knee_panel.js";
import { LiveNumbers } from "../live_numbers.js";
import { RepetitionCounter } from "../repetition_counter.js";
import { SensorPanel } from "../sensor_panel.js";
import { SkeletonPanel } from "../skeleton_panel.js";
import { stripOf } from "../task_strips.js";
import { clock, number } from "../units.js";
import { WalkStrip } from "../walk_strip.js";
import { addressOf } from "../pages.js";
import { Happenings } from "./happenings.js";
import { nothingYet, readPast } from "./history.js";
import { Player, SPEEDS } from "./player.js";
import { PoseStore, RATE_HZ, countUntil } from "./pose_store.js";
import { strideAt, strideWords } from "./stride_place.js";
import { Timeline } from "./timeline.js";

const CURVES_S = 8;
/** s; strides that ended longer ago tell nothing of now. */
const RECENT_S = 40;
const REMEMBER_MS = 500;
const EXPORT = "/sessions/{session}/exports/{name}";
const ANGLES = "joint_angles.csv";

export class ReplayView {
  /** @param {HTMLElement} host @param {any} session @param {URLSearchParams} query `t`: where to begin, s */
  constructor(host, session, query) {
    this.host = host;
    this.session = session;
    this.begin_s = Math.max(0, Number(query.get("t")) || 0);
    this.shown = null;
    this.shown_s = -Infinity;
    this.past = nothingYet();
    this.happenings = new Happenings();
    fill(host, el("p", { class: "panel quiet", role: "status" }, "Opening the recording …"));
    this.load();
  }

  async load() {
    try {
      const recorded = await get("/sessions/{session}/recorded", { session: this.session.id });
      if (!this.disposed) this.build(recorded);
    } catch (problem) {
      if (this.disposed) return;
      fill(this.host, el("p", { class: "panel", role: "status" }, problem.message));
      if (problem.status === 409 || problem.status === 0) this.timer = setTimeout(() => this.load(), 2000);
    }
  }

  build(recorded) {
    this.recorded = { ...recorded, duration_s: null };
    this.lengths = { ...recorded.body, floor_m: recorded.cameras[0]?.floor_m ?? null };
    this.segments = Object.fromEntries(recorded.sensors.map(({ name, segment }) => [name, segment]));
    this.arranged = arrangementOf(recorded);
    this.store = new PoseStore(this.session.id, recorded.end_s, {
      onLoaded: () => this.loaded(),
      onTrouble: (text) => tell(this.trouble, text),
    });
    this.player = new Player(recorded.end_s, {
      isReady: (at_s) => this.store.isReady(at_s),
      onTime: (jumped) => this.goTo(jumped),
      onState: () => this.showState(),
    });
    this.timeline = new Timeline(recorded.end_s, {
      onSeek: (at_s) => this.player.seek(at_s),
      onStep: (pictures) => this.step(pictures),
      onStride: (strides) => this.nextStride(strides),
    });
    this.fillPage();
    this.listen = (event) => this.pressed(event);
    document.addEventListener("keydown", this.listen);
    this.timer = setInterval(() => this.remember(), REMEMBER_MS);
    this.player.seek(this.begin_s);
    this.showState();
    readPast(this.session.id, this.past, () => this.onPast()).catch((problem) => tell(this.trouble, problem.message));
  }

  fillPage() {
    const { charts, wholeBody, legs } = this.arranged;
    this.trouble = el("p", { class: "banner", role: "status", hidden: true });
    this.body = new SkeletonPanel(this.session.conditions?.paretic_side);
    this.body.arrange(this.arranged);
    this.charts = charts.map((chart) => new ChartPanel(chart));
    this.angles = wholeBody && new AnglesPanel(wholeBody);
    this.camera = wholeBody && new CameraPanel(this.recorded.cameras);
    this.knee = legs && new KneePanel(legs);
    this.sensors = new SensorPanel();
    this.sensors.node.hidden = this.recorded.sensors.length === 0;
    this.counted = el("div", { class: "column" });
    this.stripPlace = el("div", { class: "strip-place" });
    const curves = el("div", { class: "curves" }, this.knee?.node, ...this.charts.map(({ node }) => node));
    const side = [this.counted, this.angles?.node, this.camera?.node, this.sensors.node];
    this.live = el(
      "div",
      { class: wholeBody ? "live replay whole-body" : "live replay" },
      this.body.node,
      curves,
      el("div", { class: "side-column", tabindex: 0, role: "group", "aria-label": "Numbers and sensors" }, ...side),
    );
    fill(this.host, this.trouble, this.bar(), this.timeline.node, this.stripPlace, this.live);
    if (this.camera) this.body.views.append(this.camera.chips);
    for (const chart of this.charts) chart.start();
    this.startAnew();
  }

  bar() {
    const button = (text, title, onclick) => el("button", { type: "button", title, onclick }, text);
    this.playButton = button("Play", "Space", () => this.player.toggle());
    this.playButton.classList.add("primary");
    this.speed = el(
      "select",
      { "aria-label": "Speed", onchange: () => (this.player.speed = Number(this.speed.value)) },
      ...SPEEDS.map((speed) => el("option", { value: speed, selected: speed === 1 }, `${speed}×`)),
    );
    this.now = el("output", { class: "replay-now" });
    this.state = el("span", { class: "quiet", role: "status" });
    this.here = el("span", { class: "quiet stride-now" });
    this.inTable = el("a", { hidden: true }, "In the table");
    const strides = this.arranged.counted
      ? []
      : [
          button("‹ Stride", "Previous stride (arrow up)", () => this.nextStride(-1)),
          button("Stride ›", "Next stride (arrow down)", () => this.nextStride(1)),
        ];
    return el(
      "div",
      { class: "replay-bar", role: "group", "aria-label": "Replay" },
      this.playButton,
      button("‹", "One picture back (arrow left)", () => this.step(-1)),
      button("›", "One picture on (arrow right)", () => this.step(1)),
      this.speed,
      this.now,
      ...strides,
      this.here,
      this.inTable,
      this.state,
      el("span", { class: "spring" }),
      el("a", { class: "button", download: true, href: linkTo(EXPORT, { session: this.session.id, name: ANGLES }) }, "Angles (CSV)"),
    );
  }

  /** What counts and sums up, from nothing: after a jump back it is told anew. */
  startAnew() {
    const { wholeBody, legs, counted } = this.arranged;
    this.numbers = new LiveNumbers();
    if (legs) this.numbers.only(legs);
    if (this.recorded.task === "marching") this.numbers.onTheSpot();
    this.counter = new RepetitionCounter();
    if (wholeBody) this.counter.showWholeBody(wholeBody);
    this.counter.node.hidden = !counted;
    this.strip = stripOf(this.recorded);
    const numbers = el("section", { class: "panel numbers-panel", "aria-label": "Numbers", hidden: counted });
    numbers.append(this.numbers.node);
    fill(this.counted, this.counter.node, numbers);
    fill(this.stripPlace, this.strip?.node);
  }

  onPast() {
    if (this.disposed) return false;
    const { strides, phases, repetitions } = this.past;
    strides.sort((a, b) => a.end_s - b.end_s);
    this.past.contacts.sort((a, b) => a.at_s - b.at_s);
    this.ends = strides.map(({ end_s }) => ({ at_s: end_s }));
    this.begins = strides.map(({ start_s }) => ({ at_s: start_s })).sort((a, b) => a.at_s - b.at_s);
    this.happenings = new Happenings();
    this.happenings.add([
      ...phases.flatMap((phase) => this.tellPhase(phase)),
      ...repetitions.map((each) => ({ at_s: each.end_s, tell: () => this.counter.onRepetition(each) })),
      ...strides.map((each) => ({ at_s: each.end_s, tell: () => this.tellStride(each) })),
    ]);
    this.timeline.show(this.past, this.arranged.counted ? [] : this.arranged.sides, this.segments);
    this.goTo(true);
    return true;
  }

  tellPhase(phase) {
    const begins = { at_s: phase.start_s, tell: () => this.strip?.onPhase({ ...phase, end_s: null, end_std_s: null }) };
    const ends = { at_s: phase.end_s, tell: () => this.strip?.onPhase(phase) };
    return phase.end_s === null ? [begins] : [begins, ends];
  }

  tellStride(stride) {
    if (this.strip instanceof WalkStrip) this.strip.onStride(stride);
    if (this.player.at_s - stride.end_s > RECENT_S) return;
    this.numbers.onStride(stride);
    this.body.onStride(stride);
  }

  loaded() {
    tell(this.trouble, "");
    if (!this.player.playing) this.goTo(true);
  }

  /** Show the moment of the player. After a jump curves and sums begin anew. */
  goTo(jumped) {
    const at_s = this.player.at_s;
    this.store.need(at_s);
    this.timeline.goTo(at_s);
    say(this.now, `${clock(at_s)}${number(at_s % 1, 2).slice(1)} of ${clock(this.recorded.end_s)}`);
    if (jumped || this.happenings.needsReset(at_s)) this.jump();
    this.happenings.advance(at_s);
    this.strip?.show(at_s);
    this.showStride(at_s);
    const pose = this.store.at(at_s);
    if (pose && pose !== this.shown) this.show(pose, jumped);
  }

  jump() {
    this.shown = null;
    this.shown_s = this.player.at_s - CURVES_S;
    for (const chart of this.charts) chart.rolling.clear();
    for (const readout of this.knee?.readouts ?? []) readout.again();
    this.body.memory.clear();
    if (this.happenings.needsReset(this.player.at_s)) {
      this.startAnew();
      this.happenings.reset();
    }
  }

  show(pose, jumped) {
    const poses = this.store.between(this.shown_s, pose.at_s);
    const trail = poses.slice(0, -1);
    this.markContacts(this.shown_s, pose.at_s);
    this.shown = pose;
    this.shown_s = pose.at_s;
    this.body.show(pose, this.lengths, Boolean(this.camera));
    for (const chart of this.charts) chart.add(pose, trail);
    this.knee?.add(pose, jumped ? [] : trail);
    this.angles?.add(pose);
    this.camera?.add(pose);
    this.numbers.onPose(pose);
    this.numbers.tick(false);
    this.sensors.show(pose.sensors, this.segments, pose.at_s);
  }

  markContacts(after_s, until_s) {
    if (this.arranged.counted) return;
    const { contacts } = this.past;
    const between = contacts.slice(countUntil(contacts, after_s), countUntil(contacts, until_s));
    for (const chart of this.charts) for (const contact of between) chart.rolling.mark(contact);
  }

  /** Which stride one is in, in words, with its row in the table. */
  showStride(at_s) {
    const place = strideAt(this.past.strides, this.ends ?? [], at_s);
    this.inTable.hidden = place === null;
    if (place === null) return say(this.here, "");
    say(this.here, strideWords(this.past.strides[place]));
    this.inTable.href = `${addressOf("session", { session: this.session.id, part: "strides" })}?row=${place}`;
  }

  step(pictures) {
    this.player.pause();
    this.player.seek((Math.round(this.player.at_s * RATE_HZ) + pictures) / RATE_HZ);
  }

  /** To the beginning of the next stride of either side, or of one before. */
  nextStride(strides) {
    this.player.pause();
    const begins = this.begins ?? [];
    const at_s = this.player.at_s;
    const place = strides > 0 ? countUntil(begins, at_s + 1e-3) : countUntil(begins, at_s - 1e-3) - 1;
    if (begins[place]) this.player.seek(begins[place].at_s);
  }

  pressed(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || document.querySelector("dialog[open]")) return;
    if (event.target.closest("input, select, textarea, button, a, summary")) return;
    if (event.key === " ") {
      event.preventDefault();
      this.player.toggle();
    } else if (event.key.startsWith("Arrow")) this.timeline.pressed(event);
  }

  showState() {
    say(this.playButton, this.player.playing ? "Pause" : "Play");
    say(this.state, this.player.waiting ? "Reading …" : "");
    this.live.classList.toggle("stale", this.player.waiting);
    if (!this.player.playing) this.remember();
  }

  /** The address names the moment, so that it can be kept and sent; not any more once somebody is on the way elsewhere. */
  remember() {
    const replay = addressOf("session", { session: this.session.id, part: "replay" });
    const address = `${replay}?t=${this.player.at_s.toFixed(2)}`;
    if (location.hash.split("?")[0] === replay && location.hash !== address) history.replaceState(null, "", address);
  }

  dispose() {
    this.disposed = true;
    clearTimeout(this.timer);
    clearInterval(this.timer);
    if (this.listen) document.removeEventListener("keydown", this.listen);
    if (!this.player) return;
    this.player.dispose();
    this.store.close();
    this.timeline.dispose();
    this.body.dispose();
    for (const chart of this.charts) chart.dispose();
  }
}

