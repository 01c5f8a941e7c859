// One patient under a code: what is known, visits, progress with its verdicts, treatments.
import { get } from "./api.js";
import { el, fill, say } from "./dom.js";
import { IdentityPanel } from "./identity_panel.js";
import { JointsPanel } from "./joints_panel.js";
import { PatientFacts } from "./patient_facts.js";
import { ProgressPanel } from "./progress_panel.js";
import { treatmentMarks } from "./progress_series.js";
import { RecordPanel } from "./record_panel.js";
import { readBands } from "./reference_bands.js";
import { SharesPanel } from "./shares_panel.js";
import { TreatmentsPanel } from "./treatments_panel.js";
import { VisitsPanel } from "./visits_panel.js";

/** @param {import("./pages.js").Place} place */
export const open = ({ host, params, app }) =>
  new PatientView(host, params.patient, { me: app.me, startSession: (code) => app.startSession(code) });

export class PatientView {
  constructor(host, code, { me, startSession }) {
    this.host = host;
    this.code = code;
    this.me = me;
    const changed = { onChange: () => this.refresh() };
    this.visits = new VisitsPanel(code, changed);
    this.progress = new ProgressPanel();
    this.joints = new JointsPanel();
    this.treatments = new TreatmentsPanel(code, changed);
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.start = el("button", { type: "button", onclick: () => startSession(code) }, "Start a session for this patient");
    this.open(changed);
  }

  async open(changed) {
    try {
      const patient = await get("/patients/{code}", { code: this.code });
      if (this.disposed) return;
      const may = (permission) => this.me.may.includes(permission);
      fill(
        this.host,
        el(
          "div",
          { class: "session-head" },
          el("a", { href: "#/patients" }, "Patients"),
          el("h1", {}, `Patient ${patient.code}`),
          may("names") ? new IdentityPanel(patient.code).node : null,
          el("span", { class: "spring" }),
          this.start,
        ),
        this.problem,
        this.progress.node,
        this.joints.node,
        this.visits.node,
        el("div", { class: "beside" }, new PatientFacts(patient, changed).node, this.treatments.node),
        may("work")
          ? el("div", { class: "beside" }, new SharesPanel(patient.code).node, new RecordPanel(patient.code, this.me).node)
          : null,
      );
      await this.refresh();
    } catch (problem) {
      if (this.disposed) return;
      const advice = el("p", {}, problem.message);
      fill(this.host, el("div", { class: "empty" }, el("h2", {}, "This patient can not be shown"), advice));
    }
  }

  async refresh() {
    try {
      await this.read();
      this.problem.hidden = true;
    } catch (problem) {
      say(this.problem, problem.message);
      this.problem.hidden = false;
    }
  }

  /** Progress first: asking for it freezes a baseline where none was. */
  async read() {
    const progress = await get("/patients/{code}/progress", { code: this.code });
    const [page, treatments, bands] = await Promise.all([
      get("/patients/{code}/visits", { code: this.code, limit: 100 }),
      this.treatments.load(),
      readBands(progress.series),
    ]);
    if (this.disposed) return;
    const marks = treatmentMarks(treatments, page.items);
    this.visits.show(page.items);
    this.treatments.show(marks);
    this.progress.show(progress.series, marks, bands);
    this.joints.show(progress.joint_recovery);
  }

  dispose() {
    this.disposed = true;
    this.progress.dispose();
  }
}
