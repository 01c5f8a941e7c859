// @ts-check
// A session that is over: its report, its replay, its strides, its numbers, its files, and what versions made of it.
import { get, linkTo } from "../api.js";
import { isExercise } from "../arrangement.js";
import { el, fill } from "../dom.js";
import { addressOf } from "../pages.js";
import { sessionHead } from "./session_head.js";

/** @typedef {{ dispose?: () => void }} Part */
/** @typedef {(host: HTMLElement, session: any, query: URLSearchParams) => Promise<Part>} Opening */

/** @type {Record<string, { name: string, open: Opening }>} */
const PARTS = {
  report: {
    name: "Report",
    open: async (host, session) => new (await import("../report_view.js")).ReportView(host, session),
  },
  replay: {
    name: "Replay",
    open: async (host, session, query) => new (await import("./replay_view.js")).ReplayView(host, session, query),
  },
  strides: {
    name: "Strides",
    open: async (host, session, query) => new (await import("./strides_view.js")).StridesView(host, session, query),
  },
  curves: {
    name: "Curves and numbers",
    open: async (host, session) => {
      const view = new (await import("../measured_view.js")).MeasuredView(session);
      fill(host, view.node);
      return view;
    },
  },
  files: {
    name: "Files",
    open: async (host, session) => {
      fill(host, new (await import("../files_panel.js")).FilesPanel(session).node);
      return {};
    },
  },
  versions: {
    name: "Versions",
    open: async (host, session) => new (await import("./versions_view.js")).VersionsView(host, session),
  },
};
const FIRST = "report";
const AT_HAND = ["strides.csv", "joint_angles.csv", "c3d", "mcap"];

export class EndedView {
  /** @type {Part | null} */
  part = null;
  disposed = false;

  /** @param {HTMLElement} host @param {any} session @param {string | undefined} part one of PARTS */
  constructor(host, session, part) {
    this.session = session;
    this.name = part && part in PARTS ? part : FIRST;
    this.place = el("div", { class: "part" });
    this.exports = el("div", { class: "export-list" });
    fill(host, sessionHead(session), this.tabs(), this.place);
    this.open();
  }

  tabs() {
    const offered = Object.entries(PARTS).filter(([part]) => part !== "strides" || !isExercise(this.session.task));
    const links = offered.map(([part, { name }]) =>
      el("a", { href: this.addressOf(part), "aria-current": part === this.name ? "page" : null }, name),
    );
    const menu = el(
      "details",
      { class: "export-menu", ontoggle: () => this.showExports() },
      el("summary", {}, "Export"),
      this.exports,
    );
    return el("nav", { class: "parts-nav", "aria-label": "Session" }, ...links, el("span", { class: "spring" }), menu);
  }

  /** @param {string} part */
  addressOf(part) {
    return addressOf("session", { session: this.session.id, part });
  }

  async open() {
    const query = new URLSearchParams(location.hash.split("?")[1] ?? "");
    try {
      const part = await PARTS[this.name].open(this.place, this.session, query);
      if (this.disposed) part.dispose?.();
      else this.part = part;
    } catch {
      const again = el("button", { type: "button", onclick: () => location.reload() }, "Load again");
      fill(this.place, el("p", { class: "panel", role: "status" }, "This part could not be loaded. ", again));
    }
  }

  /** What is often taken away; the rest is among the files. */
  async showExports() {
    if (this.asked) return;
    this.asked = true;
    const { id } = this.session;
    const { items } = await get("/sessions/{session}/exports", { session: id }).catch(() => ({ items: [] }));
    const had = items.filter(({ format, available }) => available && AT_HAND.includes(format));
    fill(
      this.exports,
      el("a", { download: true, href: linkTo("/sessions/{session}/report.pdf", { session: id }) }, "Report (PDF)"),
      ...had.map(({ format, file_name }) => {
        const href = linkTo("/sessions/{session}/exports/{name}", { session: id, name: format });
        return el("a", { href, download: file_name }, format);
      }),
      el("a", { href: this.addressOf("files") }, "All files and formats"),
    );
  }

  dispose() {
    this.disposed = true;
    this.part?.dispose?.();
  }
}
