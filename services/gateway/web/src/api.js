// @ts-check
// REST. Paths, what they are asked and what they answer are those of openapi.json; `npm run check` compares.
// Errors carry what to do next, and that is what the reader gets to see.

/** @typedef {import("./api_types").Method} Method */
/** @template {Method} M @typedef {import("./api_types").PathOf<M>} PathOf */
/** @template {Method} M @template {PathOf<M>} P @typedef {import("./api_types").Asked<M, P>} Asked */
/** @template {Method} M @template {PathOf<M>} P @typedef {import("./api_types").Answer<M, P>} Answer */

/** A problem+json answer; status 0 when there was none. */
export class ApiProblem extends Error {
  /** @param {number} status @param {string} title @param {string} detail @param {string} nextStep */
  constructor(status, title, detail, nextStep) {
    super(`${detail} ${nextStep}`.trim());
    this.status = status;
    this.title = title;
  }
}

/** Where a wrong password is an answer, not the end of a sign-in. */
const ASKING_THE_PASSWORD = ["/sign-in", "/sign-in/confirmation", "/me/password"];

let onSignedOut = () => {};

/** What to do once nobody is signed in any more. @param {() => void} callback */
export function whenSignedOut(callback) {
  onSignedOut = callback;
}

/** Tell the page that nobody is signed in any more. */
export function signedOut() {
  onSignedOut();
}

/**
 * The address of a path below /v1: parts of it by name, the rest as a query; null and undefined are left out.
 * @param {string} path @param {Record<string, unknown>} [parameters]
 */
export function address(path, parameters = {}) {
  const query = new URLSearchParams();
  const filled = path.replace(/\{(\w+)\}/g, (_, name) => encodeURIComponent(String(parameters[name])));
  for (const [name, value] of Object.entries(parameters)) {
    if (!path.includes(`{${name}}`) && value !== null && value !== undefined) query.set(name, String(value));
  }
  return `/v1${filled}${query.size > 0 ? `?${query}` : ""}`;
}

/** The address of something to download. @template {PathOf<"get">} P @param {P} path @param {Asked<"get", P>} asked */
export const linkTo = (path, ...asked) => address(path, /** @type {Record<string, unknown>} */ (asked[0]));

/** @template {PathOf<"get">} P @param {P} path @param {Asked<"get", P>} asked @returns {Promise<Answer<"get", P>>} */
export const get = (path, ...asked) => call("GET", path, asked[0]);

/** @template {PathOf<"post">} P @param {P} path @param {Asked<"post", P>} asked @returns {Promise<Answer<"post", P>>} */
export const post = (path, ...asked) => call("POST", path, asked[0]);

/** @template {PathOf<"put">} P @param {P} path @param {Asked<"put", P>} asked @returns {Promise<Answer<"put", P>>} */
export const put = (path, ...asked) => call("PUT", path, asked[0]);

/** @template {PathOf<"patch">} P @param {P} path @param {Asked<"patch", P>} asked @returns {Promise<Answer<"patch", P>>} */
export const patch = (path, ...asked) => call("PATCH", path, asked[0]);

/** @template {PathOf<"delete">} P @param {P} path @param {Asked<"delete", P>} asked @returns {Promise<Answer<"delete", P>>} */
export const remove = (path, ...asked) => call("DELETE", path, asked[0]);

/**
 * @param {string} method @param {string} path @param {unknown} wish checked where it is made
 * @returns {Promise<any>}
 */
async function call(method, path, wish) {
  const { body, ...parameters } = /** @type {Record<string, unknown>} */ (wish ?? {});
  const response = await ask(method, address(path, parameters), body);
  const answer = await response.json().catch(() => undefined);
  if (response.ok) return answer;
  if (response.status === 401 && !ASKING_THE_PASSWORD.includes(path)) signedOut();
  throw problemOf(response, answer ?? {});
}

/** @param {string} method @param {string} url @param {unknown} body */
async function ask(method, url, body) {
  try {
    return await fetch(url, {
      method,
      headers: body === undefined ? {} : { "Content-Type": "application/json" },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    const next = "Check that Ambula runs; this page tries again by itself.";
    throw new ApiProblem(0, "No answer", "The gateway does not answer.", next);
  }
}

/** @param {Response} response @param {Partial<import("./api_types").Models["ProblemOut"]>} answer */
function problemOf(response, { title, detail, next_step, faults = [] }) {
  const wrong = faults.map((fault) => `${fault.where}: ${fault.what}.`).join(" ");
  const what = `${detail ?? response.statusText} ${wrong}`.trim();
  return new ApiProblem(response.status, title ?? response.statusText, what, next_step ?? "");
}
