// @ts-check
// Who works here, and what they may do.
import { get } from "../api.js";
import { el } from "../dom.js";
import { PagedList, chip, moment, row, rowActions, rowButton, rowHead } from "../paged_list.js";
import { ROLES } from "../role_words.js";
import { when } from "../units.js";
import { changeAccount, closeAccount, createAccount, openAccount, renewPassword } from "./account_dialogs.js";
import { frame, newButton } from "./frame.js";

/** @typedef {import("../api_types").Models["AccountOut"]} Account */

const ABOUT = "Everybody signs in with a name of their own, so that the audit can tell who did what.";

/** @param {import("../pages.js").Place} place */
export const open = (place) => new AccountsView(place);

class AccountsView {
  /** @param {import("../pages.js").Place} place */
  constructor(place) {
    this.me = place.app.me;
    this.list = new PagedList({
      columns: ["Name", "Role", "Clinic", "Signs in with", "State", "Browsers#", "Since", "Actions"],
      empty: "",
      read: (part) => get("/accounts", part),
      row: (/** @type {Account} */ account) => this.row(account),
    });
    frame(place, "accounts", ABOUT, [newButton("New account", () => this.then(createAccount(this.me)))], this.list.node);
    this.list.refresh();
  }

  /** @param {Account} account */
  row(account) {
    return row(
      rowHead(account.login),
      account.site_admin ? `${ROLES[account.role]}, whole site` : ROLES[account.role],
      account.clinic,
      account.provider ?? "password",
      stateOf(account),
      el("td", { class: "number" }, account.browsers),
      moment(when(account.created)),
      account.id === this.me.account ? el("td", { class: "quiet" }, "you") : this.actions(account),
    );
  }

  /** @param {Account} account */
  actions(account) {
    const { login, disabled } = account;
    return rowActions(
      rowButton("Change", login, () => this.then(changeAccount(this.me, account))),
      account.provider ? null : rowButton("New password", login, () => this.then(renewPassword(account))),
      disabled
        ? rowButton("Reopen", login, () => this.then(openAccount(account)))
        : rowButton("Close", login, () => this.then(closeAccount(account))),
    );
  }

  /** @param {Promise<unknown>} done */
  async then(done) {
    await done;
    this.list.refresh();
  }

  dispose() {}
}

/** @param {Account} account */
function stateOf({ disabled, locked_until }) {
  if (disabled) return chip("Closed", "none");
  if (locked_until && new Date(locked_until) > new Date()) return chip(`Locked until ${when(locked_until)}`, "check");
  return chip("Open", "good");
}
