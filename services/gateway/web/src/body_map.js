// A body from the front with a dot where each sensor is worn. The dot's form tells its state as its colour does.
import { svg } from "./dom.js";
import { GHOST, SOFT_INK } from "./palette.js";
import { SENSOR_WORDS, segmentName } from "./words.js";

/** Places on a body seen from the front: the person's right is on the left. */
export const PLACES = {
  torso: [50, 52],
  pelvis: [50, 88],
  thigh_right: [39, 121],
  thigh_left: [61, 121],
  shank_right: [39, 164],
  shank_left: [61, 164],
  foot_right: [36, 201],
  foot_left: [64, 201],
};
export const OUTLINE =
  "M50 4a12 13 0 0 1 0 26a12 13 0 0 1 0-26z " +
  "M44 32h12c10 2 16 6 17 14l5 40-6 2-6-30-1 20 2 24-3 46-2 50 8 7H59l-5-50-3-40h-2l-3 40-5 50H29l8-7-2-50-3-46 2-24-1-20-6 30-6-2 5-40" +
  "c1-8 7-12 17-14z";
const RADIUS = 6.5;

/** Forms: full when all is well, a ring while it waits, a diamond to be looked at, a broken ring when it is gone. */
const FORMS = {
  good: { d: circle(RADIUS), class: "dot full" },
  wait: { d: circle(RADIUS - 1), class: "dot ring" },
  check: { d: `M0 ${-RADIUS - 2}L${RADIUS + 2} 0L0 ${RADIUS + 2}L${-RADIUS - 2} 0z`, class: "dot full" },
  lost: { d: circle(RADIUS), class: "dot ring broken" },
  done: { d: circle(3), class: "dot ring" },
};

export class BodyMap {
  constructor() {
    this.dots = svg("g");
    const letter = { "font-size": 13, "font-weight": 700, fill: SOFT_INK, "text-anchor": "middle" };
    const [right, left] = [svg("text", { x: 14, y: 150, ...letter }), svg("text", { x: 86, y: 150, ...letter })];
    right.append("R");
    left.append("L");
    this.node = svg(
      "svg",
      { class: "body-map", viewBox: "0 0 100 216", role: "img", "aria-label": "Sensors on the body" },
      svg("path", { d: OUTLINE, fill: GHOST }),
      right,
      left,
      this.dots,
    );
  }

  /** @param {{segment: string, state: string}[]} sensors */
  show(sensors) {
    const drawn = sensors.map(({ segment, state }) => `${segment} ${state}`).join();
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    const known = sensors.filter(({ segment }) => segment in PLACES);
    this.dots.replaceChildren(...known.map(dot));
    const told = known.map(({ segment, state }) => `${segmentName(segment)}: ${SENSOR_WORDS[state].word}`);
    this.node.setAttribute("aria-label", told.length > 0 ? told.join(". ") : "Sensors on the body");
  }
}

/** @param {{segment: string, state: string}} sensor */
function dot({ segment, state }) {
  const { word, tone } = SENSOR_WORDS[state];
  const [x, y] = PLACES[/** @type {keyof typeof PLACES} */ (segment)];
  const { d, class: look } = FORMS[/** @type {keyof typeof FORMS} */ (tone)];
  const title = svg("title");
  title.append(`${segmentName(segment)}: ${word}`);
  return svg("path", { d, class: look, "data-tone": tone, transform: `translate(${x} ${y})` }, title);
}

/** @param {number} radius */
function circle(radius) {
  return `M${-radius} 0a${radius} ${radius} 0 1 0 ${2 * radius} 0a${radius} ${radius} 0 1 0 ${-2 * radius} 0z`;
}
