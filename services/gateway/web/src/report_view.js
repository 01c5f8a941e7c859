// A session that is over: numbers with their spread, mean curves, files.
import { get } from "./api.js";
import { MeanChart } from "./charts.js";
import { el, fill, svg } from "./dom.js";
import { SIDE_COLOUR, SIDE_DASH } from "./palette.js";
import { PatientLink } from "./patient_link.js";
import { bytes, clock, number, shown, when } from "./units.js";
import { STORED_WORDS, headlineRank, jointName, metricGroup, metricName } from "./words.js";

const FIRST_CURVES = ["hip_flexion", "knee_flexion"];

export class ReportView {
  constructor(host, session) {
    this.session = session;
    this.charts = [];
    this.numbers = el("div", { class: "scroll" }, el("p", { class: "quiet" }, "Reading …"));
    this.tiles = el("div", { class: "tiles wide" });
    this.curves = el("div", { class: "mean-curves" });
    this.more = el("div", { class: "pair" });
    this.files = el("ul", { class: "files" });
    fill(
      host,
      this.head(),
      this.tiles,
      el(
        "div",
        { class: "report" },
        el(
          "div",
          { class: "column" },
          el(
            "section",
            { class: "panel", "aria-label": "Metrics" },
            el(
              "div",
              { class: "panel-head" },
              el("h2", {}, "Numbers"),
              el("span", { class: "quiet" }, "mean ± standard deviation over strides"),
            ),
            this.numbers,
            this.more,
          ),
          el(
            "section",
            { class: "panel", "aria-label": "Recording" },
            el("h2", {}, "Recording"),
            el("p", { class: "quiet" }, "Everything that was measured and computed, as MCAP files with named fields."),
            this.files,
          ),
        ),
        this.curves,
      ),
    );
    this.load();
  }

  head() {
    const { session } = this;
    const { word, tone } = STORED_WORDS[session.state];
    const facts = [when(session.started ?? session.created), clock(session.duration_s), session.estimator].join(
      "  ·  ",
    );
    return el(
      "div",
      {},
      el(
        "div",
        { class: "session-head" },
        el("h1", {}, session.title),
        el("p", { class: "chip big", "data-tone": tone }, word),
        el("span", { class: "quiet" }, facts),
        el("span", { class: "spring" }),
        new PatientLink(session).node,
      ),
      session.reason ? el("p", { class: "banner" }, session.reason) : null,
    );
  }

  async load() {
    const path = `/sessions/${this.session.id}`;
    const [metrics, curves, files] = await Promise.all(
      ["metrics", "curves", "recordings"].map((part) => get(`${path}/${part}`).catch((problem) => problem)),
    );
    if (this.disposed) return;
    if (metrics instanceof Error) fill(this.numbers, el("p", { class: "quiet" }, metrics.message));
    else this.showMetrics(metrics.metrics);
    if (!(curves instanceof Error)) this.showCurves(curves.curves);
    this.showFiles(files instanceof Error ? [] : files);
  }

  showMetrics(metrics) {
    const groups = Object.groupBy(metrics, (metric) => metricGroup(metric) ?? "rest");
    const headlines = (groups.headlines ?? []).toSorted((a, b) => headlineRank(a) - headlineRank(b));
    fill(this.tiles, ...headlines.map(metricTile));
    fill(this.numbers, sideTable([...(groups.sides ?? []), ...(groups.counts ?? [])]));
    fill(
      this.more,
      ratioTable("Symmetry", "larger side / smaller side, 1.00 is equal", groups.symmetry),
      ratioTable("Left against right", "mean hip and knee curves over the stride, 0 is equal", groups.legs),
      ratioTable("Variability", "standard deviation / mean", groups.variability),
    );
  }

  showCurves(curves) {
    const joints = new Map();
    for (const curve of curves) {
      const [, side] = jointName(curve.degree_of_freedom);
      const joint = side ? curve.degree_of_freedom.slice(0, -side.length - 1) : curve.degree_of_freedom;
      if (side) joints.set(joint, { ...joints.get(joint), [side]: curve });
    }
    for (const joint of FIRST_CURVES.filter((name) => joints.has(name))) {
      const host = el("div", { class: "chart mean" });
      const sides = joints.get(joint);
      const counts = `L ${sides.left?.strides ?? 0}, R ${sides.right?.strides ?? 0} strides`;
      this.curves.append(
        el(
          "section",
          { class: "panel chart-panel", "aria-label": jointName(joint)[0] },
          el(
            "div",
            { class: "panel-head" },
            el("h2", {}, jointName(joint)[0]),
            el("span", { class: "quiet" }, "mean ± SD"),
            el("span", { class: "spring" }),
            sample("left"),
            sample("right"),
            el("span", { class: "quiet" }, counts),
          ),
          host,
        ),
      );
      this.charts.push(new MeanChart(host, sides));
    }
  }

  showFiles(files) {
    if (files.length === 0) {
      fill(this.files, el("li", { class: "quiet" }, "No files. The archive may not have been running."));
      return;
    }
    fill(
      this.files,
      ...files.map((file) =>
        el(
          "li",
          {},
          el(
            "a",
            { href: `/v1/sessions/${this.session.id}/recordings/${encodeURIComponent(file.name)}`, download: true },
            file.name,
          ),
          el(
            "span",
            { class: "quiet" },
            `${bytes(file.size_bytes)}, ${file.kind === "raw" ? "sensors" : "computed"}${file.complete ? "" : ", still open"}`,
          ),
        ),
      ),
    );
  }

  dispose() {
    this.disposed = true;
    for (const chart of this.charts) chart.dispose();
  }
}

function sideTable(metrics) {
  const find = (name, side) => metrics.find((metric) => metric.name === name && metric.side === side);
  const rows = [...new Set(metrics.map((metric) => metric.name))].map((name) => {
    const [left, right] = [find(name, "left"), find(name, "right")];
    const { unit } = shown((left ?? right).unit, name);
    return el(
      "tr",
      {},
      el("th", { scope: "row" }, metricName(name), unit ? el("span", { class: "unit" }, ` ${unit}`) : null),
      cell(left),
      cell(right),
    );
  });
  const head = [
    el("th", { scope: "col" }, ""),
    el("th", { scope: "col", class: "number left" }, "Left"),
    el("th", { scope: "col", class: "number right" }, "Right"),
  ];
  return el("table", {}, el("thead", {}, el("tr", {}, ...head)), el("tbody", {}, ...rows));
}

function ratioTable(title, meaning, metrics = []) {
  const rows = metrics.map((metric) => el("tr", {}, el("th", { scope: "row" }, metricName(metric.name)), cell(metric)));
  return el(
    "div",
    {},
    el("h3", {}, title),
    el("p", { class: "quiet" }, meaning),
    el("table", {}, el("tbody", {}, ...rows)),
  );
}

function metricTile(metric) {
  const { factor, unit, digits } = shown(metric.unit, metric.name);
  const withheld = metric.value === null;
  const spread = metric.spread === null || withheld ? "" : `± ${number(metric.spread * factor, digits)}`;
  return el(
    "div",
    { class: "tile" },
    el("span", { class: "name" }, metricName(metric.name)),
    el(
      "span",
      {},
      el("span", { class: "value" }, withheld ? "–" : number(metric.value * factor, digits)),
      el("span", { class: "unit" }, ` ${unit}`),
    ),
    el(
      "span",
      { class: "quiet" },
      withheld ? (metric.withheld_because ?? "") : `${spread}  (${metric.strides} strides)`,
    ),
  );
}

function cell(metric) {
  if (!metric) return el("td", { class: "number" }, "–");
  const { factor, digits, unit } = shown(metric.unit, metric.name);
  const shownUnit = metric.side === null ? unit : "";
  if (metric.value === null) return el("td", { class: "number quiet", title: metric.withheld_because }, "–");
  const spread = metric.spread === null ? "" : ` ± ${number(metric.spread * factor, digits)}`;
  return el(
    "td",
    { class: "number" },
    number(metric.value * factor, digits),
    el("span", { class: "quiet" }, spread || ` ${shownUnit}`),
  );
}

function sample(side) {
  const line = svg("line", {
    x1: 0,
    x2: 34,
    y1: 6,
    y2: 6,
    stroke: SIDE_COLOUR[side],
    "stroke-width": 2.5,
    "stroke-dasharray": SIDE_DASH[side]?.join(" "),
  });
  const drawing = svg("svg", { width: 34, height: 12, "aria-hidden": "true" }, line);
  return el("span", { class: `sample ${side}` }, side === "left" ? "L " : "R ", drawing);
}
