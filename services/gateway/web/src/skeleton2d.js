// The side view on paper: without WebGL, for print, and for people who asked for less motion.
import { svg } from "./dom.js";
import { kneeFan } from "./figure.js";
import { Ghost2d } from "./ghost2d.js";
import { GHOST, INVALID, PELVIS, SIDE_COLOUR } from "./palette.js";
import { PaperTrunk } from "./paper_trunk.js";
import { Stage } from "./stage.js";
import { degrees, number } from "./units.js";
import { SIDES, plus, times } from "./vectors.js";

/** px per m in standing and in sitting: of a body, of one that lifts its arms in a room, of legs alone. */
const SCALES = { body: [285, 285], room: [205, 205], legs: [330, 300] };
const WIDTH = 380;
const FLOOR = 428;
const FAN_M = 0.17;
const SEAT = { depth: 0.42, width: 0.4, behind: 0.12 };

export class Skeleton2d {
  constructor(host) {
    this.host = host;
    this.stage = new Stage();
    this.view = "side";
    this.scale = SCALES.body[0];
    this.root = svg("svg", {
      viewBox: `0 0 ${WIDTH} 450`,
      role: "img",
      "aria-label": "Stick figure",
      class: "paper",
    });
    this.body = svg("g");
    this.seat = this.add("rect", { fill: GHOST, rx: 4 });
    this.root.append(svg("line", { x1: 30, x2: WIDTH - 30, y1: FLOOR, y2: FLOOR, stroke: GHOST, "stroke-width": 2 }), this.body);
    this.trunk = this.line(GHOST, 10);
    this.legs = Object.fromEntries(SIDES.map((side) => [side, this.leg(side)]));
    this.upper = new PaperTrunk(this.body);
    this.pelvis = this.line(PELVIS, 12);
    this.ghost = new Ghost2d(this.body);
    host.append(this.root);
  }

  add(tag, attributes) {
    const node = svg(tag, { visibility: "hidden", ...attributes });
    this.body.append(node);
    return node;
  }

  leg(side) {
    const colour = SIDE_COLOUR[side];
    const text = { fill: colour, "font-weight": 700 };
    const leg = {
      fan: this.add("path", { fill: colour, "fill-opacity": 0.22, stroke: colour, "stroke-width": 2 }),
      spread: this.add("path", { fill: "none", stroke: colour, opacity: 0.5, "stroke-width": 16 }),
      thigh: this.line(colour, 9, side),
      shank: this.line(colour, 9, side),
      foot: this.line(GHOST, 6),
      letter: this.add("text", { ...text, "font-size": 20 }),
      angle: this.add("text", { ...text, "font-size": 24, "text-anchor": "middle", class: "knee-angle" }),
    };
    leg.letter.append(side === "left" ? "L" : "R");
    return leg;
  }

  line(colour, width, side) {
    const dash = side === "right" ? "26 14" : null;
    return this.add("line", {
      stroke: colour,
      "stroke-width": width,
      "stroke-linecap": dash ? "butt" : "round",
      "stroke-dasharray": dash,
    });
  }

  look(from) {
    this.view = from;
    if (this.last) this.show(this.last, this.angles);
  }

  show(figure, angles = {}, ghost = null) {
    this.last = figure;
    this.body.removeAttribute("display");
    this.angles = angles;
    const now = performance.now() / 1000;
    this.stage.follow(figure, Math.min(0.1, now - (this.drawn ?? now)));
    this.drawn = now;
    const [standing, sitting] = SCALES[figure.inRoom ? "room" : figure.whole ? "body" : "legs"];
    this.scale = standing + (sitting - standing) * this.stage.sitting;
    const at = (name) => (figure.points[name] ? this.project(figure.points[name]) : null);
    draw(this.trunk, at("pelvis_top"), at("neck"));
    const across = figure.inRoom || this.view !== "side";
    const known = figure.inRoom || at("pelvis_top");
    draw(this.pelvis, across ? at("hip_left") : at("pelvis_top"), known && at("hip_right"));
    this.upper.show(figure, at, this.scale);
    for (const side of SIDES) {
      const leg = this.legs[side];
      draw(leg.thigh, at(`hip_${side}`), at(`knee_${side}`));
      draw(leg.shank, at(`knee_${side}`), at(`ankle_${side}`));
      draw(leg.foot, at(`ankle_${side}`), at(`toe_${side}`));
      leg.thigh.setAttribute("stroke", figure.valid[`thigh_${side}`] ? SIDE_COLOUR[side] : INVALID);
      leg.shank.setAttribute("stroke", figure.valid[`shank_${side}`] ? SIDE_COLOUR[side] : INVALID);
      put(leg.letter, at(`ankle_${side}`), [-30, 4]);
      this.showAngle(figure, side, figure.whole ? undefined : angles[side]);
    }
    this.showSeat(figure);
    this.ghost.show(ghost, (point) => this.project(point));
  }

  showAngle(figure, side, angle) {
    const { fan, spread, angle: label } = this.legs[side];
    const shape = angle ? kneeFan(figure, side, angle.std) : null;
    for (const node of [fan, spread, label]) node.setAttribute("visibility", shape ? "visible" : "hidden");
    if (!shape) return;
    const knee = figure.points[`knee_${side}`];
    const along = (directions) =>
      directions.map((direction) =>
        this.project(plus(knee, times(direction, FAN_M)))
          .map((value) => value.toFixed(1))
          .join(" "),
      );
    fan.setAttribute("d", `M ${this.project(knee).join(" ")} L ${along(shape.open).join(" L ")} Z`);
    spread.setAttribute("d", `M ${along(shape.spread).join(" L ")}`);
    label.textContent = `${number(degrees(angle.value), 0)}° ± ${number(degrees(2 * angle.std), 0)}°`;
    put(label, this.project(figure.points[`label_${side}`]), [this.view === "side" ? 18 : 0, 8]);
  }

  showSeat(figure) {
    const height = this.stage.seatHeight(figure);
    this.seat.setAttribute("visibility", height === null ? "hidden" : "visible");
    if (height === null) return;
    const depth = this.view === "side" ? SEAT.depth : SEAT.width;
    const left = this.view === "side" ? -SEAT.behind - this.stage.centre : -depth / 2;
    this.seat.setAttribute("x", WIDTH / 2 + left * this.scale);
    this.seat.setAttribute("y", FLOOR - height * this.scale);
    this.seat.setAttribute("width", depth * this.scale);
    this.seat.setAttribute("height", Math.max(0, height * this.scale));
  }

  project(/** @type {number[]} */ [x, y, z]) {
    const cos = Math.cos(this.stage.heading);
    const sin = Math.sin(this.stage.heading);
    const [fromX, fromZ] = this.stage.standpoint;
    const forward = (x - fromX) * cos - (z - fromZ) * sin - this.stage.centre;
    const right = (x - fromX) * sin + (z - fromZ) * cos;
    const across = { side: forward, front: -right, back: right, mirror: right }[this.view];
    return [WIDTH / 2 + across * this.scale, FLOOR - (y + 0.05 - this.stage.ground) * this.scale];
  }

  /** Nobody is there. */
  clear() {
    this.last = null;
    this.body.setAttribute("display", "none");
  }

  setStale(stale) {
    this.host.classList.toggle("stale", stale);
  }

  dispose() {
    this.root.remove();
  }
}

function draw(line, from, to) {
  line.setAttribute("visibility", from && to ? "visible" : "hidden");
  if (!from || !to) return;
  line.setAttribute("x1", from[0]);
  line.setAttribute("y1", from[1]);
  line.setAttribute("x2", to[0]);
  line.setAttribute("y2", to[1]);
}

function put(text, place, [dx, dy]) {
  text.setAttribute("visibility", place ? "visible" : "hidden");
  if (!place) return;
  text.setAttribute("x", place[0] + dx);
  text.setAttribute("y", place[1] + dy);
}
