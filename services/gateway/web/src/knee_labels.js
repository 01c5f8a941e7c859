// The angle beside each knee of legs that are drawn alone: text over the picture, so that it stays sharp.
import { el, say } from "./dom.js";
import { SIDES } from "./vectors.js";
import { degrees, number } from "./units.js";

export class KneeLabels {
  constructor(host) {
    this.nodes = SIDES.map((side) => {
      const value = el("b", { class: side });
      const spread = el("span", { class: "quiet" });
      const node = el("div", { class: "knee-label", "aria-hidden": "true", hidden: true }, value, spread);
      host.append(node);
      return { side, node, value, spread };
    });
  }

  /** `place` gives the px of a point. A knee without an angle has no label: its bones are grey. */
  show(figure, angles, place) {
    for (const { side, node, value, spread } of this.nodes) {
      const angle = angles[side];
      node.hidden = figure.whole || !angle || !figure.sides.includes(side);
      if (node.hidden) continue;
      say(value, `${number(degrees(angle.value), 0)}°`);
      say(spread, ` ± ${number(degrees(2 * angle.std), 0)}°`);
      const [x, y] = place(figure.points[`label_${side}`]);
      node.style.transform = `translate(-50%, -50%) translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    }
  }

  dispose() {
    for (const { node } of this.nodes) node.remove();
  }
}
