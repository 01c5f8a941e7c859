// One of a few, chosen by mouse or arrow keys and remembered on this screen.
import { el } from "./dom.js";
import { recall, remember } from "./screen_memory.js";

/** A row of choices: `options` by value, `onChoose` with the value; `chosen` is what was chosen last time. */
export class Choices {
  constructor({ name, label, options, onChoose }) {
    this.name = name;
    const values = Object.keys(options);
    const kept = recall(name);
    this.chosen = values.includes(kept) ? kept : values[0];
    this.texts = {};
    this.legend = el("legend", { class: "unseen" }, label);
    const inputs = values.map((value) => {
      const input = el("input", {
        type: "radio",
        name,
        value,
        checked: value === this.chosen,
        onchange: () => {
          this.chosen = value;
          remember(name, value);
          onChoose(value);
        },
      });
      this.texts[value] = el("span", {}, options[value]);
      return el("label", {}, input, this.texts[value]);
    });
    this.node = el("fieldset", { class: "choices" }, this.legend, ...inputs);
  }

  /** The same choices in other words. */
  reword(label, options) {
    this.legend.textContent = label;
    for (const [value, text] of Object.entries(options)) this.texts[value].textContent = text;
  }
}
