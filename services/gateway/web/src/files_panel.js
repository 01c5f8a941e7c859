// What can be taken away: the recording as it is, and the same in the formats of other programs.
import { get, linkTo } from "./api.js";
import { el, fill } from "./dom.js";
import { bytes } from "./units.js";

const LOOK_AGAIN_MS = 2000;
const LOOKS = 15;

export class FilesPanel {
  constructor(session) {
    this.id = session.id;
    this.files = el("ul", { class: "files" });
    this.exports = el("ul", { class: "files exports" });
    this.node = el(
      "section",
      { class: "panel", "aria-label": "Files" },
      el("h2", {}, "Files"),
      el("h3", {}, "Recording"),
      el("p", { class: "quiet" }, "Everything that was measured and computed, as MCAP files with named fields."),
      this.files,
      el("h3", { class: "below" }, "For other programs"),
      this.exports,
    );
    this.load();
  }

  /** A session that has just ended is being closed by the archive: its files come a moment later. */
  async load(left = LOOKS) {
    const [files, exported] = await Promise.all([
      get("/sessions/{session}/recordings", { session: this.id }).catch(() => []),
      get("/sessions/{session}/exports", { session: this.id }).catch((problem) => problem),
    ]);
    this.showRecordings(files);
    this.showExports(exported);
    if (left > 0 && (files.length === 0 || files.some(({ complete }) => !complete)))
      setTimeout(() => this.node.isConnected && this.load(left - 1), LOOK_AGAIN_MS);
  }

  showRecordings(files) {
    const lines = files.map(({ name, size_bytes, kind, complete }) => {
      const words = `${bytes(size_bytes)}, ${kind === "raw" ? "sensors" : "computed"}${complete ? "" : ", still open"}`;
      const href = linkTo("/sessions/{session}/recordings/{name}", { session: this.id, name });
      return el("li", {}, el("a", { href, download: true }, name), el("span", { class: "quiet" }, words));
    });
    const none = el("li", { class: "quiet" }, "No files. The archive may not have been running.");
    fill(this.files, ...(lines.length > 0 ? lines : [none]));
  }

  showExports(exported) {
    if (exported instanceof Error) {
      fill(this.exports, el("li", { class: "quiet" }, exported.message));
      return;
    }
    const { had, not } = possible(exported.items);
    const links = had.map(({ format, file_name, about }) => {
      const href = linkTo("/sessions/{session}/exports/{name}", { session: this.id, name: format });
      return el("li", {}, el("a", { href, download: file_name }, format), el("span", { class: "quiet" }, about));
    });
    const missing = not.map(([reason, formats]) => el("li", { class: "quiet" }, `${formats.join(", ")}: ${reason}.`));
    const fhir = el("a", { href: linkTo("/sessions/{session}/fhir", { session: this.id }), download: true }, "fhir");
    const about = "Bundle for a clinical information system (HL7 FHIR R4): every number, the report, how it was measured.";
    fill(this.exports, ...links, el("li", {}, fhir, el("span", { class: "quiet" }, about)), ...missing);
  }
}

/** Formats that can be had, and for each reason those that cannot. */
export function possible(items) {
  const not = new Map();
  for (const { format, reason } of items.filter(({ available }) => !available))
    not.set(reason, [...(not.get(reason) ?? []), format]);
  return { had: items.filter(({ available }) => available), not: [...not] };
}
