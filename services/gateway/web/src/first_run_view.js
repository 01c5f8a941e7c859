// @ts-check
// The first administrator of a site: who can read the gateway's terminal has the code.
import { get, post } from "./api.js";
import { el, fill, tell } from "./dom.js";
import { labelled, textInput } from "./form_fields.js";
import { PasswordPair } from "./password_pair.js";

/** @param {import("./pages.js").Place} place */
export const open = (place) => new FirstRunView(place);

class FirstRunView {
  /** @param {import("./pages.js").Place} place */
  constructor({ host, params, app }) {
    this.app = app;
    this.code = textInput({ required: true, maxlength: 32, value: params.code });
    this.login = textInput({ required: true, maxlength: 64, autocomplete: "username" });
    this.password = new PasswordPair("Password");
    this.problem = el("p", { class: "banner", role: "alert", hidden: true });
    this.go = el("button", { class: "primary", type: "submit" }, "Create the account");
    fill(
      host,
      el(
        "section",
        { class: "panel door", "aria-label": "First run" },
        el("h1", {}, "Welcome to Ambula"),
        el("p", {}, "Nobody has an account here yet. Choose the first administrator; they make the other accounts."),
        el(
          "form",
          { onsubmit: (event) => this.submit(event) },
          labelled("Code", this.code, "Shown in the terminal where Ambula was started, and kept in its data folder."),
          labelled("Name to sign in with", this.login, "Letters, digits, dots: for example m.arnold"),
          ...this.password.nodes,
          this.problem,
          this.go,
        ),
      ),
    );
    // The code works once; it need not stay in the browser's history.
    if (params.code) history.replaceState(null, "", "#/first-run");
    (params.code ? this.login : this.code).focus();
    this.load();
  }

  async load() {
    const state = await get("/sign-in").catch(() => null);
    if (state && !state.first_run) location.replace("#/sign-in");
  }

  /** @param {SubmitEvent} event */
  async submit(event) {
    event.preventDefault();
    tell(this.problem, "");
    this.go.disabled = true;
    try {
      const body = { code: this.code.value, login: this.login.value, password: this.password.value };
      this.app.signedIn(await post("/first-run", { body }));
    } catch (problem) {
      tell(this.problem, /** @type {Error} */ (problem).message);
    } finally {
      this.go.disabled = false;
    }
  }

  dispose() {}
}
