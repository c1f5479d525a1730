/* What the page's data are made of: arrays as base64 of their little-endian bytes. */

function bytes(base64) {
  const text = atob(base64);
  const array = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) array[i] = text.charCodeAt(i);
  return array;
}

/* On a big-endian machine nothing would be right; browsers have none. */
const doubles = (base64) => new Float64Array(bytes(base64).buffer);
const words = (base64) => new Uint16Array(bytes(base64).buffer);

/* A number for people: six digits, none of them an idle zero. */
function plain(x) {
  if (x === 0) return '0';
  if (!isFinite(x)) return '–';
  const size = Math.abs(x);
  return size >= 1e-3 && size < 1e6 ? String(+x.toPrecision(6)) : x.toExponential(4).replace(/\.?0*e/, 'e');
}

function element(name, attributes, parent, text) {
  const made = document.createElement(name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (text !== undefined) made.textContent = text;
  if (parent) parent.appendChild(made);
  return made;
}

function svgElement(name, attributes, parent, text) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (text !== undefined) made.textContent = text;
  if (parent) parent.appendChild(made);
  return made;
}
