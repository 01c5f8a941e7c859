// @ts-check
// Who has signed in, and what they can do about it.
import { post, put, remove } from "./api.js";
import { el, fill, tell } from "./dom.js";
import { askForm } from "./form_dialog.js";
import { labelled, passwordInput } from "./form_fields.js";
import { PasswordPair } from "./password_pair.js";
import { ROLES } from "./role_words.js";

/** @typedef {import("./pages.js").Me} Me */

export class AccountMenu {
  /** @param {{ onSignedOut: () => void }} actions */
  constructor({ onSignedOut }) {
    this.onSignedOut = onSignedOut;
    this.button = el("button", {
      class: "account-button",
      type: "button",
      "aria-expanded": "false",
      "aria-controls": "account-menu",
      onclick: () => this.open(this.list.hidden),
    });
    this.list = el("div", { id: "account-menu", class: "account-menu panel", hidden: true });
    this.told = el("p", { class: "quiet", role: "status", hidden: true });
    this.node = el("div", { class: "account" }, this.button, this.list);
    document.addEventListener("pointerdown", (event) => {
      if (!this.node.contains(/** @type {Node} */ (event.target))) this.open(false);
    });
    this.node.addEventListener("focusout", (event) => {
      if (event.relatedTarget && !this.node.contains(/** @type {Node} */ (event.relatedTarget))) this.open(false);
    });
    this.node.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || this.list.hidden) return;
      this.open(false);
      this.button.focus();
    });
  }

  /** @param {Me | null} me */
  show(me) {
    this.open(false);
    this.node.hidden = me === null;
    if (!me) return;
    fill(this.button, el("span", { class: "unseen" }, "Your account: "), me.login);
    const facts = [
      ["Name", me.login],
      ["Role", me.site_admin ? `${ROLES[me.role]}, whole site` : ROLES[me.role]],
      ["Clinic", me.clinic_name],
    ];
    const actions = [
      me.provider ? null : this.item("Change password", () => this.changePassword()),
      this.item("Sign out other browsers", () => this.endOthers()),
      this.item("Sign out", () => this.signOut()),
    ];
    fill(
      this.list,
      el("dl", {}, ...facts.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value)))),
      this.told,
      actions,
    );
  }

  /** @param {boolean} open */
  open(open) {
    this.list.hidden = !open;
    this.button.setAttribute("aria-expanded", String(open));
    if (open) tell(this.told, "");
  }

  /** @param {string} word @param {() => unknown} action */
  item(word, action) {
    return el("button", { type: "button", onclick: action }, word);
  }

  changePassword() {
    this.open(false);
    const present = passwordInput("current-password");
    const pair = new PasswordPair("New password");
    return askForm({
      title: "Change your password",
      about: "Other browsers that are signed in to your account are signed out.",
      fields: [labelled("Present password", present), ...pair.nodes],
      action: "Change it",
      act: () => put("/me/password", { body: { password: present.value, new_password: pair.value } }),
    });
  }

  async endOthers() {
    try {
      const { ended } = await remove("/me/sign-ins");
      tell(this.told, ended === 0 ? "No other browser was signed in." : `Signed out elsewhere: ${ended}.`);
    } catch (problem) {
      tell(this.told, /** @type {Error} */ (problem).message);
    }
  }

  async signOut() {
    try {
      await post("/sign-out");
      this.onSignedOut();
    } catch (problem) {
      tell(this.told, /** @type {Error} */ (problem).message);
    }
  }
}
