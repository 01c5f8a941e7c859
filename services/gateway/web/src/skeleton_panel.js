// The picture of the body: where it is looked at from, what its colours mean, and a ghost of another stride.
import { el, fill } from "./dom.js";
import { figureOf } from "./figure.js";
import { Skeleton2d } from "./skeleton2d.js";
import { Skeleton3d, canDraw3d } from "./skeleton3d.js";
import { recall, remember } from "./screen_memory.js";
import { GHOSTS, StrideMemory } from "./stride_memory.js";
import { SIDES } from "./vectors.js";

const GHOST_NAME = "ghost";

export class SkeletonPanel {
  /** @param {string|null|undefined} paretic side; its strides are the ghost's unless another is chosen */
  constructor(paretic) {
    this.memory = new StrideMemory();
    this.views = el("div", { class: "views", role: "group", "aria-label": "View from" });
    this.stage = el("div", { class: "stage" });
    this.key = el("p", { class: "key" });
    this.ghostKey = el("span", { class: "ghost-key" }, "violet: ghost");
    this.buildGhost(paretic ?? "left");
    this.node = el("section", { class: "panel body-panel", "aria-label": "Skeleton" }, this.views, this.stage, this.key);
    this.showKey(SIDES);
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.skeleton = calm || !canDraw3d() ? new Skeleton2d(this.stage) : new Skeleton3d(this.stage);
  }

  /** @param {string} side */
  buildGhost(side) {
    const options = Object.entries(GHOSTS).map(([value, { word, meaning }]) => el("option", { value, title: meaning }, word));
    this.ghostKind = el("select", { "aria-label": "Ghost", onchange: () => this.chooseGhost(this.ghostKind.value) }, ...options);
    this.ghostSide = el(
      "select",
      { "aria-label": "Strides of" },
      ...SIDES.map((each) => el("option", { value: each }, each === "left" ? "L" : "R")),
    );
    this.ghostSide.value = side;
    this.ghost = el("span", { class: "ghost-choice", hidden: true }, this.ghostKind, this.ghostSide);
    this.chooseGhost(recall(GHOST_NAME) ?? "off");
  }

  /** @param {string} kind */
  chooseGhost(kind) {
    this.ghostKind.value = kind in GHOSTS ? kind : "off";
    this.ghostKind.title = GHOSTS[this.ghostKind.value].meaning;
    this.ghostSide.hidden = this.ghostKey.hidden = this.ghostKind.value === "off";
    remember(GHOST_NAME, this.ghostKind.value);
  }

  /** The next kind of ghost, if there can be one. */
  nextGhost() {
    if (this.ghost.hidden) return;
    const kinds = Object.keys(GHOSTS);
    this.chooseGhost(kinds[(kinds.indexOf(this.ghostKind.value) + 1) % kinds.length]);
  }

  /** What can be seen of the person: `views` with the first one first, `sides` with a leg. */
  arrange({ views, sides, counted, wholeBody }) {
    const buttons = Object.entries(views).map(([view, name]) =>
      el("button", { type: "button", onclick: (event) => this.look(view, event.currentTarget) }, name),
    );
    fill(this.views, ...buttons, el("span", { class: "spring" }), this.ghost);
    this.look(Object.keys(views)[0], buttons[0]);
    this.ghost.hidden = counted || wholeBody !== null;
    if (!sides.includes(this.ghostSide.value)) this.ghostSide.value = sides[0];
    for (const option of this.ghostSide.options) option.disabled = !sides.includes(option.value);
    this.showKey(sides);
  }

  look(view, button) {
    for (const other of this.views.querySelectorAll("button")) other.setAttribute("aria-pressed", String(other === button));
    this.skeleton.look(view);
  }

  /** The view at that place, counted from 0, if there is one. */
  lookNth(place) {
    this.views.querySelectorAll("button")[place]?.click();
  }

  showKey(sides) {
    const names = sides.map((side) => el("b", { class: side }, side === "left" ? "L left" : "R right"));
    const said = ["grey: not known now", "pale: not measured"].map((words) => el("span", {}, words));
    fill(this.key, ...names, ...said, this.ghost.hidden ? null : this.ghostKey);
  }

  /** `body` has lengths and the height of the floor; nothing is drawn before it is known. */
  show(pose, body, mayBeEmpty) {
    const figure = body && figureOf(pose, body);
    if (!figure) {
      if (mayBeEmpty) this.skeleton.clear();
      return;
    }
    const hasGhost = !this.ghost.hidden && !figure.inRoom;
    if (hasGhost) this.memory.add(pose.at_s, figure, pose.angles);
    const ghost = hasGhost
      ? this.memory.ghost(this.ghostKind.value, this.ghostSide.value, pose.at_s, figure.heading)
      : null;
    this.skeleton.show(figure, kneeAngles(pose), ghost);
  }

  onStride(stride) {
    this.memory.onStride(stride);
  }

  tick(stale) {
    this.skeleton.setStale(stale);
  }

  dispose() {
    this.skeleton.dispose();
    this.memory.clear();
  }
}

/** Angle of each knee that is known, with one standard deviation; rad. */
function kneeAngles(pose) {
  const known = SIDES.filter((side) => pose.angles[`knee_flexion_${side}`] !== undefined);
  return Object.fromEntries(
    known.map((side) => {
      const name = `knee_flexion_${side}`;
      return [side, { value: pose.angles[name], std: pose.angles_std[name] ?? 0 }];
    }),
  );
}
