// What can be taken away: the recording as it is, and the same in the formats of other programs.
import { get } from "./api.js";
import { el, fill } from "./dom.js";
import { bytes } from "./units.js";

export class FilesPanel {
  constructor(session) {
    this.path = `/sessions/${session.id}`;
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

  async load() {
    const [files, exported] = await Promise.all([
      get(`${this.path}/recordings`).catch(() => []),
      get(`${this.path}/exports`).catch((problem) => problem),
    ]);
    this.showRecordings(files);
    this.showExports(exported);
  }

  showRecordings(files) {
    const lines = files.map(({ name, size_bytes, kind, complete }) => {
      const words = `${bytes(size_bytes)}, ${kind === "raw" ? "sensors" : "computed"}${complete ? "" : ", still open"}`;
      const href = `/v1${this.path}/recordings/${encodeURIComponent(name)}`;
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
    fill(this.exports, ...exported.map((each) => el("li", {}, JSON.stringify(each))));
  }
}
