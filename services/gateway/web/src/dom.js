// @ts-check
// Building the page from values: text goes in as text, never as markup.

/**
 * @typedef {Node | string | number | null | undefined} Child
 * @typedef {Record<string, unknown> & {
 *   onclick?: (event: MouseEvent & { currentTarget: HTMLElement }) => unknown,
 *   onsubmit?: (event: SubmitEvent) => unknown,
 *   onchange?: (event: Event) => unknown,
 *   oninput?: (event: Event) => unknown,
 * }} Attributes
 */

/**
 * An element with attributes, listeners (onclick: f) and children (elements, text, or null for nothing).
 * @template {keyof HTMLElementTagNameMap} T
 * @param {T} tag @param {Attributes} [attributes] @param {...(Child | Child[])} children
 * @returns {HTMLElementTagNameMap[T]}
 */
export function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  set(node, attributes);
  node.append(...nodesOf(children));
  return node;
}

/**
 * The same for drawings.
 * @template {keyof SVGElementTagNameMap} T
 * @param {T} tag @param {Attributes} [attributes] @param {...(Node | string)} children
 * @returns {SVGElementTagNameMap[T]}
 */
export function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set(node, attributes);
  node.append(...children);
  return node;
}

/** Change the text only when it differs, so that screen readers are not woken for nothing. @param {Node} node @param {string} text */
export function say(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Show an element with a text, or hide it when there is nothing to say. @param {HTMLElement} node @param {string} text */
export function tell(node, text) {
  say(node, text);
  node.hidden = text === "";
}

/**
 * A table with a head; columns whose name ends in # hold numbers. `body` is filled by the caller.
 * @param {string[]} columns @param {HTMLElement} body
 */
export function table(columns, body) {
  const cells = columns.map((name) =>
    name.endsWith("#")
      ? el("th", { scope: "col", class: "number" }, name.slice(0, -1))
      : el("th", { scope: "col" }, name),
  );
  const whole = el("table", {}, el("thead", {}, el("tr", {}, ...cells)), body);
  const scroller = el("div", { class: "scroll" }, whole);
  const sizes = new ResizeObserver(() => letKeysScroll(scroller));
  sizes.observe(scroller);
  sizes.observe(whole);
  return scroller;
}

/** What is wider than its place can be scrolled by the keyboard, too. @param {HTMLElement} scroller */
function letKeysScroll(scroller) {
  if (scroller.scrollWidth > scroller.clientWidth) scroller.tabIndex = 0;
  else scroller.removeAttribute("tabindex");
}

/** Replace everything inside a node. @param {Element} node @param {...(Child | Child[])} children */
export function fill(node, ...children) {
  node.replaceChildren(...nodesOf(children));
}

/** A part of a page under its heading. @param {string} title @param {...(Child | Child[])} children */
export function panel(title, ...children) {
  return el("section", { class: "panel", "aria-label": title }, el("h2", {}, title), ...children);
}

/** @param {(Child | Child[])[]} children @returns {Node[]} */
function nodesOf(children) {
  const nodes = [];
  for (const child of children.flat()) {
    if (child === null || child === undefined) continue;
    nodes.push(child instanceof Node ? child : document.createTextNode(String(child)));
  }
  return nodes;
}

/** @param {Element} node @param {Attributes} attributes */
function set(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), /** @type {EventListener} */ (value));
    else if (value === true) node.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, String(value));
  }
}
