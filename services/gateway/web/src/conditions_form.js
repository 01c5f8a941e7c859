// How a test is done: what it is measured by depends on the task, what the person wears and holds does not.
import { AIDS, ASSISTANCE, FOOTWEAR, ORTHOSES, PACES, STARTS } from "./condition_words.js";
import { el } from "./dom.js";

const UNSAID = "";
const MINUTES = { 2: "2 minutes", 6: "6 minutes", 12: "12 minutes" };

/** What the length of a walkway means, and what is usual. */
const WALKWAYS = {
  timed_up_and_go: { name: "Walkway, m from the chair to the turn", placeholder: "as the source says, else 3 m" },
  six_minute_walk: { name: "Corridor, m from turn to turn", placeholder: "as the source says, else 30 m" },
  ten_metre_walk: { name: "Walkway, m from start to end", placeholder: "as the source says, else 10 m" },
};
const OF_TASK = {
  walk: ["speed_instruction"],
  ten_metre_walk: ["timed_from_m", "timed_to_m", "start", "speed_instruction"],
  six_minute_walk: ["test_duration_s"],
};

/** The fields that say how a test is done: `node` for the task's own, `worn` for the fold-out. */
export class ConditionsForm {
  constructor() {
    this.walkway = metres("walkway", 0.5);
    this.walkwayName = el("span");
    this.walkwayField = el("label", { class: "field", for: "walkway" }, this.walkwayName, this.walkway);
    this.inputs = {
      aid: choice("aid", AIDS),
      orthosis: choice("orthosis", ORTHOSES),
      footwear: choice("footwear", FOOTWEAR),
      physical_assistance: choice("assistance", ASSISTANCE),
      timed_from_m: metres("timed-from", 0, "2 m"),
      timed_to_m: metres("timed-to", 0.5, "8 m"),
      start: choice("test-start", STARTS),
      speed_instruction: choice("pace", PACES),
      test_duration_s: choice("test-duration", MINUTES),
    };
    const { aid, orthosis, footwear, physical_assistance, ...own } = this.inputs;
    const names = {
      timed_from_m: "Timed from, m",
      timed_to_m: "Timed to, m",
      start: "Start",
      speed_instruction: "Pace asked for",
      test_duration_s: "Duration",
    };
    this.own = Object.fromEntries(Object.entries(own).map(([name, input]) => [name, field(names[name], input)]));
    this.node = el("div", { class: "fields" }, this.walkwayField, ...Object.values(this.own));
    this.worn = el(
      "details",
      { class: "fold" },
      el("summary", {}, "Aid, orthosis, footwear, assistance"),
      el("p", { class: "quiet" }, "Visits are compared only where these agree. Leave open what nobody knows."),
      el(
        "div",
        { class: "fields" },
        field("Walking aid", aid),
        field("Orthosis", orthosis),
        field("Footwear", footwear),
        field("Assistance", physical_assistance),
      ),
    );
  }

  /** Show what belongs to the task. */
  fit(task) {
    const walkway = WALKWAYS[task];
    this.walkwayField.hidden = !walkway;
    this.walkwayName.textContent = walkway?.name ?? "";
    this.walkway.placeholder = walkway?.placeholder ?? "";
    for (const [name, node] of Object.entries(this.own)) node.hidden = !(OF_TASK[task] ?? []).includes(name);
    this.node.hidden = !walkway && !(task in OF_TASK);
  }

  /** Say beside the field when the timed part ends before it begins. */
  compare() {
    const { timed_from_m: from, timed_to_m: to } = this.inputs;
    const wrong = from.value !== UNSAID && to.value !== UNSAID && Number(to.value) <= Number(from.value);
    to.setCustomValidity(wrong ? "The timed part ends after it begins: give a larger distance." : "");
  }

  /** m, or null for what the source says. */
  get walkway_m() {
    return this.walkwayField.hidden ? null : numberOf(this.walkway);
  }

  /** What was said, or null if nothing was. */
  get conditions() {
    const said = Object.entries(this.inputs).filter(
      ([name, input]) => input.value !== UNSAID && !(this.own[name]?.hidden ?? false),
    );
    return said.length === 0 ? null : Object.fromEntries(said.map(([name, input]) => [name, valueOf(name, input)]));
  }
}

/** The value as the API takes it. */
export function valueOf(name, input) {
  if (name === "physical_assistance") return input.value === "true";
  if (name === "test_duration_s") return 60 * Number(input.value);
  return name.endsWith("_m") ? Number(input.value) : input.value;
}

const numberOf = (input) => (input.value === UNSAID ? null : Number(input.value));

function choice(id, options) {
  const all = Object.entries(options).map(([value, name]) => el("option", { value }, name));
  return el("select", { id }, el("option", { value: UNSAID }, "not said"), ...all);
}

const metres = (id, min, placeholder = "") => el("input", { id, type: "number", min, max: 100, step: 0.1, placeholder });

export const field = (name, input) => el("label", { class: "field", for: input.id }, el("span", {}, name), input);
