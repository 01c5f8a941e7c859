// Start a session: what, how fast, by which estimator, for whom.
import { get, post } from "./api.js";
import { ConditionsForm, field } from "./conditions_form.js";
import { el, fill } from "./dom.js";
import { TASKS } from "./words.js";

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
const KINDS = { device: "Live camera", recording: "Recorded", synthetic: "Simulated" };
const WORN = {
  lower_body: "Sensors: pelvis and both legs",
  knee: "Sensors: single knee",
  camera: "Camera: whole body",
  camera_and_sensors: "Camera and sensors together",
};
/** With both, one may also be left aside. */
const FITTING = { camera_and_sensors: ["camera_and_sensors", "camera", "lower_body"] };
const SEEN_BY_CAMERA = ["walk", "squat", "stepping", "trunk_tilt_sagittal", "trunk_tilt_frontal"];
const POSSIBLE = {
  lower_body: ["walk", "six_minute_walk", "ten_metre_walk", "timed_up_and_go", "marching"],
  knee: ["walk", "timed_up_and_go", "knee_flexion"],
  camera: SEEN_BY_CAMERA,
  camera_and_sensors: SEEN_BY_CAMERA,
};
const asTheSourceSays = () => el("option", { value: "" }, "As the source says");

export class StartDialog {
  constructor({ onStarted }) {
    this.onStarted = onStarted;
    this.source = el("select", { id: "source", required: true, onchange: () => this.fit() });
    this.task = el("select", { id: "task", onchange: () => this.fit() });
    this.how = new ConditionsForm();
    this.speed = el("select", { id: "speed" }, ...SPEEDS.map(([value, name]) => el("option", { value }, name)));
    this.estimator = el("select", { id: "estimator" });
    this.path = el("select", { id: "walk-path" }, ...PATHS.map(([value, name]) => el("option", { value }, name)));
    this.speedField = field("Speed", this.speed);
    this.pathField = field("Path", this.path);
    this.patient = el("select", { id: "patient", onchange: () => this.tellSide() });
    this.side = el("p", { class: "quiet", role: "status", hidden: true });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.go = el("button", { class: "primary", type: "submit" }, "Start");
    const form = el(
      "form",
      { method: "dialog", onsubmit: (event) => this.submit(event) },
      el("h2", {}, "Start a session"),
      field("Source", this.source),
      field("Task", this.task),
      this.how.node,
      field("Patient", this.patient),
      this.side,
      this.how.worn,
      this.speedField,
      field("Estimator", this.estimator),
      this.pathField,
      this.problem,
      el(
        "div",
        { class: "actions" },
        el("button", { type: "button", onclick: () => this.node.close() }, "Cancel"),
        this.go,
      ),
    );
    this.node = el("dialog", { "aria-label": "Start a session" }, form);
    document.body.append(this.node);
  }

  /** @param {string} [patient] code that is chosen beforehand */
  async open(patient) {
    this.complain("");
    this.node.showModal();
    try {
      const [offer, patients] = await Promise.all([get("/sources"), get("/patients", { limit: 100 })]);
      this.offer(offer, patients.items, patient);
      if (!offer.ready)
        this.complain("No ingest service answers just now. Start the services with “ambula up”, then try again.");
    } catch (problem) {
      this.complain(problem.message);
    }
  }

  offer({ sources, estimators }, listed, chosen) {
    const groups = Object.entries(KINDS).map(([kind, label]) => [
      label,
      sources.filter((source) => source.kind === kind),
    ]);
    fill(
      this.source,
      ...groups
        .filter(([, some]) => some.length > 0)
        .map(([label, some]) =>
          el("optgroup", { label }, ...some.map((source) => el("option", { value: source.id }, source.title))),
        ),
    );
    this.sources = new Map(sources.map((source) => [source.id, source]));
    this.estimators = estimators;
    const patients =
      chosen && !listed.some(({ code }) => code === chosen) ? [{ code: chosen, paretic_side: null }, ...listed] : listed;
    this.paretic = new Map(patients.map((patient) => [patient.code, patient.paretic_side]));
    fill(
      this.patient,
      el("option", { value: "" }, "assign later"),
      ...patients.map((patient) => el("option", { value: patient.code }, patient.code)),
    );
    this.patient.value = chosen ?? "";
    this.fit();
    this.tellSide();
  }

  /** The more affected side is the patient's, not the test's. */
  tellSide() {
    const side = this.paretic.get(this.patient.value);
    this.side.textContent = side ? `Paretic side, from the patient's record: ${side}.` : "";
    this.side.hidden = !side;
  }

  /** Offer what fits the source: tasks and estimators for what measures, where that is known; what a test needs to be
   * told, a path for sensors, and no speed for what is there now. */
  fit() {
    const source = this.sources?.get(this.source.value);
    const worn = source?.worn ?? null;
    const groups = worn === null ? Object.keys(WORN) : (FITTING[worn] ?? [worn]);
    offerOptions(this.estimator, [asTheSourceSays(), ...groups.map((group) => this.estimatorGroup(group))]);
    const tasks = Object.entries(TASKS).filter(([task]) => worn === null || POSSIBLE[worn].includes(task));
    offerOptions(this.task, [asTheSourceSays(), ...tasks.map(([task, name]) => el("option", { value: task }, name))]);
    this.how.fit(this.task.value || source?.task);
    this.pathField.hidden = worn === "camera";
    this.speedField.hidden = source?.kind === "device";
  }

  estimatorGroup(group) {
    const fitting = (this.estimators ?? []).filter((each) => each.worn === group);
    const options = fitting.map((each) => el("option", { value: each.name, title: each.meaning }, each.name));
    return el("optgroup", { label: WORN[group] }, ...options);
  }

  async submit(event) {
    event.preventDefault();
    this.complain("");
    this.go.disabled = true;
    try {
      const session = await post("/sessions", {
        body: {
          source: this.source.value,
          speed: this.speedField.hidden ? 1 : this.speed.value === "max" ? null : Number(this.speed.value),
          estimator: this.estimator.value || null,
          walk_path: this.pathField.hidden ? null : this.path.value || null,
          task: this.task.value || null,
          walkway_m: this.how.walkway_m,
          conditions: this.how.conditions,
          patient: this.patient.value || null,
        },
      });
      this.node.close();
      this.onStarted(session);
    } catch (problem) {
      this.complain(problem.message);
    } finally {
      this.go.disabled = false;
    }
  }

  complain(text) {
    this.problem.textContent = text;
    this.problem.hidden = text === "";
  }
}

/** New options; what was chosen stays chosen where it still is one. */
function offerOptions(select, options) {
  const chosen = select.value;
  fill(select, ...options);
  if ([...select.options].some((option) => option.value === chosen)) select.value = chosen;
}
