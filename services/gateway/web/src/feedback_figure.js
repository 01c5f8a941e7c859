// What a patient sees: an abstract person with the part that matters, and a scale with a zone to reach.
// The mark is an arrow that says where to go; in the zone it is a disc with a tick. No cross, and nothing red.
import { svg } from "./dom.js";
import { CUES, REACH } from "./feedback_cues.js";

const INK = "#22434A";
const PALE = "#D3E2E0";
const ZONE = "#8CCDBB";
const WARM = "#F2B84B";
const REACHED = "#0B7A68";
const SCALE = { width: 900, height: 220, y: 110, edge: 60 };

const limb = (d, colour, width = 30) =>
  svg("path", { d, fill: "none", stroke: colour, "stroke-width": width, "stroke-linecap": "round", "stroke-linejoin": "round" });

/** A person from the side, walking to the right; the part that the cue is about is dark. */
export function person({ cue }) {
  const matter = { speed: "all", cadence: "legs", symmetry: "legs", knee: "front", repetitions: "all" }[cue];
  const body = matter === "all" ? INK : PALE;
  const back = matter === "front" ? PALE : INK;
  return svg(
    "svg",
    { viewBox: "0 0 260 420", class: "feedback-person", "aria-hidden": "true" },
    svg("circle", { cx: 130, cy: 48, r: 36, fill: body }),
    limb("M128 108V220", body, 44),
    limb("M128 220L96 300L44 372", back),
    limb(cue === "knee" ? "M128 220L196 272L168 350" : "M128 220L172 296L190 384", INK),
  );
}

const placeOf = (place) => SCALE.width / 2 + (place / REACH) * (SCALE.width / 2 - SCALE.edge);

/** The scale of a cue; redrawn only when there is something else to see. */
export class Scale {
  /** @param {string} cue */
  constructor(cue) {
    const [low, high] = CUES[cue].zone.map(placeOf);
    const bar = { y: SCALE.y - 28, height: 56, rx: 28 };
    this.mark = svg("g", { class: "feedback-mark" });
    this.node = svg(
      "svg",
      { viewBox: `0 0 ${SCALE.width} ${SCALE.height}`, class: "feedback-scale", "aria-hidden": "true" },
      svg("rect", { ...bar, x: SCALE.edge / 2, width: SCALE.width - SCALE.edge, fill: PALE }),
      svg("rect", { x: low, width: high - low, y: SCALE.y - 74, height: 148, rx: 40, fill: ZONE }),
      this.mark,
    );
    if (cue === "symmetry") this.node.append(letter("L", 40), letter("R", SCALE.width - 40));
  }

  /** @param {{state: string, place: number|null}} progress */
  show({ state, place }) {
    const drawn = `${state} ${place?.toFixed(2)}`;
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    this.mark.replaceChildren(...(place === null ? [] : markOf(state)));
    if (place !== null) this.mark.style.transform = `translate(${placeOf(place).toFixed(1)}px, ${SCALE.y}px)`;
  }
}

function markOf(/** @type {string} */ state) {
  const look = { stroke: INK, "stroke-width": 8, "stroke-linejoin": "round" };
  if (state === "in") return [svg("circle", { r: 62, fill: REACHED }), limb("M-28 2L-8 24L30 -20", "#FFFFFF", 14)];
  const arrow = "M-52 -34H4V-62L66 0L4 62V34H-52z";
  return [svg("path", { d: arrow, fill: WARM, transform: state === "high" ? "scale(-1 1)" : "", ...look })];
}

function letter(/** @type {string} */ text, /** @type {number} */ x) {
  const node = svg("text", { x, y: 30, "font-size": 44, "font-weight": 700, fill: INK, "text-anchor": "middle" });
  node.append(text);
  return node;
}

/** A ring that fills with what is done. */
export class Ring {
  constructor() {
    this.arc = svg("path", { fill: "none", stroke: REACHED, "stroke-width": 46, "stroke-linecap": "round" });
    this.tick = limb("M-46 4L-12 40L52 -34", REACHED, 26);
    this.node = svg(
      "svg",
      { viewBox: "-160 -160 320 320", class: "feedback-ring", "aria-hidden": "true" },
      svg("circle", { r: 120, fill: "none", stroke: PALE, "stroke-width": 46 }),
      this.arc,
      this.tick,
    );
  }

  /** @param {{state: string, done: number}} progress @param {number} target */
  show({ state, done }, target) {
    const share = Math.min(0.9999, done / target);
    const [x, y] = [120 * Math.sin(2 * Math.PI * share), -120 * Math.cos(2 * Math.PI * share)];
    this.arc.setAttribute("d", share === 0 ? "" : `M0 -120A120 120 0 ${share > 0.5 ? 1 : 0} 1 ${x} ${y}`);
    this.tick.setAttribute("visibility", state === "in" ? "visible" : "hidden");
  }
}
