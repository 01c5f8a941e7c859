// What the person is asked to do, how it is done, and what it needs.
import { ConditionsForm } from "../conditions_form.js";
import { el, fill } from "../dom.js";
import { isInOrder } from "./complaints.js";
import { OFFERED, measuredBy, protocolOf } from "./protocols.js";

export class ProtocolStep {
  title = "What will be done?";

  constructor() {
    this.task = "";
    this.form = new ConditionsForm();
    this.about = el("div", { class: "about", role: "status" });
    const list = OFFERED.map((task) => this.row(task));
    this.node = el(
      "div",
      { class: "step-body beside-list" },
      el("fieldset", { class: "protocols" }, el("legend", { class: "unseen" }, "Protocol"), ...list),
      el("div", { class: "step-part" }, this.about, this.form.node, this.form.worn),
    );
    this.show();
  }

  /** @param {string} task */
  row(task) {
    const choose = () => {
      this.task = task;
      this.show();
    };
    const input = el("input", { type: "radio", name: "task", value: task, checked: task === this.task, onchange: choose });
    return el("label", {}, input, protocolOf(task).name);
  }

  show() {
    const { name, how, needs } = protocolOf(this.task);
    fill(
      this.about,
      el("h3", {}, name),
      el("p", {}, how),
      el(
        "dl",
        {},
        el("dt", {}, "Needed"),
        el("dd", {}, needs),
        el("dt", {}, "Can be measured by"),
        ...measuredBy(this.task).map((words) => el("dd", {}, words)),
      ),
    );
    this.form.fit(this.task);
  }

  enter() {}

  /** Whether one may go on. */
  async finish() {
    this.form.compare();
    return isInOrder(this.node);
  }

  get summary() {
    return protocolOf(this.task).name;
  }

  /** Part of the wish for a session. */
  get wish() {
    return { task: this.task || null, walkway_m: this.form.walkway_m, conditions: this.form.conditions };
  }

  dispose() {}
}
