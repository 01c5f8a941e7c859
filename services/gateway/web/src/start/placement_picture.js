// Where what measures the person sits: a body seen from the front, so its left is on the right of the picture.
import { OUTLINE, PLACES } from "../body_map.js";
import { el, svg } from "../dom.js";
import { GHOST, INK, LEFT, PELVIS, RIGHT, SOFT_INK } from "../palette.js";
import { segmentName } from "../words.js";

const WHERE = {
  pelvis: "at the back, on the belt line",
  thigh: "half-way down, on the outer side or in front",
  shank: "half-way down, on the outer side or on the shin",
};
const LEGS = ["thigh_left", "shank_left", "thigh_right", "shank_right"];
const CAMERA = "Camera at hip height, 2 to 3.5 m in front, the whole body in view.";

/** @type {Record<string, {segments: string[], camera: boolean, lines: string[]}>} */
const SHOWN = {
  lower_body: { segments: ["pelvis", ...LEGS], camera: false, lines: [] },
  knee: {
    segments: ["thigh_left", "shank_left"],
    camera: false,
    lines: ["Drawn on the left leg; the source says which leg is worn."],
  },
  camera: { segments: [], camera: true, lines: ["Nothing is worn.", CAMERA, "Nobody else in view."] },
  camera_and_sensors: { segments: ["pelvis", ...LEGS], camera: true, lines: [CAMERA] },
};

/** The picture, and the same in words. @param {string|null} worn null: not known before the start */
export function placementPicture(worn) {
  const shown = worn === null ? null : SHOWN[worn];
  if (!shown) return el("p", { class: "quiet" }, "What is worn is shown once the session has begun.");
  const lines = [...shown.segments.map((segment) => `${segmentName(segment)}: ${where(segment)}`), ...shown.lines];
  const label = "Where it sits, seen from the front; in words beside it";
  return el(
    "div",
    { class: "placement" },
    svg(
      "svg",
      { viewBox: "-16 0 132 232", role: "img", "aria-label": label },
      svg("path", { d: OUTLINE, fill: GHOST }),
      word(-10, "Right", "start"),
      word(110, "Left", "end"),
      ...(shown.camera ? camera() : []),
      ...shown.segments.flatMap(badge),
    ),
    el("ul", {}, ...lines.map((line) => el("li", {}, line))),
  );
}

/** @param {string} segment */
const where = (segment) => WHERE[/** @type {keyof typeof WHERE} */ (segment.split("_")[0])];

/** @param {number} x @param {string} words @param {string} anchor */
function word(x, words, anchor) {
  const node = svg("text", { x, y: 14, "font-size": 9, fill: SOFT_INK, "text-anchor": anchor });
  node.append(words);
  return node;
}

/** A case with the letter of its side, told apart without its colour. @param {string} segment */
function badge(segment) {
  const [x, y] = PLACES[/** @type {keyof typeof PLACES} */ (segment)];
  const [letter, fill] = segment.endsWith("_left") ? ["L", LEFT] : segment.endsWith("_right") ? ["R", RIGHT] : ["P", PELVIS];
  const text = svg("text", { x, y: y + 3, "font-size": 8.5, "font-weight": 700, fill: "#fff", "text-anchor": "middle" });
  text.append(letter);
  return [svg("rect", { x: x - 6.5, y: y - 8, width: 13, height: 16, rx: 3.5, fill }), text];
}

function camera() {
  const [x, y] = [50, 224];
  const view = `M${x} ${y}L-10 24M${x} ${y}L110 24`;
  return [
    svg("path", { d: view, stroke: SOFT_INK, "stroke-width": 0.8, "stroke-dasharray": "3 3", fill: "none" }),
    svg("rect", { x: x - 13, y: y - 6, width: 26, height: 12, rx: 3.5, fill: INK }),
    svg("circle", { cx: x, cy: y, r: 3.2, fill: "#fff" }),
  ];
}
