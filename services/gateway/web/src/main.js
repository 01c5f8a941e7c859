// Which page is shown, and the line to the gateway.
import { el, fill, say } from "./dom.js";
import { FloorView } from "./floor_view.js";
import { LiveSocket } from "./live_socket.js";
import { PatientView } from "./patient_view.js";
import { PatientsView } from "./patients_view.js";
import { SessionView } from "./session_view.js";
import { StartDialog } from "./start_dialog.js";
import { SystemView } from "./system_view.js";
import { connectionOf } from "./words.js";

const content = document.getElementById("content");
const connection = document.getElementById("connection");

let view = null;
let floor = null;
let floorStatus = null;

const dialog = new StartDialog({ onStarted: (session) => (location.hash = `#/sessions/${session.id}`) });
document.getElementById("start").addEventListener("click", () => dialog.open());

function showConnection(open, status) {
  const { word, tone } = connectionOf(open, status);
  say(connection, word);
  connection.dataset.tone = tone;
}

function route() {
  const [, page = "", id = ""] = location.hash.split("/");
  view?.dispose();
  floor = null;
  const host = el("div", { class: `page ${page || "floor"}` });
  fill(content, host);
  if (page === "sessions" && /^[A-Za-z0-9_-]+$/.test(id)) view = new SessionView(host, id);
  else if (page === "patients" && /^[A-Z0-9]+$/.test(id))
    view = new PatientView(host, id, { startSession: (code) => dialog.open(code) });
  else if (page === "patients") view = new PatientsView(host);
  else if (page === "system") view = new SystemView(host);
  else {
    floor = view = new FloorView(host, { startSession: () => dialog.open() });
    if (floorStatus) floor.onFloor(floorStatus);
  }
  for (const link of document.querySelectorAll("nav a")) {
    link.toggleAttribute("aria-current", link.dataset.page === (page === "" || page === "sessions" ? "floor" : page));
  }
}

new LiveSocket("", {
  onMessage(status) {
    floorStatus = status;
    showConnection(true, status);
    floor?.onFloor(status);
  },
  onState(open) {
    showConnection(open, floorStatus);
  },
});
setInterval(() => floor?.tick(), 200);

window.addEventListener("hashchange", route);
showConnection(true, null);
route();
