// The picture of motors, hairs and surfaces.
import { SIDES, colours, fitted } from "./canvas.js";
import { drawCurve, now } from "./columns.js";
import { paint } from "./surfaces.js";
import { plain } from "./words.js";

// Numbers of a body: angle, length, contact, the points where it touches, and its points.
const POINTS = 13, TOUCHES = 2, FIRST = 3, BODY = FIRST + 3 * (TOUCHES + POINTS);
// The angle that is drawn level, so that the picture is wide and low.
const LEVEL_DEG = 84;
// Half the length of a surface and its thickness, as shares of the hair's length.
const HALF = 0.34, THICK = 0.17;
const MOTOR = 24, LABEL = 18;
// Of a side with several hairs, in pixels: the radius of a root, one to the next from the front at
// most, and a row behind the one above it.
const ROOT = 7, PITCH = 14, ROW = 8;
// What one of several touches, as a share of what one alone does.
const PAD = 0.15;
// The least radius of a bar, in pixels.
const LEAST_RADIUS = 4;
// The height of the curve at the lower edge as a share, and the time that it shows.
const FEEL = 0.18, FEEL_S = 1.5;

const turned = (angle_deg) => (angle_deg - LEVEL_DEG + 90) * Math.PI / 180;
const along = (angle) => [Math.sin(angle), Math.cos(angle)];

// The angles between which the hairs have moved in this scene.
const LEAST = { low: 68, high: 105 };
const swing = { ...LEAST };
export function restage(player) {
  const walls = Array.from(player.obstacles()).filter(Number.isFinite);
  swing.low = LEAST.low;
  swing.high = Math.max(LEAST.high, ...walls);
}

// How far everything reaches outwards, up and down, in lengths of a hair.
function extent(walls, slant, reach) {
  const points = [[0, 0]];
  for (let angle = swing.low; angle <= swing.high + 4; angle += 5) points.push(along(turned(angle)));
  for (const wall of walls.filter(Number.isFinite)) {
    const [tip, way] = [along(turned(wall)).map((c) => c * reach), along(turned(wall) - slant)];
    for (const half of [-HALF, HALF]) {
      for (const thick of [0, THICK]) {
        points.push([tip[0] + half * way[0] + thick * way[1], tip[1] + half * way[1] - thick * way[0]]);
      }
    }
  }
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return { out: Math.max(...xs), up: -Math.min(...ys), down: Math.max(...ys) };
}

function label(pen, w, text, x, y) {
  const half = pen.measureText(text).width / 2;
  pen.fillStyle = colours.ink;
  pen.fillText(text, Math.min(Math.max(x, half + 4), w - half - 4), y);
}

// A slab from where its body begins to where it ends, along x; what ends is round there.
function drawBody(pen, shown, [begins, ends, radius], most) {
  const isRound = Number.isFinite(begins) || Number.isFinite(ends);
  const r = isRound ? Math.max(radius, LEAST_RADIUS) : 0;
  const from = Math.max(begins - r, -most), to = Math.min(ends + r, most);
  const thick = isRound ? 2 * r : most * THICK / HALF;
  pen.translate(from, 0);
  if (!isRound) return paint(pen, shown, to - from, thick, colours.ink);
  const [left, right] = [begins, ends].map((end) => Number.isFinite(end) ? r : 0);
  const shape = new Path2D();
  shape.roundRect(0, 0, to - from, thick, [left, right, right, left]);
  pen.clip(shape);
  paint(pen, shown, to - from, thick, colours.ink);
  pen.lineWidth = 2;
  pen.stroke(shape);
}

// A smooth curve through the points, a Catmull-Rom spline, thinner towards the tip.
function drawShaft(pen, shaft, thick) {
  for (let k = 1; k < POINTS; k++) {
    const from = shaft[k - 1], to = shaft[k];
    const before = shaft[Math.max(k - 2, 0)], after = shaft[Math.min(k + 1, POINTS - 1)];
    const leaving = from.map((value, axis) => value + (to[axis] - before[axis]) / 6);
    const coming = to.map((value, axis) => value - (after[axis] - from[axis]) / 6);
    pen.lineWidth = thick * (5 - 3.8 * k / (POINTS - 1));
    pen.beginPath();
    pen.moveTo(...from);
    pen.bezierCurveTo(...leaving, ...coming, ...to);
    pen.stroke();
  }
}

// Seen along its axis: housing, rotor, and the holder with magnet and sensor at the hair's root.
function drawMotor(pen, x, y, ways) {
  pen.fillStyle = colours.metal;
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.roundRect(x - MOTOR, y - MOTOR, 2 * MOTOR, 2 * MOTOR, 8);
  pen.fill();
  pen.stroke();
  pen.beginPath();
  pen.arc(x, y, 0.66 * MOTOR, 0, 2 * Math.PI);
  pen.stroke();
  pen.lineWidth = 11;
  for (const [dx, dy] of ways) {
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x + 0.8 * MOTOR * dx, y + 0.8 * MOTOR * dy);
    pen.stroke();
  }
}

// The root of one hair of several: the number of its board, or its own; filled once it has decided.
function drawRoot(pen, [x, y], number, said) {
  pen.fillStyle = said ? colours.ink : colours.metal;
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.5;
  pen.beginPath();
  pen.arc(x, y, ROOT, 0, 2 * Math.PI);
  pen.fill();
  pen.stroke();
  pen.fillStyle = said ? colours.box : colours.ink;
  pen.font = "600 10px system-ui, sans-serif";
  pen.textAlign = "center";
  pen.fillText(number, x, y + 3.5);
  pen.font = "600 14px system-ui, sans-serif";
}

// What its sensor reads while it does this.
function drawFeeling(pen, w, h, high, sides) {
  const left = 66, end = now();
  pen.fillStyle = colours.ink;
  pen.textAlign = "left";
  pen.fillText("it feels", 8, h - high / 2 + 5);
  const x = (t) => w - 6 - (end - t) * (w - 6 - left) / FEEL_S;
  const y = (code) => h - 4 - (high - 6) * code / 16383;
  for (let side = 0; side < sides; side++) {
    const { name, dash } = SIDES[side];
    drawCurve(pen, 3 + 5 * side, end - FEEL_S, x, y, { colour: colours[name], width: 2, dash });
  }
}

/** Draws it; `shown` is the name of what lies there, or "hidden". */
export function drawStage(canvas, player, shown) {
  const [pen, w, whole] = fitted(canvas);
  const feel = FEEL * whole, h = whole - feel;
  pen.font = "600 14px system-ui, sans-serif";
  const bodies = player.bodies(), walls = Array.from(player.obstacles());
  const each = player.whiskers_per_side(), sides = walls.length;
  const stands = player.stands(), said = each > 1 ? player.said() : [];
  const rows = 1 + Math.max(...stands.filter((_, n) => n % 3 === 1));
  const pitch = Math.min(PITCH, 0.5 * h / each), spread = pitch * (each - 1) / 2;
  // How far behind the middle a hair stands, and towards the other side, in pixels.
  const behind = (n) => pitch * (stands[3 * n] * rows + stands[3 * n + 1]) - spread;
  const inwards = (n) => ROW * stands[3 * n + 1];
  drawFeeling(pen, w, whole, feel, sides);
  pen.textAlign = "center";
  for (let n = 0; n < bodies.length; n += BODY) {
    swing.low = Math.min(swing.low, bodies[n]);
    swing.high = Math.max(swing.high, bodies[n]);
  }
  const longest = Math.max(...bodies.filter((_, n) => n % BODY === 1));
  const [slant, tilt] = Array.from(player.facing_deg(), (angle) => angle * Math.PI / 180);
  const [touchesAt, ...outline] = player.outline();
  const { out, up, down } = extent(walls, slant, touchesAt);
  // A hair's length, in pixels.
  const apart = sides > 1 ? 2 * Math.max(MOTOR, rows * ROW + ROOT) + 6 : 0;
  const wide = (w - 2 * MOTOR - apart - 12) / (sides * out);
  const size = Math.min(wide, (h - LABEL - 8 - 2 * spread) / (up + Math.max(down, 0.25)));
  const reach = size / longest;
  const middle = sides > 1 ? w / 2 : (w + size * out) / 2 - MOTOR / 2;
  const y0 = LABEL + 4 + Math.max(up * size + spread, (h - LABEL - 8 - (down - up) * size) / 2);
  const drawRoots = (side, at) => {
    for (let n = (side + 1) * each - 1; n >= side * each; n--) {
      const board = stands[3 * n + 2];
      drawRoot(pen, at(n), board < 0 ? n - side * each + 1 : board, said[n]);
    }
  };
  for (let side = 0; side < sides; side++) {
    const way = side === 0 ? -1 : 1, x0 = middle + way * apart / 2;
    // Where a point of a hair is drawn: s along an angle from its root, and x against protraction.
    const at = (n, angle, s, x = 0) => [
      x0 + way * (reach * (s * Math.sin(angle) - x * Math.cos(angle)) - inwards(n)),
      y0 + reach * (s * Math.cos(angle) + x * Math.sin(angle)) + behind(n),
    ];
    for (let n = side * each; Number.isFinite(walls[side]) && n < (side + 1) * each; n++) {
      // Its section where the hair touches, or where the tip is: it leans, and the hair slides
      // aside.
      const limit = turned(walls[side]), share = each > 1 ? PAD : 1;
      const body = bodies.subarray(BODY * n, BODY * (n + 1));
      const aside = Number.isNaN(body[FIRST + 1]) ? body[BODY - 2] : body[FIRST + 1];
      const back = aside * Math.tan(tilt) * reach;
      const [dx, dy] = along(limit - slant);
      let [x, y] = at(n, limit, touchesAt * longest);
      x -= way * back * dy;
      y += back * dx;
      pen.save();
      pen.transform(way * dx, dy, way * dy, -dx, x, y);
      drawBody(pen, shown, outline.map((far) => far * reach), share * HALF * size);
      pen.restore();
      // Before the first tick nothing is laid yet.
      if (n === 0 && shown !== "free") {
        const name = shown === "hidden" ? "surface: ?" : `surface: ${plain(shown)}`;
        const over = (HALF * Math.abs(dy) + THICK * dx) * size + 6;
        // Between both, where there are two.
        label(pen, w, name, sides > 1 ? w / 2 : x, sides > 1 ? LABEL : Math.max(y - over, LABEL - 3));
      }
    }
    pen.strokeStyle = colours[SIDES[side].name];
    const ways = [], thick = each > 1 ? 0.5 : 1;
    for (let n = side * each; n < (side + 1) * each; n++) {
      const body = bodies.subarray(BODY * n, BODY * (n + 1));
      const theta = turned(body[0]);
      ways.push([way * Math.sin(theta), Math.cos(theta)]);
      // First those of contact, then the shaft's.
      const point = (k) => at(n, theta, body[FIRST + 2 + 3 * k], body[FIRST + 3 * k]);
      drawShaft(pen, Array.from({ length: POINTS }, (_, k) => point(TOUCHES + k)), thick);
      for (let k = 0; k < TOUCHES; k++) {
        if (Number.isNaN(body[FIRST + 3 * k])) continue;
        pen.beginPath();
        pen.arc(...point(k), thick * (4 + 10 * Math.min(body[2], 1)), 0, 2 * Math.PI);
        pen.lineWidth = 2;
        pen.stroke();
      }
    }
    if (each === 1) drawMotor(pen, x0, y0, ways);
    else drawRoots(side, (n) => at(n, 0, 0));
    label(pen, w, sides > 1 ? SIDES[side].name : "motor", x0, y0 + spread + MOTOR + 16);
  }
  if (sides === 1) {
    const [dx, dy] = along(turned(swing.low));
    label(pen, w, "hair", middle - 0.5 * size * dx, Math.min(y0 + 0.5 * size * dy + 22, h - 6));
  }
}
