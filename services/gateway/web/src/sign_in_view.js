// @ts-check
// Signing in: with a name and a password, or with the organisation's own service.
import { get, post } from "./api.js";
import { el, fill, tell } from "./dom.js";
import { labelled, passwordInput, textInput } from "./form_fields.js";

/** What the gateway says in the address when a browser comes back from a service. @type {Record<string, string>} */
const CAME_BACK = {
  expired: "Signing in took too long, or was begun in another window. Try again.",
  refused: "The service did not confirm who you are. Try again, or ask whoever runs it.",
  no_account: "Nobody has an account here under your name there. Ask an administrator of your clinic.",
  unavailable: "The service does not answer. Try again in a minute.",
};

/** Why the organisation's service did not let somebody in, as the gateway says it in the address. @type {Record<string, string>} */
const PROBLEMS = {
  expired: "Signing in took too long, or was begun in another window. Try again.",
  refused: "The sign-in service of your organisation did not let you in. Try again, or ask whoever runs it.",
  no_account: "You have no account here yet. Ask an administrator of your clinic to make one.",
  unavailable: "The sign-in service of your organisation does not answer. Try again in a few minutes.",
};

/** @param {import("./pages.js").Place} place */
export const open = (place) => new SignInView(place);

class SignInView {
  /** @param {import("./pages.js").Place} place */
  constructor({ host, app }) {
    this.app = app;
    this.login = textInput({ name: "login", required: true, maxlength: 64, autocomplete: "username" });
    this.password = passwordInput("current-password");
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.go = el("button", { class: "primary", type: "submit" }, "Sign in");
    this.providers = el("div", { class: "providers" });
    fill(
      host,
      el(
        "section",
        { class: "panel door", "aria-label": "Sign in" },
        el("h1", {}, "Sign in"),
        el(
          "form",
          { onsubmit: (event) => this.submit(event) },
          labelled("Name", this.login),
          labelled("Password", this.password),
          this.problem,
          this.go,
        ),
        this.providers,
        el("p", { class: "quiet" }, "No account, or the password is lost? Ask an administrator of your clinic."),
      ),
    );
    tell(this.problem, CAME_BACK[new URLSearchParams(location.hash.split("?")[1]).get("problem") ?? ""] ?? "");
    const [, code = ""] = /[?&]problem=(\w+)/.exec(location.hash) ?? [];
    tell(this.problem, Object.hasOwn(PROBLEMS, code) ? PROBLEMS[code] : "");
    this.login.focus();
    this.load();
  }

  async load() {
    const state = await get("/sign-in").catch(() => null);
    if (!state) return;
    if (state.first_run) location.replace("#/first-run");
    const links = state.providers.map((name) =>
      el("a", { class: "button", href: `/v1/sign-in/oidc/${encodeURIComponent(name)}` }, `Sign in with ${name}`),
    );
    fill(this.providers, links.length > 0 ? el("p", { class: "or" }, "or") : null, links);
  }

  /** @param {SubmitEvent} event */
  async submit(event) {
    event.preventDefault();
    tell(this.problem, "");
    this.go.disabled = true;
    try {
      this.app.signedIn(await post("/sign-in", { body: { login: this.login.value, password: this.password.value } }));
    } catch (problem) {
      tell(this.problem, /** @type {Error} */ (problem).message);
      this.password.select();
    } finally {
      this.go.disabled = false;
    }
  }

  dispose() {}
}
