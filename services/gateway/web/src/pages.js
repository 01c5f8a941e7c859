// Every page: where it is, who may see it, and what is loaded for it. A page that is not in this table does not exist.

/**
 * What a page is given, and what it gives back.
 * @typedef {object} Place
 * @property {HTMLElement} host what it fills
 * @property {Record<string, string>} params the parts of the address that its pattern names
 * @property {App} app
 *
 * @typedef {object} View
 * @property {() => void} dispose called when another page is opened
 * @property {(status: any) => void} [onFloor] called with the newest list of running sessions
 * @property {() => void} [tick] called five times a second
 *
 * @typedef {object} App
 * @property {Me} me who has signed in (null on pages without a permission); `me.may` lists what they may do
 * @property {(name: string) => void} setTitle a better title for the document than the one in the table
 * @property {(patient?: string) => void} startSession
 * @property {(me: Me) => void} signedIn
 *
 * @typedef {import("./api_schema").components["schemas"]["MeOut"]} Me
 * @typedef {Me["may"][number]} Permission
 *
 * @typedef {object} Page
 * @property {string} name also the class of the element that the page fills
 * @property {string} pattern of the address behind `#/`; `:word` stands for a part of it, `:word?` for one that may be missing
 * @property {string} title of the document
 * @property {Permission | null} permission without which it is not offered; null where nobody has signed in
 * @property {string} [nav] its word among the pages that are always one press away
 * @property {string} [under] the page in the navigation that it belongs to
 * @property {string} [tab] its word among the pages of the administration
 * @property {boolean} [bare] nothing around it: no navigation, no footer
 * @property {() => Promise<{ open: (place: Place) => View }>} load
 */

/** @type {Page[]} */
export const PAGES = [
  {
    name: "sign-in",
    pattern: "sign-in",
    title: "Sign in",
    permission: null,
    load: () => import("./sign_in_view.js"),
  },
  {
    name: "first-run",
    pattern: "first-run/:code?",
    title: "First run",
    permission: null,
    load: () => import("./first_run_view.js"),
  },
  {
    name: "floor",
    pattern: "",
    title: "Sessions",
    permission: "read",
    nav: "Sessions",
    load: () => import("./floor_view.js"),
  },
  {
    name: "session",
    pattern: "sessions/:session/:part?",
    title: "Session",
    permission: "read",
    under: "floor",
    load: () => import("./session_view.js"),
  },
  {
    name: "start",
    pattern: "start",
    title: "Start a session",
    permission: "work",
    under: "floor",
    load: () => import("./start/start_view.js"),
  },
  {
    name: "start-for",
    pattern: "start/patient/:patient",
    title: "Start a session",
    permission: "work",
    under: "floor",
    load: () => import("./start/start_view.js"),
  },
  {
    name: "start-session",
    pattern: "start/session/:session",
    title: "Start a session",
    permission: "work",
    under: "floor",
    load: () => import("./start/start_view.js"),
  },
  {
    name: "feedback",
    pattern: "feedback/:session",
    title: "Your movement",
    permission: "read",
    bare: true,
    load: () => import("./feedback_view.js"),
  },
  {
    name: "patients",
    pattern: "patients",
    title: "Patients",
    permission: "read",
    nav: "Patients",
    load: () => import("./patients_view.js"),
  },
  {
    name: "patient",
    pattern: "patients/:patient",
    title: "Patient",
    permission: "read",
    under: "patients",
    load: () => import("./patient_view.js"),
  },
  {
    name: "bin",
    pattern: "bin",
    title: "Recycle bin",
    permission: "work",
    nav: "Recycle bin",
    load: () => import("./bin_view.js"),
  },
  {
    name: "system",
    pattern: "system",
    title: "System",
    permission: "read",
    nav: "System",
    load: () => import("./system_view.js"),
  },
  {
    name: "accounts",
    pattern: "administration",
    title: "Accounts",
    permission: "administer",
    nav: "Administration",
    tab: "Accounts",
    load: () => import("./administration/accounts_view.js"),
  },
  {
    name: "clinics",
    pattern: "administration/clinics",
    title: "Clinics",
    permission: "administer",
    under: "accounts",
    tab: "Clinics",
    load: () => import("./administration/clinics_view.js"),
  },
  {
    name: "keys",
    pattern: "administration/keys",
    title: "Keys",
    permission: "administer",
    under: "accounts",
    tab: "Keys",
    load: () => import("./administration/keys_view.js"),
  },
  {
    name: "devices",
    pattern: "administration/devices",
    title: "Devices",
    permission: "administer",
    under: "accounts",
    tab: "Devices",
    load: () => import("./administration/devices_view.js"),
  },
  {
    name: "audit",
    pattern: "administration/audit",
    title: "Audit",
    permission: "administer",
    under: "accounts",
    tab: "Audit",
    load: () => import("./administration/audit_view.js"),
  },
];

/**
 * The page of an address.
 * @param {string} hash as `location.hash` gives it
 * @returns {{ page: Page, params: Record<string, string> } | null} null for an address that no page has
 */
export function pageOf(hash) {
  const asked = partsOf(hash.replace(/^#\/?/, "").replace(/\?.*$/, ""));
  for (const page of PAGES) {
    const params = fit(partsOf(page.pattern), asked);
    if (params) return { page, params };
  }
  return null;
}

/** Whether somebody may see a page. @param {Page} page @param {Me | null} me */
export function isFor(page, me) {
  if (page.permission === null) return true;
  return me?.may.includes(page.permission) ?? false;
}

/**
 * The address of a page.
 * @param {string} name @param {Record<string, string>} [params]
 */
export function addressOf(name, params = {}) {
  const page = PAGES.find((each) => each.name === name);
  if (!page) throw new Error(`no page is called ${name}`);
  const path = page.pattern.replace(/:(\w+)\??/g, (_, word) => encodeURIComponent(params[word] ?? ""));
  return `#/${path.replace(/\/$/, "")}`;
}

/** @param {string} path */
const partsOf = (path) => path.split("/").filter((part) => part !== "");

/** Parts of an address are ids: letters, digits, and what joins them. @param {string[]} wanted @param {string[]} asked */
function fit(wanted, asked) {
  if (asked.length > wanted.length) return null;
  /** @type {Record<string, string>} */
  const params = {};
  for (const [place, part] of wanted.entries()) {
    const [, word, optional] = /^:(\w+)(\??)$/.exec(part) ?? [];
    if (word && asked[place] === undefined && optional) continue;
    if (!word ? part !== asked[place] : !/^[\w.-]+$/.test(asked[place] ?? "")) return null;
    if (word) params[word] = asked[place];
  }
  return params;
}
