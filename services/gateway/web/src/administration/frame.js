// @ts-check
// What the pages of the administration share: a heading and the way from one to the other.
import { el, fill } from "../dom.js";
import { PAGES, addressOf, isFor } from "../pages.js";

/**
 * Fill a page of the administration.
 * @param {import("../pages.js").Place} place @param {string} name of the page
 * @param {string} about what it is for
 * @param {(HTMLElement | null)[]} actions beside its heading
 * @param {...HTMLElement} parts
 */
export function frame({ host, app }, name, about, actions, ...parts) {
  const tabs = PAGES.filter((page) => page.tab && isFor(page, app.me)).map((page) =>
    el("a", { href: addressOf(page.name), "aria-current": page.name === name ? "page" : null }, page.tab),
  );
  const title = PAGES.find((page) => page.name === name)?.title ?? "";
  fill(
    host,
    el("nav", { class: "tabs", "aria-label": "Administration" }, ...tabs),
    el(
      "section",
      { class: "panel listed", "aria-label": title },
      el("div", { class: "panel-head" }, el("h1", {}, title), el("span", { class: "spring" }), ...actions),
      el("p", { class: "quiet" }, about),
      ...parts,
    ),
  );
}

/** @param {string} word @param {() => unknown} act */
export const newButton = (word, act) => el("button", { class: "primary", type: "button", onclick: act }, word);
