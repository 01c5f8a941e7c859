// The cameras of a running session, each with its state in a word, and what was measured of the body.
import { CAMERAS, cameraWord } from "./camera_words.js";
import { el, fill, say } from "./dom.js";
import { number } from "./units.js";
import { jointName } from "./words.js";

export class CameraPanel {
  constructor(cameras) {
    const rates = cameras.map((camera) => `${number(camera.rate_hz, 0)} pictures/s`);
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
        el("span", { class: "quiet" }, rates.join(", ")),
      ),
      this.more,
    );
  }

  add(pose) {
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
