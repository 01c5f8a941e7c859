// @ts-check
// A list that is read part by part: a table, where one is in it, and what to do when there is nothing.
import { el, fill, say, table, tell } from "./dom.js";

/** @typedef {import("./dom.js").Child} Child */

const SIZE = 25;

/** @template T */
export class PagedList {
  offset = 0;
  total = 0;
  asked = 0;

  /**
   * @param {object} wish
   * @param {string[]} wish.columns names, those of numbers with # at the end
   * @param {Child | Child[]} wish.empty what to do next when nothing is there
   * @param {(part: { offset: number, limit: number }) => Promise<{ total: number, items: T[] }>} wish.read
   * @param {(item: T) => HTMLTableRowElement} wish.row
   */
  constructor({ columns, empty, read, row }) {
    this.read = read;
    this.row = row;
    this.rows = el("tbody");
    this.columns = columns.map((name) => name.replace(/#$/, ""));
    this.table = table(columns, this.rows);
    this.empty = el("div", { class: "empty", hidden: true }, empty);
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.place = el("span", { class: "quiet", role: "status" });
    this.before = el("button", { type: "button", onclick: () => this.turn(-SIZE) }, "Previous");
    this.after = el("button", { type: "button", onclick: () => this.turn(SIZE) }, "Next");
    this.pager = el("div", { class: "pager" }, this.place, this.before, this.after);
    this.node = el("div", { class: "paged-list" }, this.problem, this.table, this.empty, this.pager);
    this.pager.hidden = true;
  }

  /** @param {number} by */
  turn(by) {
    this.offset = Math.max(0, this.offset + by);
    return this.refresh();
  }

  /** Read from the beginning: something else is asked for. */
  restart() {
    this.offset = 0;
    return this.refresh();
  }

  /** Read the present part again. An answer that comes after a later question is dropped. */
  async refresh() {
    const turn = (this.asked += 1);
    try {
      const page = await this.read({ offset: this.offset, limit: SIZE });
      if (turn !== this.asked) return;
      if (page.items.length === 0 && this.offset > 0) return void (await this.turn(-SIZE));
      this.show(page);
      tell(this.problem, "");
    } catch (problem) {
      if (turn === this.asked) tell(this.problem, /** @type {Error} */ (problem).message);
    }
  }

  /** On a narrow screen a row is a block, and its cells say themselves what they are. @param {HTMLTableRowElement} row */
  named(row) {
    for (const [place, cell] of [...row.cells].entries()) cell.dataset.column = this.columns[place];
    return row;
  }

  /** @param {{ total: number, items: T[] }} page */
  show({ total, items }) {
    this.total = total;
    fill(this.rows, items.map((item) => this.named(this.row(item))));
    this.table.hidden = total === 0;
    this.empty.hidden = total > 0;
    this.pager.hidden = total === 0;
    say(this.place, `${this.offset + 1} to ${this.offset + items.length} of ${total}`);
    this.before.disabled = this.offset === 0;
    this.after.disabled = this.offset + items.length >= total;
    this.before.hidden = this.after.hidden = total <= SIZE;
  }
}

/** A row of a table; what is no cell yet becomes one. @param {...(Child | Child[])} cells */
export const row = (...cells) =>
  el(
    "tr",
    {},
    ...cells.map((cell) =>
      cell instanceof HTMLTableCellElement ? cell : el("td", {}, ...(Array.isArray(cell) ? cell : [cell])),
    ),
  );

/** The cell that names the row. @param {...Child} children */
export const rowHead = (...children) => el("th", { scope: "row" }, ...children);

/** @param {string} word @param {"good" | "wait" | "check" | "lost" | "none"} tone */
export const chip = (word, tone) => el("span", { class: "chip small", "data-tone": tone }, word);

/** The cell of a time: it stays on one line. @param {string} text */
export const moment = (text) => el("td", { class: "moment" }, text);

/** What can be done with a row. @param {...(HTMLElement | null)} buttons */
export const rowActions = (...buttons) => el("td", { class: "row-actions" }, ...buttons);

/** A button in a row; `about` tells a screen reader which row. @param {string} word @param {string} about @param {() => unknown} act */
export const rowButton = (word, about, act) =>
  el("button", { class: "quiet-button", type: "button", onclick: act }, word, el("span", { class: "unseen" }, ` ${about}`));
