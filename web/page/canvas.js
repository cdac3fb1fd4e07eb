// What the pictures share: their pens, and the colours of the style sheet.

export const colours = {};
export function restyle() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["ink", "faint", "line", "box", "left", "right", "metal"]) {
    colours[name] = style.getPropertyValue(`--${name}`).trim();
  }
}

/** A clean pen with its origin at the upper left, and the size to draw in. */
export function fitted(canvas) {
  // Finer than twice is not seen, and costs a phone its pace.
  const scale = Math.min(window.devicePixelRatio || 1, 2);
  const [w, h] = [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) {
    canvas.width = Math.round(w * scale);
    canvas.height = Math.round(h * scale);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, w, h);
  pen.lineCap = "round";
  return [pen, w, h];
}

/** The two sides: what a line of each is drawn with, as colour alone would not do. */
export const SIDES = [
  { name: "left", dash: false },
  { name: "right", dash: true },
];

const seen = new Map();
let onShown = () => {};
const watcher = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) seen.set(target, isIntersecting);
  if (entries.some((entry) => entry.isIntersecting)) onShown();
});
/** Has it called when a canvas comes onto the screen, where what it shows may be old. */
export function whenShown(call) {
  onShown = call;
}
/** Whether a canvas is on the screen, as far as is known: what is not need not be drawn. */
export function isSeen(canvas) {
  if (!seen.has(canvas)) {
    seen.set(canvas, true);
    watcher.observe(canvas);
  }
  return seen.get(canvas);
}
