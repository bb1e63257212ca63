// Short ways to what is on the page.

export const $ = (id) => document.getElementById(id);

/** Writes only what changes: what is read aloud is read once. */
export function write(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.includes("-")) made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

/** Names and values, as a list. */
export const facts = (pairs) => pairs.filter(([, value]) => value).flatMap(([name, value]) => [
  element("dt", {}, name), element("dd", { className: "num" }, value)]);

/** Replaces children only where `key` changes, so that focus and clicks are not lost. */
export function replace(parent, key, make) {
  if (parent.dataset.key === key) return;
  parent.dataset.key = key;
  const focused = parent.contains(document.activeElement) ? document.activeElement.dataset.focus : null;
  parent.replaceChildren(...make());
  if (focused) parent.querySelector(`[data-focus="${CSS.escape(focused)}"]`)?.focus();
}
