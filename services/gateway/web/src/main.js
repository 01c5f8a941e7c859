// @ts-check
// The beginning: who has signed in, which page is shown, and the line to the gateway.
import { whenSignedOut } from "./api.js";
import { Identity, placeBefore, rememberPlace } from "./identity.js";
import { LiveSocket } from "./live_socket.js";
import { addressOf } from "./pages.js";
import { Router } from "./router.js";
import { Shell } from "./shell.js";
import { connectionOf } from "./words.js";

const FIRST_ASKED = "#/sign-in";

const identity = new Identity();
const shell = new Shell({ start: () => startSession(), onSignedOut: () => leave("#/") });
const router = new Router(shell.content, (page) => shell.mark(page));

/** @type {any} */
let floor = null;
/** @type {LiveSocket | null} */
let line = null;

/** @type {import("./pages.js").App} */
const app = {
  get me() {
    return /** @type {import("./pages.js").Me} */ (identity.me);
  },
  setTitle: (name) => router.setTitle(name),
  startSession,
  signedIn: arrive,
};

/** @param {string} [patient] */
function startSession(patient) {
  location.hash = patient ? addressOf("start-for", { patient }) : addressOf("start");
}

/** Somebody has signed in, here or before. @param {import("./pages.js").Me} me */
function arrive(me) {
  identity.keep(me);
  shell.offer(me);
  watchFloor();
  go(placeBefore());
}

/** Nobody is signed in any more. @param {string} [place] to come back to; where one is without it */
function leave(place) {
  if (!identity.me) return;
  if (place) history.replaceState(null, "", place);
  rememberPlace();
  identity.lose();
  line?.close();
  line = floor = null;
  shell.offer(null);
  go(FIRST_ASKED);
}

/** Another address that does not come to lie above the present one: "back" would only lead into a circle. @param {string} place */
function go(place) {
  history.replaceState(null, "", place);
  show();
}

async function show(moved = true) {
  const permission = router.page ? router.page.permission : "known";
  if (!identity.me && permission !== null) {
    rememberPlace();
    history.replaceState(null, "", FIRST_ASKED);
  } else if (identity.me && permission === null) history.replaceState(null, "", "#/");
  await router.open(app, moved);
  if (floor) router.view?.onFloor?.(floor);
}

function watchFloor() {
  shell.showConnection(connectionOf(true, null));
  line = new LiveSocket("", {
    onMessage(/** @type {any} */ status) {
      floor = status;
      shell.showConnection(connectionOf(true, status));
      router.view?.onFloor?.(status);
    },
    onState: (/** @type {boolean} */ open) => shell.showConnection(connectionOf(open, floor)),
  });
}

shell.offer(null);
await identity.find((problem) => shell.complain(problem.message));
if (identity.me) {
  shell.offer(identity.me);
  watchFloor();
  if (location.hash.length < 3) history.replaceState(null, "", placeBefore());
}
whenSignedOut(() => leave());
window.addEventListener("hashchange", () => show());
setInterval(() => router.view?.tick?.(), 200);
show(false);
