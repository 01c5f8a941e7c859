// @ts-check
// What happened in a session, told in the order of time as a replay goes on, and anew after a jump back.

/** @typedef {{at_s: number, tell: () => void}} Happening */

export class Happenings {
  /** @type {Happening[]} */
  all = [];
  told = 0;
  at_s = -Infinity;

  /** @param {Happening[]} more in any order */
  add(more) {
    this.all = [...this.all, ...more].sort((a, b) => a.at_s - b.at_s);
    this.told = -1;
  }

  /** Whether something that has been told lies ahead now, or came in late: then all is told anew. @param {number} at_s */
  needsReset(at_s) {
    return this.told < 0 || at_s < this.at_s;
  }

  reset() {
    this.told = 0;
    this.at_s = -Infinity;
  }

  /** Tell what happened since, up to a time. @param {number} at_s */
  advance(at_s) {
    while (this.told < this.all.length && this.all[this.told].at_s <= at_s) {
      this.all[this.told].tell();
      this.told += 1;
    }
    this.at_s = at_s;
  }
}
