// Elements of the page. Text is always set as text, so nothing a file says becomes markup.

/** \param props  properties, "class", data (as "data-name") and listeners ("onclick") */
export function el(tag, props = {}, ...children) {
  const node = tag.startsWith("svg:")
    ? document.createElementNS("http://www.w3.org/2000/svg", tag.slice(4))
    : document.createElement(tag);
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name in node && !tag.startsWith("svg:") && name !== "list") node[name] = value;
    else node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

const group = (text) => text.replace(/\B(?=(\d{3})+$)/g, "\u202f");

export const count = (value) => group(String(Math.round(value)));

/** A number with so many significant digits. */
export function figure(value, digits = 3) {
  if (!Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 10 ** Math.max(digits, 5) || size < 1e-4) return value.toExponential(digits - 1).replaceAll("-", "\u2212").replace("e", "\u2009e").replace("e+", "e");
  return String(Number(value.toPrecision(digits))).replace("-", "\u2212");
}

/** A coordinate of a model of this size, to five digits of the size: more of the number where the model is far from the origin. */
export function coordinate(value, size) {
  const more = Math.ceil(Math.log10(Math.abs(value) / size));
  return figure(value, Math.min(5 + Math.max(more, 0), 17));
}

export const percent = (share, digits = 3) => `${figure(100 * share, digits)}\u2009%`;
