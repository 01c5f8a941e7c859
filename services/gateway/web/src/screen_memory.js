// What this browser remembers of how somebody likes a screen: choices, never anything about a person.

/**
 * What was remembered under a name; null for nothing. A browser may forbid a page to keep anything.
 * @param {string} name
 */
export function recall(name) {
  try {
    return localStorage.getItem(`ambula.${name}`);
  } catch {
    return null;
  }
}

/** @param {string} name @param {string} value */
export function remember(name, value) {
  try {
    localStorage.setItem(`ambula.${name}`, value);
  } catch {
    // See above: then nothing is remembered.
  }
}
