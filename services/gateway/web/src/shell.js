// @ts-check
// What is around every page: the way to the others, how the line is, and who has signed in.
import { AccountMenu } from "./account_menu.js";
import { el, fill, say } from "./dom.js";
import { PAGES, addressOf, isFor } from "./pages.js";

/** @typedef {import("./pages.js").Me} Me @typedef {import("./pages.js").Page} Page */

export class Shell {
  /** @param {{ start: () => void, onSignedOut: () => void }} actions */
  constructor({ start, onSignedOut }) {
    this.content = /** @type {HTMLElement} */ (document.getElementById("content"));
    this.connection = el("p", { id: "connection", class: "connection", role: "status" });
    this.nav = el("nav", { "aria-label": "Pages" });
    this.start = el("button", { id: "start", class: "primary", type: "button", onclick: start }, "Start a session");
    this.account = new AccountMenu({ onSignedOut });
    const icon = el("img", { src: "/static/favicon.svg", alt: "", width: "30", height: "30" });
    this.top = el(
      "header",
      { class: "top" },
      el("a", { class: "brand", href: "#/" }, icon, "Ambula"),
      this.nav,
      this.connection,
      this.start,
      this.account.node,
    );
    // An address of its own would be taken for a page.
    const skip = el("button", { class: "skip", type: "button", onclick: () => this.content.focus() }, "Skip to the content");
    this.content.before(skip, this.top);
  }

  /** Offer what somebody may see; null for nobody. @param {Me | null} me */
  offer(me) {
    const offered = PAGES.filter((page) => page.nav && isFor(page, me));
    fill(
      this.nav,
      offered.map((page) => el("a", { href: addressOf(page.name), "data-page": page.name }, page.nav)),
    );
    this.nav.hidden = me === null;
    this.start.hidden = !me?.may.includes("work");
    this.connection.hidden = me === null;
    this.account.show(me);
  }

  /** Which page is open. @param {Page | null} page */
  mark(page) {
    document.body.classList.toggle("bare", page?.bare ?? false);
    for (const link of this.nav.querySelectorAll("a")) {
      if (link.dataset.page === (page?.under ?? page?.name)) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
    }
  }

  /** What is wrong, before any page can be shown. @param {string} text */
  complain(text) {
    fill(this.content, el("p", { class: "banner", role: "alert" }, text));
  }

  /** How the line to the gateway is. @param {{ word: string, tone: string }} state */
  showConnection({ word, tone }) {
    say(this.connection, word);
    this.connection.dataset.tone = tone;
  }
}
