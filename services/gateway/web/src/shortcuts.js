// Single keys for what is often pressed. "?" lists them, and there they can be switched off (WCAG 2.1.4).
import { el, svg } from "./dom.js";
import { recall, remember } from "./screen_memory.js";

const NAME = "shortcuts";

/** @typedef {{key: string, does: string, run: () => void}} Shortcut */

export class Shortcuts {
  /** @param {Shortcut[]} shortcuts */
  constructor(shortcuts) {
    this.shortcuts = shortcuts;
    this.on = recall(NAME) !== "off";
    this.box = el("input", { type: "checkbox", checked: this.on, onchange: () => this.turn(this.box.checked) });
    const rows = shortcuts.map(({ key, does }) => el("div", {}, el("dt", {}, el("kbd", {}, key)), el("dd", {}, does)));
    const close = el("button", { type: "button", class: "primary", onclick: () => this.dialog.close() }, "Close");
    this.dialog = el(
      "dialog",
      { class: "shortcuts", "aria-label": "Keyboard shortcuts" },
      el("h2", {}, "Keyboard shortcuts"),
      el("dl", {}, ...rows, el("div", {}, el("dt", {}, el("kbd", {}, "?")), el("dd", {}, "This list"))),
      el("label", { class: "check-row" }, this.box, "Single keys do something on this screen"),
      el("div", { class: "actions" }, close),
    );
    this.button = el(
      "button",
      { type: "button", class: "quiet-button", title: "Keyboard shortcuts", onclick: () => this.dialog.showModal() },
      "?",
    );
    this.button.setAttribute("aria-label", "Keyboard shortcuts");
    this.listen = (/** @type {KeyboardEvent} */ event) => this.pressed(event);
    document.addEventListener("keydown", this.listen);
  }

  /** @param {boolean} on */
  turn(on) {
    this.on = on;
    remember(NAME, on ? "on" : "off");
  }

  /** @param {KeyboardEvent} event */
  pressed(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || event.repeat) return;
    const target = /** @type {HTMLElement} */ (event.target);
    if (target.closest("input, select, textarea, dialog[open]") || document.querySelector("dialog[open]")) return;
    if (event.key === "?") this.dialog.showModal();
    else if (this.on) this.shortcuts.find(({ key }) => key.toLowerCase() === event.key.toLowerCase())?.run();
  }

  dispose() {
    document.removeEventListener("keydown", this.listen);
    this.dialog.remove();
  }
}

/** Fill the screen with an element, or give the screen back. @param {HTMLElement} node */
export function toggleFullScreen(node) {
  if (document.fullscreenElement) document.exitFullscreen();
  else node.requestFullscreen().catch(() => {});
}

/** Four corners, as players have them. @param {() => void} onclick */
export function fullScreenButton(onclick) {
  const corners = svg("path", { d: "M2 6V2h4M12 2h4v4M16 12v4h-4M6 16H2v-4", fill: "none", stroke: "currentColor", "stroke-width": 2 });
  const icon = svg("svg", { viewBox: "0 0 18 18", width: 18, height: 18, "aria-hidden": "true" }, corners);
  const words = { title: "Full screen (F)", "aria-label": "Full screen" };
  return el("button", { type: "button", class: "icon-button full-screen", onclick, ...words }, icon);
}
