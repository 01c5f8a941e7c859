// Start a session: what, how fast, by which estimator, for whom.
import { get, post } from "./api.js";
import { el, fill } from "./dom.js";

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
const KINDS = { recording: "Recorded walks", synthetic: "Simulated walkers" };

export class StartDialog {
  constructor({ onStarted }) {
    this.onStarted = onStarted;
    this.source = el("select", { id: "source", required: true });
    this.speed = el("select", { id: "speed" }, ...SPEEDS.map(([value, name]) => el("option", { value }, name)));
    this.estimator = el("select", { id: "estimator" });
    this.path = el("select", { id: "walk-path" }, ...PATHS.map(([value, name]) => el("option", { value }, name)));
    this.patient = el("select", { id: "patient" });
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.go = el("button", { class: "primary", type: "submit" }, "Start");
    const form = el(
      "form",
      { method: "dialog", onsubmit: (event) => this.submit(event) },
      el("h2", {}, "Start a session"),
      field("Source", this.source),
      field("Speed", this.speed),
      field("Estimator", this.estimator),
      field("Path", this.path),
      field("Patient", this.patient),
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

  async open() {
    this.complain("");
    this.node.showModal();
    try {
      const [offer, patients] = await Promise.all([get("/sources"), get("/patients?limit=100")]);
      this.offer(offer, patients.items);
      if (!offer.ready)
        this.complain("No ingest service answers just now. Start the services with “ambula up”, then try again.");
    } catch (problem) {
      this.complain(problem.message);
    }
  }

  offer({ sources, estimators }, patients) {
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
    fill(
      this.estimator,
      ...estimators.map((each) =>
        el("option", { value: each.name }, each.default ? `${each.name} (default)` : each.name),
      ),
    );
    fill(
      this.patient,
      el("option", { value: "" }, "assign later"),
      ...patients.map((patient) => el("option", { value: patient.code }, patient.code)),
    );
  }

  async submit(event) {
    event.preventDefault();
    this.complain("");
    this.go.disabled = true;
    try {
      const session = await post("/sessions", {
        source: this.source.value,
        speed: this.speed.value === "max" ? null : Number(this.speed.value),
        estimator: this.estimator.value || null,
        walk_path: this.path.value || null,
        patient: this.patient.value || null,
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

const field = (name, input) => el("label", { class: "field", for: input.id }, el("span", {}, name), input);
