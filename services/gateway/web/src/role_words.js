// @ts-check
// Roles in words, and what each of them is for.

/** @typedef {import("./api_types").Models["Role"]} Role */

/** @type {Record<Role, string>} */
export const ROLES = { viewer: "Viewer", therapist: "Therapist", admin: "Administrator", service: "Machine" };

/** @type {Record<Role, string>} */
export const ROLE_MEANINGS = {
  viewer: "reads patients and sessions of the clinic",
  therapist: "also starts sessions, registers patients and knows their names",
  admin: "also manages accounts, devices, keys, the audit and erasure",
  service: "a program with a key",
};
