// @ts-check
// What is around every page: the way to the others, how the line is, and who has signed in.
import { el, fill, say } from "./dom.js";
import { PAGES, addressOf } from "./pages.js";

/** @typedef {import("./pages.js").Me} Me @typedef {import("./pages.js").Page} Page */

export class Shell {
  /** @param {{ start: () => void }} actions */
  constructor({ start }) {
    this.content = /** @type {HTMLElement} */ (document.getElementById("content"));
    this.connection = el("p", { id: "connection", class: "connection", role: "status" });
    this.nav = el("nav", { "aria-label": "Pages" });
    this.start = el("button", { id: "start", class: "primary", type: "button", onclick: start }, "Start a session");
    const icon = el("img", { src: "/static/favicon.svg", alt: "", width: "30", height: "30" });
    this.top = el(
      "header",
      { class: "top" },
      el("a", { class: "brand", href: "#/" }, icon, "Ambula"),
      this.nav,
      this.connection,
      this.start,
    );
    // An address of its own would be taken for a page.
    const skip = el("button", { class: "skip", type: "button", onclick: () => this.content.focus() }, "Skip to the content");
    this.content.before(skip, this.top);
  }

  /** Offer what somebody may see; null for nobody. @param {Me | null} me */
  offer(me) {
    const offered = PAGES.filter((page) => page.nav && page.permission && me?.may.includes(page.permission));
    fill(
      this.nav,
      offered.map((page) => el("a", { href: addressOf(page.name), "data-page": page.name }, page.nav)),
    );
    this.start.hidden = !me?.may.includes("work");
    this.connection.hidden = me === null;
  }

  /** Which page is open. @param {Page | null} page */
  mark(page) {
    for (const link of this.nav.querySelectorAll("a")) {
      if (link.dataset.page === (page?.under ?? page?.name)) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
  }

  /** How the line to the gateway is. @param {{ word: string, tone: string }} state */
  showConnection({ word, tone }) {
    say(this.connection, word);
    this.connection.dataset.tone = tone;
  }
}
