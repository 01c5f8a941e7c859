// @ts-check
// From the address to a page: loads it, gives the document its title and puts the focus on the heading.
import { el, fill } from "./dom.js";
import { isFor, pageOf } from "./pages.js";

/** @typedef {import("./pages.js").App} App @typedef {import("./pages.js").Page} Page @typedef {import("./pages.js").View} View */

const NAME = "Ambula";

export class Router {
  /** @type {View | null} */
  view = null;
  /** @type {MutationObserver | null} */
  heading = null;
  turn = 0;

  /** @param {HTMLElement} content @param {(page: Page | null) => void} onPage told before a page is shown */
  constructor(content, onPage) {
    this.content = content;
    this.onPage = onPage;
  }

  /** The page that the address names. @returns {Page | null} */
  get page() {
    return pageOf(location.hash)?.page ?? null;
  }

  /** Show the page of the address. @param {App} app @param {boolean} moved whether somebody came from another page */
  async open(app, moved) {
    this.close();
    const turn = this.turn;
    const found = pageOf(location.hash);
    this.onPage(found?.page ?? null);
    const host = el("div", { class: `page ${found?.page.name ?? "nowhere"}` });
    this.setTitle(found?.page.title ?? "No such page");
    fill(this.content, host);
    this.content.dataset.address = location.hash;
    if (moved) this.focusHeading(host);
    if (!found) return fill(host, nothing("There is no such page", "The address may be an old one."));
    const { page, params } = found;
    if (!isFor(page, app.me))
      return fill(host, nothing("This page is not for your role", "Ask an administrator of your clinic."));
    const loaded = await page.load().catch(() => null);
    if (turn !== this.turn) return;
    if (loaded) this.view = loaded.open({ host, params, app });
    else fill(host, nothing("This page could not be loaded", "Ambula may have been updated. Load the page again.", true));
  }

  /** Leave the page that is shown. */
  close() {
    this.turn += 1;
    this.heading?.disconnect();
    this.view?.dispose();
    this.view = null;
  }

  /** @param {string} name */
  setTitle(name) {
    document.title = `${name} – ${NAME}`;
  }

  // Some pages have their heading only when they know what it says. Whoever has moved on by then stays where they are.
  /** @param {HTMLElement} host */
  focusHeading(host) {
    this.content.focus();
    const look = () => {
      const found = host.querySelector("h1");
      if (!found) return;
      this.heading?.disconnect();
      if (document.activeElement !== this.content && document.activeElement !== document.body) return;
      found.tabIndex = -1;
      found.focus({ preventScroll: true });
    };
    this.heading = new MutationObserver(look);
    this.heading.observe(host, { childList: true, subtree: true });
    window.scrollTo(0, 0);
  }
}

/** @param {string} title @param {string} advice @param {boolean} [again] */
function nothing(title, advice, again = false) {
  const load = el("button", { class: "primary", type: "button", onclick: () => location.reload() }, "Load again");
  const go = again ? load : el("a", { href: "#/" }, "To the sessions");
  return el("div", { class: "empty" }, el("h1", {}, title), el("p", {}, advice), go);
}
