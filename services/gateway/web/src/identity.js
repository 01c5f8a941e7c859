// @ts-check
// Who has signed in. While a page is open the sign-in is renewed now and then, so that it outlasts a quiet hour.
import { ApiProblem, get, post } from "./api.js";

/** @typedef {import("./pages.js").Me} Me */

const RENEW_EVERY_MS = 10 * 60 * 1000;
const ASK_AGAIN_MS = 2000;
const BACK = "ambula.back";

export class Identity {
  /** @type {Me | null} */
  me = null;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  timer;

  /** Ask the gateway until it answers. @param {(problem: Error) => void} onTrouble */
  async find(onTrouble) {
    for (;;) {
      try {
        return this.keep(await get("/me"));
      } catch (problem) {
        if (problem instanceof ApiProblem && problem.status === 401) return;
        onTrouble(/** @type {Error} */ (problem));
        await new Promise((resolve) => setTimeout(resolve, ASK_AGAIN_MS));
      }
    }
  }

  /** @param {Me} me */
  keep(me) {
    this.me = me;
    clearInterval(this.timer);
    this.timer = setInterval(() => post("/sign-in/renewal").catch(() => {}), RENEW_EVERY_MS);
  }

  lose() {
    this.me = null;
    clearInterval(this.timer);
  }
}

/** Where one was when one had to sign in; signing in elsewhere (OIDC) leaves the page, so the tab keeps it. */
export function rememberPlace() {
  if (location.hash.length > 2) sessionStorage.setItem(BACK, location.hash);
}

/** The place that was remembered, once. */
export function placeBefore() {
  const place = sessionStorage.getItem(BACK) ?? "#/";
  sessionStorage.removeItem(BACK);
  return place;
}
