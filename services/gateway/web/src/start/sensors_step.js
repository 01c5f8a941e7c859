// What measures the person: a device that is on, a recording or a simulated person, and where the sensors sit.
import { get } from "../api.js";
import { field } from "../conditions_form.js";
import { el, fill, say } from "../dom.js";
import { TASKS } from "../words.js";
import { complain, isInOrder } from "./complaints.js";
import { placementPicture } from "./placement_picture.js";
import { WORN, canTell, estimatorsFor, protocolOf } from "./protocols.js";

const SPEEDS = [
  ["1", "Real time"],
  ["2", "Twice as fast"],
  ["5", "Five times as fast"],
  ["max", "As fast as possible"],
];
const PATHS = [
  ["", "As the source says (turns allowed)"],
  ["turning", "Free, with turns"],
  ["straight", "Straight: treadmill, in place, corridor"],
];
const KINDS = { device: "In the room now", recording: "Recorded", synthetic: "Simulated people" };
const SILENT = "No ingest service answers just now. Start the services with “ambula up”, then look again.";

/** @typedef {{id: string, title: string, kind: "device"|"recording"|"synthetic", worn: string|null, task: string|null}} Source */

export class SensorsStep {
  title = "What measures?";

  /** @param {() => string} task what was chosen before */
  constructor(task) {
    this.task = task;
    /** @type {{ready: boolean, sources: Source[], estimators: {name: string, meaning: string, worn: string}[]}|null} */
    this.offer = null;
    this.source = el("select", { id: "source", required: true, onchange: () => this.fit() });
    this.speed = el("select", { id: "speed" }, ...SPEEDS.map(([value, name]) => el("option", { value }, name)));
    this.estimator = el("select", { id: "estimator", onchange: () => this.tellEstimator() });
    this.path = el("select", { id: "walk-path" }, ...PATHS.map(([value, name]) => el("option", { value }, name)));
    this.speedField = field("Speed", this.speed);
    this.pathField = field("Path", this.path);
    this.about = el("p", { class: "quiet", role: "status" });
    this.meaning = el("p", { class: "quiet" });
    this.picture = el("div", { class: "step-part" });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    const again = el("button", { type: "button", class: "quiet-button", onclick: () => this.enter() }, "Look again");
    this.node = el(
      "div",
      { class: "step-body two" },
      el(
        "div",
        { class: "step-part" },
        this.problem,
        field("Source", this.source),
        el("p", { class: "row" }, this.about, el("span", { class: "spring" }), again),
        this.speedField,
        el(
          "details",
          { class: "fold" },
          el("summary", {}, "Advanced: estimator, path"),
          el("div", { class: "fields" }, field("Estimator", this.estimator), this.pathField),
          this.meaning,
        ),
      ),
      this.picture,
    );
  }

  /** The step is shown: what is there may have changed. */
  async enter() {
    try {
      this.offer = await get("/sources");
      this.trouble(this.offer.ready ? "" : SILENT);
    } catch (problem) {
      this.trouble(problem.message);
      return;
    }
    this.list();
    this.fit();
  }

  /** @param {string} text */
  trouble(text) {
    say(this.problem, text);
    this.problem.hidden = text === "";
  }

  list() {
    const fitting = this.offer.sources.filter((source) => canTell(source, this.task()));
    const groups = Object.entries(KINDS).map(([kind, label]) => {
      const some = fitting.filter((source) => source.kind === kind).map((source) => el("option", { value: source.id }, source.title));
      return some.length > 0 ? el("optgroup", { label }, ...some) : null;
    });
    const own = fitting.find(({ task, kind }) => kind === "device" || (this.task() && task === this.task()));
    const first = own ?? fitting.find(({ kind }) => kind === "synthetic") ?? fitting[0];
    offerOptions(this.source, groups.filter(Boolean), first?.id);
  }

  /** @returns {Source|undefined} */
  get chosen() {
    return this.offer?.sources.find(({ id }) => id === this.source.value);
  }

  /** Estimators for what measures, a path for sensors, and no speed for what is there now. */
  fit() {
    const source = this.chosen;
    const groups = estimatorsFor(source?.worn).map((group) => this.estimatorGroup(group));
    offerOptions(this.estimator, [el("option", { value: "" }, "The one that fits the source"), ...groups]);
    this.pathField.hidden = source?.worn === "camera";
    this.speedField.hidden = source?.kind === "device";
    say(this.about, source ? aboutSource(source, this.task()) : "Nothing here can tell of this protocol. Switch a device on, then look again.");
    fill(this.picture, el("h3", {}, "Where it sits"), placementPicture(source?.worn ?? null));
    complain(this.source, "");
    this.tellEstimator();
  }

  tellEstimator() {
    const meaning = this.offer?.estimators.find(({ name }) => name === this.estimator.value)?.meaning;
    say(this.meaning, meaning ? `${meaning}.` : "");
  }

  /** @param {string} group */
  estimatorGroup(group) {
    const fitting = (this.offer?.estimators ?? []).filter((each) => each.worn === group);
    return el("optgroup", { label: WORN[group] }, ...fitting.map(({ name }) => el("option", { value: name }, name)));
  }

  /** Whether one may go on. */
  async finish() {
    return isInOrder(this.node);
  }

  get summary() {
    return this.chosen?.title ?? "";
  }

  /** Part of the wish for a session. */
  get wish() {
    return {
      source: this.source.value,
      speed: this.speedField.hidden ? 1 : this.speed.value === "max" ? null : Number(this.speed.value),
      estimator: this.estimator.value || null,
      walk_path: this.pathField.hidden ? null : this.path.value || null,
    };
  }

  dispose() {}
}

/** @param {Source} source @param {string} task */
function aboutSource({ worn, task: own, kind }, task) {
  const words = [worn ? `${WORN[worn]}.` : "What is worn is known once it sends."];
  if (own && task && own !== task)
    words.push(`It shows ${TASKS[own].toLowerCase()}; it will be looked at as ${protocolOf(task).name.toLowerCase()}.`);
  else if (own && !task) words.push(`Task: ${TASKS[own]}.`);
  if (kind === "device") words.push("It is on and sends now.");
  return words.join(" ");
}

/** New options; what was chosen stays chosen where it still is one. @param {HTMLSelectElement} select */
function offerOptions(select, options, otherwise = "") {
  const chosen = select.value;
  fill(select, ...options);
  const values = [...select.options].map((option) => option.value);
  select.value = values.includes(chosen) && chosen !== "" ? chosen : otherwise;
}
