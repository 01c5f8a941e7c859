// Building the page from values: text goes in as text, never as markup.

/**
 * An element with attributes, listeners (onclick: f) and children (elements, text, or null for nothing).
 * @param {string} tag @param {Record<string, unknown>} [attributes] @param {...(Node|string|number|null)} children
 */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  set(node, attributes);
  node.append(
    ...children
      .flat()
      .filter((child) => child !== null && child !== undefined)
      .map(asNode),
  );
  return node;
}

/** The same for drawings. */
export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set(node, attributes);
  node.append(...children);
  return node;
}

/** Change the text only when it differs, so that screen readers are not woken for nothing. */
export function say(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** A table with a head; columns whose name ends in # hold numbers. `body` is filled by the caller. */
export function table(columns, body) {
  const cells = columns.map((name) =>
    name.endsWith("#")
      ? el("th", { scope: "col", class: "number" }, name.slice(0, -1))
      : el("th", { scope: "col" }, name),
  );
  return el("div", { class: "scroll" }, el("table", {}, el("thead", {}, el("tr", {}, ...cells)), body));
}

/** Replace everything inside a node. */
export function fill(node, ...children) {
  node.replaceChildren(
    ...children
      .flat()
      .filter((child) => child !== null)
      .map(asNode),
  );
}

function asNode(child) {
  return child instanceof Node ? child : document.createTextNode(String(child));
}

function set(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, String(value));
  }
}

/** A part of a page under its heading. */
export function panel(title, ...children) {
  return el("section", { class: "panel", "aria-label": title }, el("h2", {}, title), ...children);
}
