// @ts-check
// The beginning: who has signed in, which page is shown, and the line to the gateway.
import { get } from "./api.js";
import { LiveSocket } from "./live_socket.js";
import { Router } from "./router.js";
import { Shell } from "./shell.js";
import { connectionOf } from "./words.js";

/** @type {any} */
let floor = null;
/** @type {import("./pages.js").App} */
let app;

const shell = new Shell({ start: () => startSession() });
const router = new Router(shell.content, (page) => shell.mark(page));

/** @param {string} [patient] */
async function startSession(patient) {
  const { StartDialog } = await import("./start_dialog.js");
  const dialog = new StartDialog({ onStarted: (session) => (location.hash = `#/sessions/${session.id}`) });
  dialog.node.addEventListener("close", () => dialog.node.remove());
  dialog.open(patient);
}

async function show(moved = true) {
  await router.open(app, moved);
  if (floor) router.view?.onFloor?.(floor);
}

const me = await get("/me");
app = { me, setTitle: (name) => router.setTitle(name), startSession, signedIn: () => {} };
shell.offer(me);
new LiveSocket("", {
  onMessage(status) {
    floor = status;
    shell.showConnection(connectionOf(true, status));
    router.view?.onFloor?.(status);
  },
  onState: (open) => shell.showConnection(connectionOf(open, floor)),
});
setInterval(() => router.view?.tick?.(), 200);
window.addEventListener("hashchange", () => show());
shell.showConnection(connectionOf(true, null));
show(false);
