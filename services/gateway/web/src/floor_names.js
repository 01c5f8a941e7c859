// Names beside codes, from the clinic's own directory: only for who may see them, only once asked for, and only until
// this page is left. A screen that others can see shows codes.
import { namesOf } from "./directory.js";
import { el, say } from "./dom.js";

export class FloorNames {
  /** @param {{may: string[], onChange: () => void}} options */
  constructor({ may, onChange }) {
    this.onChange = onChange;
    this.shown = false;
    /** @type {Map<string, string|null>} */
    this.names = new Map();
    this.button = el(
      "button",
      { type: "button", class: "names-toggle", "aria-pressed": "false", onclick: () => this.toggle() },
      "Show names",
    );
    this.button.hidden = !may.includes("names");
  }

  toggle() {
    this.shown = !this.shown;
    if (!this.shown) this.names.clear();
    this.button.setAttribute("aria-pressed", String(this.shown));
    say(this.button, this.shown ? "Hide names" : "Show names");
    this.onChange();
  }

  /** The name of a code while names are shown; undefined for none. @param {string|null} code */
  of(code) {
    return (this.shown && code !== null && this.names.get(code)) || undefined;
  }

  /** Ask for those that are not known yet. @param {(string|null)[]} codes */
  async need(codes) {
    const unknown = codes.filter((code) => code !== null).filter((code) => !this.names.has(code));
    if (!this.shown || unknown.length === 0) return;
    for (const code of unknown) this.names.set(code, null);
    const found = await namesOf(unknown).catch(() => []);
    if (!this.shown) return;
    for (const { code, name } of found) this.names.set(code, name);
    this.onChange();
  }
}
