// For experts: what is wrong with a scene, its trace and files.
import { $, element } from "./dom.js";

/** Shows what is wrong, with a way to its line in `text`; nothing if `fault` is empty. */
export function report(fault, text) {
  // A message in a closed part would not be seen.
  if (fault) $("experts").open = true;
  $("problems").replaceChildren(...fault.split("\n").filter(Boolean).map((line) => {
    const found = /^scene:(\d+): (.*)$/s.exec(line);
    if (!found) return element("li", {}, line);
    const to = element("button", {}, `line ${found[1]}`);
    to.onclick = () => {
      const before = text.split("\n").slice(0, found[1] - 1).join("\n").length;
      const from = found[1] > 1 ? before + 1 : 0;
      $("editor").focus();
      $("editor").setSelectionRange(from, from + text.split("\n")[found[1] - 1].length);
    };
    return element("li", {}, to, ` ${found[2]}`);
  }));
}

// The trace of text and sliders, computed in what time the picture leaves, where its hash is seen.
let tracer = null;
export function startTrace(made) {
  if (tracer) tracer.free();
  tracer = made;
  $("hash").textContent = "…";
}
export function traceOn() {
  if (!tracer || !$("experts").open) return;
  const until = performance.now() + 4;
  let ended = false;
  while (!ended && performance.now() < until) ended = tracer.step(250);
  if (ended) {
    $("hash").textContent = tracer.hash();
    tracer.free();
    tracer = null;
  }
}

/** Saves the whole trace of a new tracer that keeps it; the picture goes on meanwhile. */
export async function download(whole) {
  const parts = [];
  for (let ended = false; !ended;) {
    ended = whole.step(5000);
    parts.push(new Blob([whole.bytes()]));
    await new Promise((done) => { setTimeout(done); });
  }
  const href = URL.createObjectURL(new Blob(parts, { type: "text/csv" }));
  element("a", { href, download: "trace.csv" }).click();
  setTimeout(() => URL.revokeObjectURL(href), 10000);
  whole.free();
}

/** Puts the address into the address bar and, if it may, onto the clipboard. */
export async function link(address) {
  history.replaceState(null, "", address);
  try {
    await navigator.clipboard.writeText(location.href);
    $("link").textContent = "Link copied";
  } catch {
    $("link").textContent = "Link is in the address bar";
  }
  setTimeout(() => { $("link").textContent = "Link to this scene"; }, 2000);
}
