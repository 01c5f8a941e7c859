// A session that is over: its report in two reading levels and two languages, and what it rests on.
import { get, linkTo } from "./api.js";
import { NEVER_CALIBRATED } from "./camera_words.js";
import { Choices } from "./choices.js";
import { conditionWords } from "./condition_words.js";
import { el, fill } from "./dom.js";
import { MeasuredView } from "./measured_view.js";
import { PatientLink } from "./patient_link.js";
import { reportDocument } from "./report_document.js";
import { ALL_STRIDES, LANGUAGES, REPORT_WORDS } from "./report_words.js";
import { clock, number, when } from "./units.js";
import { STORED_WORDS, TASKS, misplacedText } from "./words.js";

const MEASURED = "measured";
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
    this.sheet = el("div", { class: "sheet-place", "aria-live": "polite" });
    this.measured = new MeasuredView(session);
    fill(
      host,
      this.head(),
      el("div", { class: "report-bar" }, this.levels.node, el("span", { class: "spring" }), this.languages.node, this.pdf),
      this.sheet,
      this.measured.node,
    );
    this.show();
  }

  head() {
    const { session } = this;
    const { word, tone } = STORED_WORDS[session.state];
    const task = session.task && session.task !== "walk" ? taskWords(session) : null;
    const facts = [when(session.started ?? session.created), clock(session.duration_s), task, session.estimator];
    const misplaced = misplacedText(session.misplaced);
    return el(
      "div",
      { class: "report-head" },
      el(
        "div",
        { class: "session-head" },
        el("h1", {}, session.title),
        el("p", { class: "chip big", "data-tone": tone }, word),
        el("span", { class: "spring" }),
        new PatientLink(session).node,
      ),
      el("p", { class: "quiet" }, [...facts, ...conditionWords(session.conditions)].filter(Boolean).join("  ·  ")),
      session.reason ? el("p", { class: "banner" }, session.reason) : null,
      misplaced ? el("p", { class: "banner" }, misplaced) : null,
      session.absolute === false ? el("p", { class: "banner" }, NEVER_CALIBRATED) : null,
    );
  }

  /** The chosen level in the chosen language. */
  async show() {
    const [level, language] = [this.levels.chosen, this.languages.chosen];
    const words = REPORT_WORDS[language];
    this.levels.reword(words.reading_level, this.levelsIn(language));
    this.languages.reword(words.languages, LANGUAGES);
    this.pdf.href = linkTo("/sessions/{session}/report.pdf", { session: this.session.id, ...wishOf(language, level) });
    this.pdf.textContent = words.pdf;
    this.measured.node.hidden = level !== MEASURED;
    this.sheet.hidden = level === MEASURED;
    if (level === MEASURED) return;
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
    this.measured.dispose();
  }
}

const wishOf = (language, level) => ({ language, strides: level === ALL_STRIDES ? true : null });

function taskWords({ task, walkway_m }) {
  return walkway_m ? `${TASKS[task]}, ${number(walkway_m, 1)} m` : TASKS[task];
}
