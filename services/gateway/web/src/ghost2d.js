// Another stride of the same person on paper: broad pale legs behind the person's own.
import { svg } from "./dom.js";
import { GHOST_INK } from "./palette.js";
import { SIDES } from "./vectors.js";

const LINES = SIDES.flatMap((side) => [
  [`hip_${side}`, `knee_${side}`],
  [`knee_${side}`, `ankle_${side}`],
  [`ankle_${side}`, `toe_${side}`],
]);

export class Ghost2d {
  /** @param {SVGElement} body */
  constructor(body) {
    const look = { stroke: GHOST_INK, "stroke-width": 15, "stroke-opacity": 0.4, "stroke-linecap": "round" };
    this.lines = LINES.map(([from, to]) => ({ from, to, node: svg("line", { visibility: "hidden", ...look }) }));
    body.prepend(...this.lines.map(({ node }) => node));
  }

  /** @param {any} figure null for none @param {(point: number[]) => number[]} project */
  show(figure, project) {
    for (const { from, to, node } of this.lines) {
      const seen = figure && figure.points[from] && figure.points[to];
      node.setAttribute("visibility", seen ? "visible" : "hidden");
      if (!seen) continue;
      const [[x1, y1], [x2, y2]] = [project(figure.points[from]), project(figure.points[to])];
      for (const [name, value] of Object.entries({ x1, y1, x2, y2 })) node.setAttribute(name, value.toFixed(1));
    }
  }
}
