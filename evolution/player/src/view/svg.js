// Small things to build a page from.

const SVG = "http://www.w3.org/2000/svg";

/** An SVG element with attributes, added to `parent`. */
export function svg(parent, name, attributes = {}) {
  const element = parent.ownerDocument.createElementNS(SVG, name);
  set(element, attributes);
  parent.append(element);
  return element;
}

/** An HTML element with attributes and text, added to `parent`. */
export function html(parent, name, attributes = {}, text = "") {
  const element = parent.ownerDocument.createElement(name);
  set(element, attributes);
  if (text) element.textContent = text;
  parent.append(element);
  return element;
}

/** Set attributes; only what has changed is written, as a browser lays out anew what is. */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    const text = String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
  }
}

/** Set an element's text, if it is another. */
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
