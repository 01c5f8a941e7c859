// @ts-check
// A whole session on one line: strides of both sides, turns and parts of a test, repetitions, losses, and where one is.
// A slider for pointer and keyboard; what is drawn on it is told by the numbers and tables, too.
import { el, fill, svg } from "../dom.js";
import { INK, INVALID, PANEL, PHASE_COLOURS, SIDE_COLOUR, SOFT_INK, faint } from "../palette.js";
import { clock, number } from "../units.js";
import { PHASES, WALK_PHASES, ZONE_PHASES, segmentName } from "../words.js";

/** @typedef {import("./history.js").Past} Past */

/** @type {Record<string, Record<string, string>>} */
const PARTS_OF = { timed_up_and_go: PHASES, six_minute_walk: WALK_PHASES, ten_metre_walk: ZONE_PHASES };
const LOST = "#A3211B";
const TICKS_S = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800];
const TICK_PX = 70;
const LANE = { parts: 16, side: 13, repetitions: 14, losses: 13 };
const GAP = 3;
const SCALE = 18;
const NAMES_PX = 62;

export class Timeline {
  /**
   * @param {number} end_s
   * @param {{ onSeek: (at_s: number) => void, onStep: (pictures: number) => void, onStride: (strides: number) => void }} moves
   */
  constructor(end_s, moves) {
    this.end_s = Math.max(0.1, end_s);
    this.moves = moves;
    this.at_s = 0;
    /** @type {Past | null} */
    this.past = null;
    this.drawing = svg("svg", { class: "timeline-drawing", "aria-hidden": "true" });
    this.cursor = el("span", { class: "timeline-cursor" });
    this.track = el("div", { class: "timeline-track" }, this.drawing, this.cursor);
    this.key = el("p", { class: "quiet timeline-key" });
    this.slider = el(
      "div",
      {
        class: "timeline",
        role: "slider",
        tabindex: 0,
        "aria-label": "Time in the session",
        "aria-valuemin": 0,
        "aria-valuemax": number(this.end_s, 2),
        onkeydown: (/** @type {KeyboardEvent} */ event) => this.pressed(event),
        onpointerdown: (/** @type {PointerEvent} */ event) => this.grab(event),
        onpointermove: (/** @type {PointerEvent} */ event) => this.drag(event),
      },
      this.track,
    );
    this.node = el("section", { class: "panel timeline-panel", "aria-label": "Session" }, this.slider, this.key);
    this.sizes = new ResizeObserver(() => this.draw());
    this.sizes.observe(this.track);
  }

  /** @param {Past} past @param {string[]} sides @param {Record<string, string>} segments of sensors, by name */
  show(past, sides, segments) {
    this.past = past;
    this.sides = sides;
    this.segments = segments;
    this.draw();
  }

  /** @param {number} at_s */
  goTo(at_s) {
    this.at_s = at_s;
    this.cursor.style.transform = `translateX(${this.place(at_s)}px)`;
    this.slider.setAttribute("aria-valuenow", at_s.toFixed(2));
    this.slider.setAttribute("aria-valuetext", `${number(at_s, 2)} s of ${number(this.end_s, 0)} s`);
  }

  /** @param {number} at_s */
  place(at_s) {
    return NAMES_PX + ((this.track.clientWidth - NAMES_PX - 8) * at_s) / this.end_s;
  }

  /** @param {PointerEvent} event */
  grab(event) {
    if (event.button !== 0) return;
    this.slider.setPointerCapture(event.pointerId);
    this.seekTo(event);
  }

  /** @param {PointerEvent} event */
  drag(event) {
    if (this.slider.hasPointerCapture(event.pointerId)) this.seekTo(event);
  }

  /** @param {PointerEvent} event */
  seekTo(event) {
    const x = event.clientX - this.track.getBoundingClientRect().left - NAMES_PX;
    this.moves.onSeek((x / (this.track.clientWidth - NAMES_PX - 8)) * this.end_s);
  }

  /** @param {KeyboardEvent} event */
  pressed(event) {
    /** @type {Record<string, () => void>} */
    const keys = {
      ArrowLeft: () => this.moves.onStep(-1),
      ArrowRight: () => this.moves.onStep(1),
      ArrowUp: () => this.moves.onStride(-1),
      ArrowDown: () => this.moves.onStride(1),
      PageUp: () => this.moves.onSeek(this.at_s - 10),
      PageDown: () => this.moves.onSeek(this.at_s + 10),
      Home: () => this.moves.onSeek(0),
      End: () => this.moves.onSeek(this.end_s),
    };
    const move = keys[event.key];
    if (!move || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    move();
  }

  draw() {
    const width = this.track.clientWidth;
    if (width === 0) return;
    const lanes = this.past ? lanesOf(this.past, this.sides ?? [], this.segments ?? {}) : [];
    let top = 2;
    const drawn = [];
    for (const { name, height, parts } of lanes) {
      drawn.push(label(name, top + height / 2), ...this.drawParts(parts, top, height));
      top += height + GAP;
    }
    const height = top + SCALE;
    this.drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.drawing.setAttribute("height", String(height));
    this.drawing.replaceChildren(...drawn, ...this.ticks(top));
    this.cursor.style.height = `${height - SCALE + 4}px`;
    fill(this.key, ...keyOf(lanes));
    this.goTo(this.at_s);
  }

  /**
   * One path for all parts that look alike: an hour has thousands.
   * @param {Part[]} parts @param {number} top @param {number} height
   */
  drawParts(parts, top, height) {
    const looks = Map.groupBy(parts, ({ look }) => look);
    const paths = [...looks].map(([look, alike]) => {
      const d = alike.map(({ from_s, to_s }) => {
        const [left, right] = [this.place(from_s), this.place(to_s ?? this.end_s)];
        return `M${left.toFixed(1)} ${top}h${Math.max(0.8, right - left - 0.6).toFixed(1)}v${height}H${left.toFixed(1)}z`;
      });
      return svg("path", { d: d.join(""), ...LOOKS[look], class: `look-${look}` });
    });
    const words = parts.flatMap(({ from_s, to_s, look, text }) => {
      const [left, right] = [this.place(from_s), this.place(to_s ?? this.end_s)];
      const fits = text && right - left > 6.2 * text.length;
      if (!fits) return [];
      const at = { x: left + 4, y: top + height - 3.5, "font-size": 11, fill: look === "lost" ? PANEL : INK };
      return [svg("text", at, text)];
    });
    return [...paths, ...words];
  }

  /** @param {number} top */
  ticks(top) {
    const most = Math.max(2, this.track.clientWidth / TICK_PX);
    const step = TICKS_S.find((each) => this.end_s / each <= most) ?? 3600;
    const marks = [];
    for (let at_s = 0; at_s <= this.end_s; at_s += step) {
      const x = this.place(at_s);
      marks.push(svg("line", { x1: x, x2: x, y1: top, y2: top + 4, stroke: SOFT_INK }));
      marks.push(svg("text", { x, y: top + 15, "text-anchor": "middle", "font-size": 11, fill: SOFT_INK }, clock(at_s)));
    }
    return marks;
  }

  dispose() {
    this.sizes.disconnect();
  }
}

/**
 * @typedef {{from_s: number, to_s: number | null, look: keyof typeof LOOKS, text?: string}} Part
 * @typedef {{name: string, height: number, parts: Part[]}} Lane
 */

const LOOKS = {
  ...Object.fromEntries(Object.entries(PHASE_COLOURS).map(([phase, colour]) => [phase, { fill: colour }])),
  left: { fill: faint(SIDE_COLOUR.left, 0.75) },
  right: { fill: faint(SIDE_COLOUR.right, 0.75) },
  refused: { fill: PANEL, stroke: INVALID, "stroke-width": 1 },
  repetition: { fill: "#6F8D99" },
  lost: { fill: LOST },
  mark: { fill: INK },
};

/**
 * What is drawn: a lane only where there is something on it.
 * @param {Past} past @param {string[]} sides @param {Record<string, string>} segments
 * @returns {Lane[]}
 */
export function lanesOf({ strides, phases, marks, losses, repetitions }, sides, segments) {
  const turns = strides.filter(({ turning }) => turning).map(({ start_s, end_s }) => ({ from_s: start_s, to_s: end_s }));
  const parts = phases.length > 0 ? phases.map(phasePart) : turns.map((turn) => ({ ...turn, look: "turn" }));
  const standing = marks.map(({ from_s, to_s }) => ({ from_s, to_s, look: "mark", text: "" }));
  const lanes = [
    { name: phases.length > 0 ? "Parts" : "Turns", height: LANE.parts, parts },
    ...sides.map((side) => ({
      name: side === "left" ? "L strides" : "R strides",
      height: LANE.side,
      parts: strides
        .filter((stride) => stride.side === side)
        .map(({ start_s, end_s, valid }) => ({ from_s: start_s, to_s: end_s, look: valid ? side : "refused" })),
    })),
    { name: "Repetitions", height: LANE.repetitions, parts: repetitions.map(repetitionPart) },
    { name: "Marked", height: LANE.losses, parts: standing },
    {
      name: "Losses",
      height: LANE.losses,
      parts: losses.map(({ source, start_s, end_s }) => {
        const text = segmentName(segments[source] ?? source);
        return { from_s: start_s, to_s: end_s, look: "lost", text };
      }),
    },
  ];
  return /** @type {Lane[]} */ (lanes.filter((lane) => lane.parts.length > 0));
}

/** @param {Past["phases"][number]} phase */
const phasePart = ({ task, phase, start_s, end_s }) => ({
  from_s: start_s,
  to_s: end_s,
  look: phase,
  text: PARTS_OF[task]?.[phase] ?? "",
});

/** @param {Past["repetitions"][number]} repetition */
const repetitionPart = ({ start_s, end_s, valid, side }) => ({
  from_s: start_s,
  to_s: end_s,
  look: valid ? (side ?? "repetition") : "refused",
});

/** @param {string} text @param {number} y */
const label = (text, y) => svg("text", { x: 0, y: y + 4, "font-size": 11, fill: SOFT_INK }, text);

/** @param {Lane[]} lanes */
function keyOf(lanes) {
  const looks = new Set(lanes.flatMap(({ parts }) => parts.map(({ look }) => look)));
  const words = ["← → a picture, ↑ ↓ a stride, Page ↑ ↓ ten seconds, space plays"];
  if (looks.has("refused")) words.push("hollow: does not count");
  return words.map((text) => el("span", {}, text));
}
