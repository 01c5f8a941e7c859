// A report as the gateway composes it, put on the page: the same sentences, tables and drawings as its PDF.
import { el } from "./dom.js";

const GRADE_TONES = { good: "good", fair: "check", poor: "check", withheld: "lost" };
const DRAWING = "image/svg+xml";

/** The parts of one reading level; `page` is 1 for therapist and patient, 2 for specialists, 3 for all strides. */
export function reportDocument(report, page) {
  const sections = report.sections.filter((section) => section.page === page);
  return el(
    "article",
    { class: "sheet", lang: report.language, "data-report": report.id, "aria-label": report.header.title },
    reportHeader(report.header),
    ...sections.map(reportSection),
    reportFooter(report.footer, page, Math.max(...report.sections.map((section) => section.page))),
  );
}

function reportHeader({ title, subtitle, facts, quality }) {
  const list = facts.map(({ label, text }) => el("div", {}, el("dt", {}, label), el("dd", {}, text)));
  return el(
    "header",
    {},
    el("h2", {}, title),
    el("p", { class: "quiet" }, subtitle),
    el("dl", { class: "sheet-facts" }, ...list),
    el(
      "p",
      { class: "quality" },
      el("b", {}, quality.head),
      el("span", { class: "chip", "data-tone": GRADE_TONES[quality.grade] ?? "done" }, quality.word),
      el("span", {}, quality.text),
    ),
    quality.warnings.length > 0 ? el("ul", { class: "warnings" }, ...quality.warnings.map((each) => el("li", {}, each))) : null,
  );
}

function reportSection({ id, title, sentences, charts, table: grid, notes }) {
  const heading = `section-${id}`;
  return el(
    "section",
    { "aria-labelledby": heading, "data-section": id },
    el("h3", { id: heading }, title),
    sentences.length > 0 ? el("ul", { class: "sentences" }, ...sentences.map((each) => el("li", {}, each))) : null,
    charts.length > 0 ? el("div", { class: "drawings" }, ...charts.map(reportChart)) : null,
    grid && reportTable(grid),
    ...notes.map((note) => el("p", { class: "quiet note" }, note)),
  );
}

function reportChart({ title, svg, alt, columns }) {
  const host = el("div", { role: "img", "aria-label": alt }, drawingOf(svg));
  return el("figure", { "data-columns": columns }, el("figcaption", {}, title), host);
}

/** A stand-alone drawing as a node; it scales with its place. Parsed, not written as markup, so nothing in it can run. */
export function drawingOf(text) {
  const { documentElement: root } = new DOMParser().parseFromString(text, DRAWING);
  if (root.localName !== "svg") throw new Error("The drawing of this report can not be read.");
  for (const foreign of root.querySelectorAll("script, foreignObject")) foreign.remove();
  if (!root.hasAttribute("viewBox"))
    root.setAttribute("viewBox", `0 0 ${parseFloat(root.getAttribute("width"))} ${parseFloat(root.getAttribute("height"))}`);
  root.removeAttribute("height");
  root.setAttribute("width", "100%");
  root.setAttribute("aria-hidden", "true");
  return document.importNode(root, true);
}

/** Rows and columns as the report has them; sides bear their letter and colour. */
export function reportTable({ caption, columns, rows }) {
  const numeric = ({ numeric: right, side }) => [right ? "number" : "", side ?? ""].join(" ").trim();
  const head = columns.map((column) => el("th", { scope: "col", class: numeric(column) }, column.head));
  const body = rows.map(({ head: name, note, cells }) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, name, note ? el("span", { class: "unit" }, ` ${note}`) : null),
      ...cells.map((cell, place) => reportCell(cell, columns[columnOf(cells, place)])),
    ),
  );
  return el(
    "div",
    { class: "scroll" },
    el(
      "table",
      {},
      el("caption", { class: "unseen" }, caption),
      el("thead", {}, el("tr", {}, ...head)),
      el("tbody", {}, ...body),
    ),
  );
}

/** A cell before may have taken several columns; the first one holds the heads of the rows. */
export const columnOf = (cells, place) => 1 + cells.slice(0, place).reduce((sum, { span }) => sum + span, 0);

function reportCell({ text, note, tone, span }, { numeric }) {
  const small = note ? el("small", { class: "quiet" }, note) : null;
  const place = span > 1 ? "whole" : numeric ? "number" : null;
  return el("td", { class: place, "data-tone": tone, colspan: span > 1 ? span : null }, text, small);
}

function reportFooter({ items, disclaimer, page }, number, count) {
  const words = page.replace("{page}", String(number)).replace("{pages}", String(count));
  return el("footer", {}, el("p", {}, el("b", {}, disclaimer)), el("p", {}, [...items, words].join("  ·  ")));
}
