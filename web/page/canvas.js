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
  const scale = window.devicePixelRatio || 1;
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
  { name: "left", dash: [] },
  { name: "right", dash: [7, 4] },
];

/** A column of points over time: at each pixel the least and the greatest, as more cannot be seen. */
export function drawCurve(pen, points, column, x, y, colour, width) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.beginPath();
  let place = null, least = 0, most = 0;
  const put = () => {
    pen.lineTo(place, y(least));
    if (most > least) pen.lineTo(place, y(most));
  };
  for (const point of points) {
    const [now, value] = [Math.round(x(point[0])), point[column]];
    if (Number.isNaN(value)) continue;
    if (now !== place) {
      if (place !== null) put();
      [place, least, most] = [now, value, value];
    } else if (value < least) least = value;
    else if (value > most) most = value;
  }
  if (place !== null) put();
  pen.stroke();
}
