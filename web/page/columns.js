// The last seconds of all curves, as columns of a picture: of each the least and the greatest
// value, as more cannot be seen. So a frame costs what is new, not what is shown.

export const SPAN_S = 4;
// About one for each pixel.
const COLUMNS = innerWidth < 800 ? 400 : 1000;
const STEP_S = SPAN_S / COLUMNS, DASH_S = 0.1;

/** The columns, the oldest first: the time of each, and per value the least and the greatest. */
export const columns = [];
export const now = () => (columns.length ? columns[columns.length - 1].end : 0);

/** Takes points in, each a time and five values of each side. */
export function gather(points, sides) {
  const width = 1 + 5 * sides;
  for (let n = 0; n < points.length; n += width) {
    const t = points[n], index = Math.floor(t / STEP_S);
    let last = columns[columns.length - 1];
    if (!last || last.index !== index) {
      const [least, most] = [points.slice(n, n + width), points.slice(n, n + width)];
      last = { index, t: index * STEP_S, end: t, least, most };
      columns.push(last);
      while (columns[0].index < index - COLUMNS) columns.shift();
    }
    last.end = t;
    for (let k = 1; k < width; k++) {
      if (points[n + k] < last.least[k]) last.least[k] = points[n + k];
      if (points[n + k] > last.most[k]) last.most[k] = points[n + k];
    }
  }
}

/** Draws value `k` from the time `from` on; `x` of a time and `y` of a value are pixels. */
export function drawCurve(pen, k, from, x, y, { colour, width, dash }) {
  pen.fillStyle = colour;
  let before = null;
  for (let n = 0; n < columns.length; n++) {
    const { t, least, most } = columns[n];
    if (t < from || Number.isNaN(least[k])) continue;
    let [low, high] = [least[k], most[k]];
    // No gap to the column before.
    if (before && low > before.most[k]) low = before.most[k];
    if (before && high < before.least[k]) high = before.least[k];
    before = columns[n];
    if (dash && t % DASH_S > 0.6 * DASH_S) continue;
    const left = Math.round(x(t)), right = Math.round(x(columns[n + 1]?.t ?? t + STEP_S));
    const top = Math.round(y(high) - width / 2);
    pen.fillRect(left, top, Math.max(right - left, 1), Math.max(Math.round(y(low) - y(high)), 0) + width);
  }
}
