// A session's page: live while it runs, what became of it afterwards.
import { get } from "./api.js";
import { el, fill } from "./dom.js";

const ASK_AGAIN_MS = 500;

/** @param {import("./pages.js").Place} place */
export const open = ({ host, params }) => new SessionView(host, params.session, params.part);

export class SessionView {
  constructor(host, id, part) {
    this.host = host;
    this.id = id;
    this.part = part;
    this.load();
  }

  async load() {
    clearTimeout(this.timer);
    try {
      const session = await get("/sessions/{session}", { session: this.id });
      if (!this.disposed) await this.show(session);
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

  async show(session) {
    const running = session.state === "live" || session.state === "created";
    const { LiveView, EndedView } = running
      ? await import("./live_view.js")
      : /** @type {any} */ (await import("./ended/ended_view.js"));
    if (this.disposed) return;
    this.view?.dispose();
    this.view = running
      ? new LiveView(this.host, session, { onEnd: () => this.again() })
      : new EndedView(this.host, session, this.part);
  }

  /** The newest list of all that run. */
  onFloor(status) {
    this.view?.onFloor?.(status);
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
