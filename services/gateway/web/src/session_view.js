// A session's page: live while it runs, its report afterwards.
import { get } from "./api.js";
import { el, fill } from "./dom.js";
import { LiveView } from "./live_view.js";
import { ReportView } from "./report_view.js";

const ASK_AGAIN_MS = 500;

/** @param {import("./pages.js").Place} place */
export const open = ({ host, params }) => new SessionView(host, params.session);

export class SessionView {
  constructor(host, id) {
    this.host = host;
    this.id = id;
    this.load();
  }

  async load() {
    clearTimeout(this.timer);
    try {
      const session = await get("/sessions/{session}", { session: this.id });
      if (!this.disposed) this.show(session);
    } catch (problem) {
      if (this.disposed) return;
      if (!this.view)
        fill(
          this.host,
          el("div", { class: "empty" }, el("h2", {}, "This session can not be shown"), el("p", {}, problem.message)),
        );
      if (problem.status !== 404) this.again();
    }
  }

  show(session) {
    this.view?.dispose();
    const running = session.state === "live" || session.state === "created";
    this.view = running
      ? new LiveView(this.host, session, { onEnd: () => this.again() })
      : new ReportView(this.host, session);
  }

  // When the line says that nothing more comes, the database knows a moment later what became of the session.
  again() {
    this.timer = setTimeout(() => this.load(), ASK_AGAIN_MS);
  }

  dispose() {
    this.disposed = true;
    clearTimeout(this.timer);
    this.view?.dispose();
  }
}
