// The cameras of a running session, each with its state in a word, how many pictures come, and what was measured of the
// body.
import { CAMERAS, cameraWord } from "./camera_words.js";
import { el, fill, say } from "./dom.js";
import { number } from "./units.js";
import { jointName } from "./words.js";

const SPAN_S = 2;
const SLOW_SHARE = 0.3;

/** How many pictures a second came lately, by the times of the data; null before there are some. */
export class PictureRate {
  constructor() {
    this.times = [];
  }

  add(poses) {
    for (const { at_s } of poses) if (!(at_s <= this.times.at(-1))) this.times.push(at_s);
    const first = this.times.findIndex((at_s) => at_s > this.times.at(-1) - SPAN_S);
    this.times.splice(0, first);
  }

  get value() {
    const span = this.times.at(-1) - this.times[0];
    return this.times.length > 5 && span > 0.5 ? (this.times.length - 1) / span : null;
  }
}

export class CameraPanel {
  constructor(cameras) {
    this.rate = new PictureRate();
    this.nominal_hz = Math.max(...cameras.map((camera) => camera.rate_hz));
    this.rateText = el("span", { class: "quiet" });
    this.lines = cameras.map((camera) => ({ camera, chip: el("span", { class: "chip small" }, "Waiting") }));
    /** To be shown beside the picture. */
    this.chips = el("span", { class: "camera-chips", role: "status" }, ...this.lines.map(({ chip }) => chip));
    this.datum = el("p", { class: "quiet" });
    this.lengths = el("dl", { class: "lengths" });
    const summary = el("summary", { class: "quiet" }, "Zero of the angles, segment lengths");
    this.more = el("details", { hidden: true }, summary, this.datum, this.lengths);
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Camera" },
      el(
        "div",
        { class: "panel-head" },
        el("h2", {}, cameras.map((camera) => CAMERAS[camera.kind] ?? camera.name).join(", ")),
        el("span", { class: "spring" }),
        this.rateText,
      ),
      this.more,
    );
  }

  add(pose, trail) {
    this.rate.add([...trail, pose]);
    say(this.rateText, rateText(this.rate.value, this.nominal_hz));
    for (const { camera, chip } of this.lines) {
      const status = pose.cameras.find((each) => each.camera === camera.name);
      const { word, tone } = status ? cameraWord(status) : { word: "Waiting", tone: "wait" };
      say(chip, word);
      chip.dataset.tone = tone;
    }
  }

  showCalibration({ datum, lengths }) {
    say(this.datum, datum ? `Zero is ${datum}` : "");
    this.more.hidden = false;
    fill(this.lengths, ...lengthRows(lengths));
  }

  tick(stale) {
    for (const node of [this.node, this.chips]) node.classList.toggle("stale", stale);
  }
}

/** What the camera should send, and what comes of it where that is clearly less. Not every picture is sent on. */
function rateText(rate_hz, nominal_hz) {
  const slow = rate_hz !== null && rate_hz < SLOW_SHARE * nominal_hz;
  return slow ? `${number(rate_hz, 0)} of ${number(nominal_hz, 0)} pictures/s` : `${number(nominal_hz, 0)} pictures/s`;
}

/** Names of segments with their lengths in cm, both sides on one line. */
function lengthRows(lengths) {
  const rows = new Map();
  for (const [name, length_m] of Object.entries(lengths)) {
    const [words, side] = jointName(name);
    const text = `${side ? `${side === "left" ? "L" : "R"} ` : ""}${number(100 * length_m, 1)}`;
    rows.set(words, [...(rows.get(words) ?? []), text].toSorted());
  }
  return [...rows].map(([words, texts]) => el("div", {}, el("dt", {}, words), el("dd", {}, `${texts.join("  ")} cm`)));
}
