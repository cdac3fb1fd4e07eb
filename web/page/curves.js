// The curves of the last seconds.
import { SIDES, colours, fitted } from "./canvas.js";
import { SPAN_S, columns, drawCurve, now } from "./columns.js";
import { $, element } from "./dom.js";

const GUTTER = 46, HEAD = 19, FOOT = 22;

// Title, column, the column that is drawn thin beside it, and the least range with its marks.
const STRIPS = [
  ["Angle of the hair, degrees", 1, 0, [40, 110], 10],
  ["Bending at its root, sensor codes", 2, 3, [0, 16384], 8192],
  ["Strength of touch", 4, null, [0, 1], 0.5],
];

export function drawLegend(sides) {
  const sample = (name, dash, width) => {
    const line = element("canvas", { className: "sample", ariaHidden: "true" });
    return [element("li", {}, line, name), line, dash, width];
  };
  const lines = sides > 1
    ? [sample("left hair", 0, 2), sample("right hair", 1, 2)] : [sample("as it is", 0, 2)];
  const thin = sample("thin: the angle that the motor is asked for; bending to the side", 0, 1);
  $("legend").replaceChildren(...[...lines, thin].map(([item]) => item));
  for (const [, canvas, side, width] of [...lines, thin]) {
    const [pen, w, h] = fitted(canvas);
    pen.strokeStyle = colours[SIDES[side].name];
    pen.setLineDash(SIDES[side].dash ? [6, 3] : []);
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(1, h / 2);
    pen.lineTo(w - 1, h / 2);
    pen.stroke();
  }
}

// The range of a strip: at least its own, and all that is to be seen, up to the next mark.
function range(values, [low, high], mark) {
  let [least, most] = [low, high];
  for (const column of columns) {
    for (const k of values) {
      if (column.least[k] < least) least = column.least[k];
      if (column.most[k] > most) most = column.most[k];
    }
  }
  return [Math.floor(least / mark) * mark, Math.ceil(most / mark) * mark];
}

/** Draws them. */
export function drawCurves(canvas, sides) {
  const [pen, w, h] = fitted(canvas);
  const end = now(), room = (h - FOOT) / STRIPS.length;
  const x = (t) => w - (end - t) * (w - GUTTER) / SPAN_S;
  const first = Math.max(Math.ceil(end - SPAN_S), 0);
  pen.font = "12px system-ui, sans-serif";
  STRIPS.forEach(([title, value, thin, least, mark], n) => {
    const [top, high] = [Math.round(n * room) + HEAD, Math.round(room) - HEAD - 4];
    const shown = thin === null ? [[value, 2]] : [[thin, 1], [value, 2]];
    const all = shown.flatMap(([k]) => Array.from({ length: sides }, (_, side) => 1 + 5 * side + k));
    const [from, to] = range(all, least, mark);
    const y = (at) => top + high * (1 - (at - from) / (to - from));
    pen.fillStyle = colours.ink;
    pen.textAlign = "left";
    pen.fillText(title, GUTTER, top - 6);
    pen.textAlign = "right";
    pen.fillText(to, GUTTER - 5, top + 9);
    pen.fillText(from, GUTTER - 5, top + high);
    pen.fillStyle = colours.line;
    for (const edge of [top, top + high]) pen.fillRect(GUTTER, edge, w - GUTTER, 1);
    for (let second = first; second <= end; second++) {
      pen.fillRect(Math.round(Math.max(x(second), GUTTER)), top, 1, high);
    }
    for (let side = 0; side < sides; side++) {
      const colour = colours[SIDES[side].name], { dash } = SIDES[side];
      for (const [k, width] of shown) {
        drawCurve(pen, 1 + 5 * side + k, end - SPAN_S, x, y, { colour, width, dash });
      }
    }
  });
  pen.textAlign = "center";
  pen.fillStyle = colours.ink;
  for (let second = first; second <= end; second++) {
    const at = x(second);
    if (at > GUTTER + 10 && at < w - 14) pen.fillText(`${second} s`, at, h - 6);
  }
}
