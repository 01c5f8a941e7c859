// The angles that matter for a task, both sides beside each other, each with two standard deviations.
import { whyUnseen } from "./angle_words.js";
import { angleName } from "./charts.js";
import { el, say } from "./dom.js";
import { degrees, number } from "./units.js";
import { SIDES } from "./vectors.js";
import { angleTitle } from "./words.js";

export class AnglesPanel {
  /** `angles` have two sides, `middle` none. */
  constructor({ angles, middle }) {
    this.cells = [];
    const rows = [...angles.map((joint) => this.row(joint, SIDES)), ...middle.map((joint) => this.row(joint, [null]))];
    const heads = SIDES.map((side) =>
      el("th", { scope: "col", class: `number ${side}` }, side === "left" ? "Left" : "Right"),
    );
    this.node = el(
      "section",
      { class: "panel angles", "aria-label": "Angles" },
      el(
        "table",
        {},
        el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Angles", el("span", { class: "unit" }, " ± 2 SD")), heads)),
        el("tbody", {}, ...rows),
      ),
    );
  }

  row(joint, sides) {
    const cells = sides.map((side) => {
      const [value, spread] = [el("b", {}, "–"), el("span", { class: "quiet" })];
      const cell = el("td", { class: "number", colspan: side === null ? 2 : 1 }, value, spread);
      this.cells.push({ cell, value, spread, joint, name: angleName(joint, side) });
      return cell;
    });
    return el("tr", {}, el("th", { scope: "row" }, angleTitle(joint)), ...cells);
  }

  add(pose) {
    const estimating = pose.phase === "estimating";
    for (const { cell, value, spread, joint, name } of this.cells) {
      const angle = degrees(pose.angles[name]);
      const known = angle !== null;
      say(value, known ? `${number(angle, 0)}°` : estimating ? "" : "–");
      const width = number(degrees(2 * (pose.angles_std[name] ?? 0)), 0);
      say(spread, known ? ` ± ${width}°` : estimating ? "not observable" : "");
      cell.classList.toggle("unseen-angle", !known && estimating);
      cell.title = known || !estimating ? "" : whyUnseen(joint);
    }
  }

  tick(stale) {
    for (const { cell } of this.cells) cell.classList.toggle("stale", stale);
  }
}
