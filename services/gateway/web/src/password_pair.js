// @ts-check
// A new password, typed twice.
import { labelled, passwordInput } from "./form_fields.js";

const SHORTEST = 12;

export class PasswordPair {
  /** @param {string} label */
  constructor(label) {
    this.first = passwordInput("new-password");
    this.second = passwordInput("new-password");
    this.first.minLength = SHORTEST;
    const hint = `At least ${SHORTEST} letters. Four words that do not belong together are easy to remember.`;
    this.nodes = [labelled(label, this.first, hint), labelled(`${label}, once more`, this.second)];
    for (const input of [this.first, this.second]) input.addEventListener("input", () => this.compare());
  }

  get value() {
    return this.first.value;
  }

  compare() {
    const same = this.first.value === this.second.value;
    this.second.setCustomValidity(same ? "" : "The two are not the same.");
  }
}
