// The sensors of a running session, each with its state in a word, and what their zero means.
import { el, fill, say } from "./dom.js";
import { SENSOR_WORDS, segmentName } from "./words.js";

export class SensorList {
  constructor() {
    this.list = el("ul", { class: "sensors" });
    this.datum = el("p", { class: "quiet datum", hidden: true });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Sensors" },
      el("h2", {}, "Sensors"),
      this.list,
      this.datum,
    );
  }

  /** `segments` is the segment of each sensor, by name. */
  show(sensors, segments) {
    const text = sensors.map((each) => each.sensor + each.state).join();
    if (text === this.text) return;
    this.text = text;
    fill(this.list, ...sensors.map((each) => line(segments[each.sensor] ?? each.sensor, SENSOR_WORDS[each.state])));
  }

  showDatum(datum) {
    say(this.datum, `Zero is ${datum}`);
    this.datum.hidden = datum === "";
  }

  tick(stale) {
    this.list.classList.toggle("stale", stale);
  }
}

function line(segment, { word, tone }) {
  const chip = el("span", { class: "chip small", "data-tone": tone }, word);
  return el("li", {}, el("span", {}, segmentName(segment)), chip);
}
