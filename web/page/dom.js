// Elements of the page.

export const $ = (id) => document.getElementById(id);

/** A new element. Children that are text stay text: nothing on the page is parsed as HTML. */
export function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}
