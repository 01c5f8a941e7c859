// Whose session this is: chosen from the codes, or a new one.
import { get, patch, post } from "./api.js";
import { el, fill } from "./dom.js";

const NEW = "+";

export class PatientLink {
  constructor(session) {
    this.session = session;
    this.select = el("select", { "aria-label": "Patient", onchange: () => this.choose(), onfocus: () => this.load() });
    this.node = el("label", { class: "patient-link" }, "Patient", this.select);
    this.codes = [];
    this.show(session.patient);
    this.load();
  }

  async load() {
    const page = await get("/patients", { limit: 100 }).catch(() => null);
    if (!page) return;
    const codes = page.items.map((patient) => patient.code);
    if (codes.join() === this.codes.join()) return;
    this.codes = codes;
    this.show(this.current);
  }

  show(code) {
    this.current = code;
    const codes = code && !this.codes.includes(code) ? [code, ...this.codes] : this.codes;
    fill(
      this.select,
      el("option", { value: "" }, "unassigned"),
      ...codes.map((each) => el("option", { value: each }, each)),
      el("option", { value: NEW }, "New patient"),
    );
    this.select.value = code ?? "";
  }

  async choose() {
    let code = this.select.value || null;
    try {
      if (code === NEW) code = (await post("/patients", { body: {} })).code;
      await patch("/sessions/{session}", { session: this.session.id, body: { patient: code } });
      this.show(code);
    } catch (problem) {
      this.show(this.current);
      this.select.setCustomValidity(problem.message);
      this.select.reportValidity();
      this.select.setCustomValidity("");
    }
  }
}
