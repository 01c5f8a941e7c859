// The sensors of a running session: a body with a dot for each, and each with its state in a word, its age when it is
// silent, and what it lost lately. Nothing is shown that no device has told: there is no battery here.
import { BodyMap } from "./body_map.js";
import { el, fill, say } from "./dom.js";
import { number } from "./units.js";
import { SENSOR_WORDS, segmentName } from "./words.js";

/** Silence shorter than that is the pace of a radio. */
const SILENT_S = 0.5;
/** A share that rounds to 0.1 %. */
const WORTH_SAYING = 0.0005;

/**
 * @typedef {{sensor: string, state: string, since_s: number}} SensorState
 * @typedef {{name: string, lost: number|null, refused: number|null}} Shares
 */

export class SensorPanel {
  constructor() {
    this.map = new BodyMap();
    this.list = el("ul", { class: "sensors" });
    this.span = el("span", { class: "quiet" });
    this.datum = el("p", { class: "quiet datum", hidden: true });
    /** @type {Map<string, {item: HTMLElement, chip: HTMLElement, note: HTMLElement}>} */
    this.lines = new Map();
    /** @type {Map<string, Shares>} */
    this.shares = new Map();
    this.node = el(
      "section",
      { class: "panel sensor-panel", "aria-label": "Sensors" },
      el("div", { class: "panel-head" }, el("h2", {}, "Sensors"), el("span", { class: "spring" }), this.span),
      el("div", { class: "sensor-body" }, this.map.node, this.list),
      this.datum,
    );
  }

  /** @param {SensorState[]} sensors @param {Record<string, string>} segments of each sensor, by name @param {number} at_s */
  show(sensors, segments, at_s) {
    if (sensors.length !== this.lines.size || !sensors.every(({ sensor }) => this.lines.has(sensor)))
      this.build(sensors, segments);
    this.map.show(sensors.map(({ sensor, state }) => ({ segment: segments[sensor] ?? sensor, state })));
    for (const { sensor, state, since_s } of sensors) {
      const { chip, note } = this.lines.get(sensor);
      const { word, tone } = SENSOR_WORDS[state];
      say(chip, word);
      chip.dataset.tone = tone;
      const silent_s = at_s - since_s;
      const hasAge = state !== "unused" && state !== "calibrating" && silent_s > SILENT_S;
      say(note, hasAge ? `${since_s === 0 ? "never heard" : `for ${number(silent_s, 0)} s`}` : this.lossOf(sensor));
    }
  }

  /** What each sensor lost between two times. @param {{at_s: number, since_s: number, sources: Shares[]}} quality */
  onQuality({ at_s, since_s, sources }) {
    this.shares = new Map(sources.map((each) => [each.name, each]));
    say(this.span, `loss in the last ${number(at_s - since_s, 0)} s`);
  }

  /** @param {string} sensor */
  lossOf(sensor) {
    const { lost = null, refused = null } = this.shares.get(sensor) ?? {};
    if (lost === null) return "";
    const parts = [`${number(100 * lost, lost < WORTH_SAYING ? 0 : 1)} %`];
    if (refused !== null && refused >= WORTH_SAYING) parts.push(`${number(100 * refused, 1)} % refused`);
    return parts.join(", ");
  }

  /** @param {SensorState[]} sensors @param {Record<string, string>} segments */
  build(sensors, segments) {
    const lines = sensors.map(({ sensor }) => {
      const [chip, note] = [el("span", { class: "chip small" }), el("span", { class: "quiet loss" })];
      const name = el("span", { class: "sensor-name" }, segmentName(segments[sensor] ?? sensor));
      return { sensor, chip, note, item: el("li", {}, name, note, chip) };
    });
    this.lines = new Map(lines.map((line) => [line.sensor, line]));
    fill(this.list, ...lines.map(({ item }) => item));
  }

  /** @param {string} datum what an angle of zero means */
  showDatum(datum) {
    say(this.datum, `Zero is ${datum}`);
    this.datum.hidden = datum === "";
  }

  /** @param {boolean} stale */
  tick(stale) {
    this.list.classList.toggle("stale", stale);
    this.map.node.classList.toggle("stale", stale);
  }
}
