// The simulator's core, compressed in the page's own text.
import { $ } from "./dom.js";

export async function load() {
  const packed = Uint8Array.from(atob($("core").textContent.trim()), (c) => c.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  await wasm_bindgen({ module_or_path: await new Response(unpacked).arrayBuffer() });
  return wasm_bindgen;
}
