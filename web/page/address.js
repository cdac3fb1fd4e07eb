// A scene as the part of the page's address that no server sees.

export function encoded(scene) {
  const bytes = new TextEncoder().encode(JSON.stringify(scene));
  const code = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return `#${code.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/** What an address holds; null if it is empty, an error if it holds no scene. */
export function decoded(hash) {
  if (hash.length < 2) return null;
  const code = atob(hash.slice(1).replaceAll("-", "+").replaceAll("_", "/"));
  const bytes = Uint8Array.from(code, (c) => c.charCodeAt(0));
  const found = JSON.parse(new TextDecoder().decode(bytes));
  if (typeof found?.text !== "string") throw new Error("no scene");
  return found;
}
