// Trunk, arms and head on paper, of a body that a camera sees.
import { HEAD_RADIUS_M, UPPER_BONES } from "./bones.js";
import { svg } from "./dom.js";
import { GHOST, INVALID } from "./palette.js";

/** px of a line per m of the bone's radius. */
const THICKNESS = 200;
const DASH = { left: null, right: "18 9" };

export class PaperTrunk {
  constructor(root) {
    this.lines = UPPER_BONES.map(({ from, to, bone, side, colour, radii }) => {
      const dash = DASH[side] ?? null;
      const line = svg("line", {
        stroke: colour,
        "stroke-width": (THICKNESS * (radii[0] + radii[1])) / 2,
        "stroke-linecap": dash ? "butt" : "round",
        "stroke-dasharray": dash,
        visibility: "hidden",
      });
      root.append(line);
      return { line, from, to, bone, colour };
    });
    this.head = svg("circle", { fill: GHOST, visibility: "hidden" });
    root.append(this.head);
  }

  /** `at` gives the place of a point on paper, null for one that is not there; `scale` is px per m. */
  show({ inRoom, valid }, at, scale) {
    for (const { line, from, to, bone, colour } of this.lines) {
      const [a, b] = inRoom ? [at(from), at(to)] : [null, null];
      line.setAttribute("visibility", a && b ? "visible" : "hidden");
      if (!a || !b) continue;
      ["x1", "y1", "x2", "y2"].forEach((name, place) => line.setAttribute(name, [...a, ...b][place]));
      line.setAttribute("stroke", bone === null || valid[bone] ? colour : INVALID);
    }
    const head = inRoom ? at("head") : null;
    this.head.setAttribute("visibility", head ? "visible" : "hidden");
    if (!head) return;
    this.head.setAttribute("cx", head[0]);
    this.head.setAttribute("cy", head[1]);
    this.head.setAttribute("r", String(HEAD_RADIUS_M * scale));
  }
}
