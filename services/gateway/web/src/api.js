// REST. Errors carry what to do next, and that is what the reader gets to see.

/** A problem+json answer. */
export class ApiProblem extends Error {
  constructor(status, detail, nextStep) {
    super(`${detail} ${nextStep}`);
    this.status = status;
  }
}

async function call(method, path, body) {
  let response;
  try {
    response = await fetch(`/v1${path}`, {
      method,
      headers: body === undefined ? {} : { "Content-Type": "application/json" },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
  } catch {
    throw new ApiProblem(0, "The gateway does not answer.", "Check that Ambula runs; this page tries again by itself.");
  }
  const answer = await response.json().catch(() => ({}));
  if (!response.ok) {
    const faults = (answer.faults ?? []).map((fault) => `${fault.where}: ${fault.what}.`).join(" ");
    throw new ApiProblem(response.status, `${answer.detail ?? response.statusText} ${faults}`, answer.next_step ?? "");
  }
  return answer;
}

export const get = (path) => call("GET", path);
export const post = (path, body) => call("POST", path, body);
export const put = (path, body) => call("PUT", path, body);
export const remove = (path) => call("DELETE", path);
export const patch = (path, body) => call("PATCH", path, body);
