// The side view on paper: without WebGL, for print, and for people who asked for less motion.
import { SIDES, Stage } from "./figure.js";
import { GHOST, INVALID, PELVIS, SIDE_COLOUR } from "./palette.js";
import { svg } from "./dom.js";

const SCALE = 285;
const WIDTH = 380;
const FLOOR = 428;

export class Skeleton2d {
  constructor(host) {
    this.host = host;
    this.stage = new Stage();
    this.view = "side";
    this.root = svg("svg", {
      viewBox: `0 0 ${WIDTH} 450`,
      role: "img",
      "aria-label": "Stick figure of the legs",
      class: "paper",
    });
    this.root.append(svg("line", { x1: 30, x2: WIDTH - 30, y1: FLOOR, y2: FLOOR, stroke: GHOST, "stroke-width": 2 }));
    this.trunk = this.line(GHOST, 10);
    this.legs = {};
    for (const side of ["left", "right"]) {
      this.legs[side] = {
        thigh: this.line(SIDE_COLOUR[side], 9, side),
        shank: this.line(SIDE_COLOUR[side], 9, side),
        foot: this.line(GHOST, 6),
        letter: svg("text", { fill: SIDE_COLOUR[side], "font-size": 20, "font-weight": 700 }),
      };
      this.legs[side].letter.append(side === "left" ? "L" : "R");
      this.root.append(this.legs[side].letter);
    }
    this.pelvis = this.line(PELVIS, 12);
    host.append(this.root);
  }

  line(colour, width, side) {
    const dash = side === "right" ? "26 14" : null;
    const node = svg("line", {
      stroke: colour,
      "stroke-width": width,
      "stroke-linecap": dash ? "butt" : "round",
      "stroke-dasharray": dash,
    });
    this.root.append(node);
    return node;
  }

  look(from) {
    this.view = from;
    if (this.last) this.show(this.last);
  }

  show(figure) {
    this.last = figure;
    const now = performance.now() / 1000;
    this.stage.follow(figure, Math.min(0.1, now - (this.drawn ?? now)));
    this.drawn = now;
    const at = (name) => this.project(figure.points[name]);
    draw(this.trunk, at("pelvis_top"), at("neck"));
    draw(
      this.pelvis,
      this.view === "side" ? at("pelvis_top") : at("hip_left"),
      this.view === "side" ? at("hip_right") : at("hip_right"),
    );
    for (const side of SIDES) {
      const leg = this.legs[side];
      draw(leg.thigh, at(`hip_${side}`), at(`knee_${side}`));
      draw(leg.shank, at(`knee_${side}`), at(`ankle_${side}`));
      draw(leg.foot, at(`ankle_${side}`), at(`toe_${side}`));
      leg.thigh.setAttribute("stroke", figure.valid[`thigh_${side}`] ? SIDE_COLOUR[side] : INVALID);
      leg.shank.setAttribute("stroke", figure.valid[`shank_${side}`] ? SIDE_COLOUR[side] : INVALID);
      const [x, y] = at(`ankle_${side}`);
      leg.letter.setAttribute("x", x - 30);
      leg.letter.setAttribute("y", y + 4);
    }
  }

  project([x, y, z]) {
    const cos = Math.cos(this.stage.heading);
    const sin = Math.sin(this.stage.heading);
    const forward = x * cos - z * sin;
    const right = x * sin + z * cos;
    const across = { side: forward, front: -right, back: right }[this.view];
    return [WIDTH / 2 + across * SCALE, FLOOR - 8 - (y - this.stage.ground) * SCALE];
  }

  setStale(stale) {
    this.host.classList.toggle("stale", stale);
  }

  dispose() {
    this.root.remove();
  }
}

function draw(line, [x1, y1], [x2, y2]) {
  line.setAttribute("x1", x1);
  line.setAttribute("y1", y1);
  line.setAttribute("x2", x2);
  line.setAttribute("y2", y2);
}
