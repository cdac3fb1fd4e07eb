// The curves of the last seconds.
import { SIDES, colours, drawCurve, fitted } from "./canvas.js";
import { $, element } from "./dom.js";

export const SPAN_S = 4;
const GUTTER = 46, HEAD = 19, FOOT = 22;

// Title, column, the column that is drawn thin beside it, and the least range with its marks.
const STRIPS = [
  ["Angle of the hair, degrees", 1, 0, [40, 110], 10],
  ["Bending at its root, sensor codes", 2, 3, [0, 16384], 8192],
  ["Touch, 0 to 1", 4, null, [0, 1], 1],
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
    pen.setLineDash(SIDES[side].dash);
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(1, h / 2);
    pen.lineTo(w - 1, h / 2);
    pen.stroke();
  }
}

// The range of a strip: at least its own, and all that is to be seen, up to the next mark.
function range(points, columns, [low, high], mark) {
  let [least, most] = [low, high];
  for (const point of points) {
    for (const column of columns) {
      if (point[column] < least) least = point[column];
      if (point[column] > most) most = point[column];
    }
  }
  return [Math.floor(least / mark) * mark, Math.ceil(most / mark) * mark];
}

/** Draws them; a point has its time, and five values of each side. */
export function drawCurves(canvas, points, sides) {
  const [pen, w, h] = fitted(canvas);
  const end = points.length ? points[points.length - 1][0] : 0;
  const room = (h - FOOT) / STRIPS.length;
  const x = (t) => w - (end - t) * (w - GUTTER) / SPAN_S;
  pen.font = "12px system-ui, sans-serif";
  STRIPS.forEach(([title, column, thin, least, mark], n) => {
    const [top, high] = [n * room + HEAD, room - HEAD - 4];
    const columns = [];
    for (let side = 0; side < sides; side++) {
      for (const at of thin === null ? [column] : [column, thin]) columns.push(1 + 5 * side + at);
    }
    const [from, to] = range(points, columns, least, mark);
    const y = (value) => top + high * (1 - (value - from) / (to - from));
    pen.strokeStyle = colours.line;
    pen.lineWidth = 1;
    pen.strokeRect(GUTTER + 0.5, top, w - GUTTER - 1, high);
    pen.fillStyle = colours.ink;
    pen.textAlign = "left";
    pen.fillText(title, GUTTER, top - 6);
    pen.textAlign = "right";
    pen.fillText(to, GUTTER - 5, top + 9);
    pen.fillText(from, GUTTER - 5, top + high);
    pen.save();
    pen.beginPath();
    pen.rect(GUTTER, top, w - GUTTER, high);
    pen.clip();
    for (let second = Math.ceil(end - SPAN_S); second <= end; second++) {
      pen.beginPath();
      pen.moveTo(x(second), top);
      pen.lineTo(x(second), top + high);
      pen.stroke();
    }
    for (let side = 0; side < sides; side++) {
      pen.setLineDash(SIDES[side].dash);
      const colour = colours[SIDES[side].name];
      if (thin !== null) drawCurve(pen, points, 1 + 5 * side + thin, x, y, colour, 0.8);
      drawCurve(pen, points, 1 + 5 * side + column, x, y, colour, 2);
    }
    pen.restore();
  });
  pen.textAlign = "center";
  for (let second = Math.max(Math.ceil(end - SPAN_S + 0.2), 0); second <= end - 0.15; second++) {
    pen.fillText(`${second} s`, Math.min(x(second), w - 16), h - 6);
  }
}
