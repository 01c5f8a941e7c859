// How the services are, and what was not used and why.
import { get } from "./api.js";
import { el, fill, say, table } from "./dom.js";
import { bytes, clock, number } from "./units.js";

const SERVICE_COLUMNS = ["Service", "State", "Up#", "Processor#", "Memory#", "Queue#", "Dropped#", "Errors#"];
const STREAM_COLUMNS = [
  "Service",
  "Session",
  "Stream",
  "Received#",
  "of these replayed#",
  "Duplicates dropped#",
  "Lost#",
];
const REFUSED_COLUMNS = ["Service", "Session", "From", "Reason", "Count#"];

/** @param {import("./pages.js").Place} place */
export const open = ({ host }) => new SystemView(host);

export class SystemView {
  constructor(host) {
    this.rows = el("tbody");
    this.summary = el("p", { class: "quiet" });
    this.refused = el("tbody");
    this.streams = el("tbody");
    fill(
      host,
      el(
        "section",
        { class: "panel", "aria-label": "Services" },
        el("h1", {}, "System"),
        this.summary,
        table(SERVICE_COLUMNS, this.rows),
      ),
      el(
        "section",
        { class: "panel", "aria-label": "Streams" },
        el("h2", {}, "Streams of running sessions"),
        table(STREAM_COLUMNS, this.streams),
      ),
      el(
        "section",
        { class: "panel", "aria-label": "Not used" },
        el("h2", {}, "Not used, and why"),
        table(REFUSED_COLUMNS, this.refused),
      ),
    );
    this.load();
    this.timer = setInterval(() => this.load(), 2000);
  }

  async load() {
    const health = await get("/health").catch((problem) => problem);
    if (this.disposed) return;
    if (health instanceof Error) {
      say(this.summary, health.message);
      return;
    }
    const database = health.database ? "The database answers." : "The database does not answer.";
    say(
      this.summary,
      `${health.silent.length > 0 ? `Not heard: ${health.silent.join(", ")}.` : "All services are heard."} ${database}`,
    );
    fill(this.rows, ...orNone(health.services.map(serviceRow), SERVICE_COLUMNS.length));
    const perSession = health.services.flatMap((service) =>
      service.sessions.map((session) => ({ service: service.service, ...session })),
    );
    fill(
      this.streams,
      ...orNone(
        perSession.flatMap(({ service, session, inputs }) =>
          inputs.map((each) =>
            line(service, session, each.stream, each.received, each.recovered, each.duplicated, each.lost),
          ),
        ),
        7,
      ),
    );
    const refused = [
      ...health.services.flatMap((service) =>
        service.rejections.map((each) =>
          line(service.service, "–", each.subject, each.reason.replaceAll("_", " "), each.count),
        ),
      ),
      ...perSession.flatMap(({ service, session, rejections }) =>
        rejections.map((each) => line(service, session, each.subject, each.reason.replaceAll("_", " "), each.count)),
      ),
    ];
    fill(this.refused, ...orNone(refused, 5));
  }

  dispose() {
    this.disposed = true;
    clearInterval(this.timer);
  }
}

function serviceRow(service) {
  const state = el(
    "span",
    { class: "chip small", "data-tone": service.stale ? "lost" : "good" },
    service.stale ? `Silent for ${number(service.age_s, 0)} s` : "Good",
  );
  const share = service.uptime_s > 0 ? (100 * service.cpu_s) / service.uptime_s : 0;
  return el(
    "tr",
    {},
    el("td", {}, service.service),
    el("td", {}, state),
    ...[
      clock(service.uptime_s),
      `${number(share, 0)} %`,
      bytes(service.rss_bytes),
      `${service.queue_length} of ${service.queue_capacity}`,
      service.queue_dropped,
      service.errors,
    ].map((value) => el("td", { class: "number" }, value)),
  );
}

const line = (...values) =>
  el("tr", {}, ...values.map((value) => el("td", { class: typeof value === "number" ? "number" : null }, value)));
const orNone = (rows, columns) =>
  rows.length > 0 ? rows : [el("tr", {}, el("td", { colspan: columns, class: "quiet" }, "Nothing."))];
