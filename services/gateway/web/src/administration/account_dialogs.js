// @ts-check
// What an administrator does with an account.
import { get, patch, post, put } from "../api.js";
import { confirmPassword } from "../confirm_password.js";
import { el } from "../dom.js";
import { askForm, showOnce } from "../form_dialog.js";
import { choice, labelled, textInput } from "../form_fields.js";
import { ROLES, ROLE_MEANINGS } from "../role_words.js";
import { drawPassword } from "./first_password.js";

/** @typedef {import("../api_types").Models["AccountOut"]} Account @typedef {import("../pages.js").Me} Me */
/** @typedef {Exclude<Account["role"], "service">} Role */

const PASSWORD = "";
const MOST_CLINICS = 100;
/** @type {Role[]} */
const PERSONS = ["viewer", "therapist", "admin"];
const HAND_OVER = "Hand it over in person. It is not shown again; its owner changes it under their name at the top right.";

/** Role, clinic and whether they manage the whole site; the last two are for administrators of the site to say. */
class Place {
  /** @param {Me} me @param {{ id: string, name: string }[]} clinics @param {Partial<Account>} account */
  constructor(me, clinics, account) {
    this.ofSite = me.site_admin;
    this.role = choice(
      PERSONS.map((role) => [role, `${ROLES[role]}: ${ROLE_MEANINGS[role]}`]),
      account.role ?? "therapist",
    );
    this.clinic = choice(
      clinics.map(({ id, name }) => [id, name]),
      account.clinic ?? me.clinic,
    );
    this.site = el("input", { type: "checkbox" });
    this.site.checked = account.site_admin ?? false;
    this.role.addEventListener("change", () => this.fit());
    this.siteField = el("label", { class: "tick" }, this.site, "Manages every clinic of the site");
    /** @type {HTMLElement[]} */
    this.nodes = [labelled("Role", this.role)];
    if (this.ofSite) this.nodes.push(labelled("Clinic", this.clinic), this.siteField);
    this.fit();
  }

  /** Only an administrator manages the site. */
  fit() {
    this.siteField.hidden = this.role.value !== "admin";
  }

  get chosen() {
    const role = /** @type {Role} */ (this.role.value);
    return this.ofSite ? { role, clinic: this.clinic.value, site_admin: role === "admin" && this.site.checked } : { role };
  }
}

/** @param {Me} me */
const clinicsFor = async (me) => (me.site_admin ? (await get("/clinics", { limit: MOST_CLINICS })).items : []);

/** @param {Me} me */
export async function createAccount(me) {
  const [clinics, { providers }] = await Promise.all([clinicsFor(me), get("/sign-in")]);
  const place = new Place(me, clinics, {});
  const login = textInput({ required: true, maxlength: 64, pattern: "[A-Za-z0-9][A-Za-z0-9._@\\-]*" });
  const way = choice([[PASSWORD, "A password"], ...providers.map((name) => /** @type {[string, string]} */ ([name, name]))]);
  const password = drawPassword();
  const fields = [labelled("Name to sign in with", login, "Letters, digits, dots: for example m.arnold"), ...place.nodes];
  if (providers.length > 0) fields.push(labelled("Signs in with", way));
  const done = await askForm({
    title: "New account",
    fields,
    action: "Create",
    act: () => {
      const how = way.value === PASSWORD ? { password } : { provider: way.value };
      return post("/accounts", { body: { login: login.value, site_admin: false, ...place.chosen, ...how } });
    },
  });
  if (done && way.value === PASSWORD)
    await showOnce({ title: `First password of ${login.value}`, about: HAND_OVER, text: password });
}

/** @param {Me} me @param {Account} account */
export async function changeAccount(me, account) {
  const place = new Place(me, await clinicsFor(me), account);
  return askForm({
    title: `Change ${account.login}`,
    fields: place.nodes,
    action: "Change",
    act: () => patch("/accounts/{account}", { account: account.id, body: place.chosen }),
  });
}

/** @param {Account} account */
export async function renewPassword({ id, login }) {
  const password = drawPassword();
  const done = await confirmPassword({
    title: `New password for ${login}`,
    about: `The present password of ${login} ends, and every browser that is signed in with it is signed out.`,
    action: "Draw a new password",
    act: () => put("/accounts/{account}/password", { account: id, body: { password } }),
  });
  if (done) await showOnce({ title: `New password of ${login}`, about: HAND_OVER, text: password });
}

/** @param {Account} account */
export const closeAccount = ({ id, login }) =>
  confirmPassword({
    title: `Close the account ${login}`,
    about: `${login} is signed out everywhere and can not sign in until the account is reopened. Nothing they did is lost.`,
    action: "Close it",
    act: () => patch("/accounts/{account}", { account: id, body: { disabled: true } }),
  });

/** @param {Account} account */
export const openAccount = ({ id, login }) =>
  askForm({
    title: `Reopen the account ${login}`,
    about: `${login} can sign in again, with the password and the role from before.`,
    fields: [],
    action: "Reopen it",
    act: () => patch("/accounts/{account}", { account: id, body: { disabled: false } }),
  });
