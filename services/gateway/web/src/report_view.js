// The report of a session that is over, in its reading levels and two languages.
import { get, linkTo } from "./api.js";
import { Choices } from "./choices.js";
import { el, fill } from "./dom.js";
import { reportDocument } from "./report_document.js";
import { ALL_STRIDES, LANGUAGES, REPORT_WORDS } from "./report_words.js";

const WALKS = [null, "walk", "six_minute_walk", "ten_metre_walk"];

export class ReportView {
  constructor(host, session) {
    this.session = session;
    this.reports = {};
    this.languages = new Choices({
      name: "report-language",
      label: REPORT_WORDS.en.languages,
      options: LANGUAGES,
      onChoose: () => this.show(),
    });
    this.levels = new Choices({
      name: "report-level",
      label: REPORT_WORDS.en.reading_level,
      options: this.levelsIn("en"),
      onChoose: () => this.show(),
    });
    this.pdf = el("a", { class: "button", download: true });
    this.print = el("button", { type: "button", onclick: () => window.print() });
    this.sheet = el("div", { class: "sheet-place", "aria-live": "polite" });
    fill(
      host,
      el("div", { class: "report-bar" }, this.levels.node, el("span", { class: "spring" }), this.languages.node, this.print, this.pdf),
      this.sheet,
    );
    this.show();
  }

  /** The chosen level in the chosen language. */
  async show() {
    const [level, language] = [this.levels.chosen, this.languages.chosen];
    const words = REPORT_WORDS[language];
    this.levels.reword(words.reading_level, this.levelsIn(language));
    this.languages.reword(words.languages, LANGUAGES);
    this.pdf.href = linkTo("/sessions/{session}/report.pdf", { session: this.session.id, ...wishOf(language, level) });
    this.pdf.textContent = words.pdf;
    this.print.textContent = words.print;
    if (!this.sheet.firstChild) fill(this.sheet, el("p", { class: "quiet" }, words.reading));
    const shown = await this.sheetOf(language, level);
    if (!this.disposed && level === this.levels.chosen && language === this.languages.chosen) fill(this.sheet, shown);
  }

  async sheetOf(language, level) {
    const wish = wishOf(language, level);
    const asked = JSON.stringify(wish);
    try {
      this.reports[asked] ??= await get("/sessions/{session}/report", { session: this.session.id, ...wish });
      const report = this.reports[asked];
      const has = report.sections.some((section) => String(section.page) === level);
      return has ? reportDocument(report, Number(level)) : el("p", { class: "panel" }, REPORT_WORDS[language].nothing);
    } catch (problem) {
      return el("p", { class: "panel" }, problem.message);
    }
  }

  levelsIn(language) {
    const { [ALL_STRIDES]: strides, ...others } = REPORT_WORDS[language].levels;
    return WALKS.includes(this.session.task) ? REPORT_WORDS[language].levels : others;
  }

  dispose() {
    this.disposed = true;
  }
}

const wishOf = (language, level) => ({ language, strides: level === ALL_STRIDES ? true : null });
