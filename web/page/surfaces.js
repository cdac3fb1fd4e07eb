// What surfaces look like: a slab with relief, much larger than life.

// Colours of face and body, the relief, its pitch and its depth as shares of the thickness.
const PAPER = "#c9a26b";
const LOOKS = {
  smooth: ["#f4f6fa", "#9fb4cc", "flat", 1, 0],
  aluminium: ["#f5f6f7", "#a9adb3", "brushed", 1, 0],
  vinyl: ["#e7d3b0", "#a98556", "waves", 0.8, 0.24],
  p600: ["#5f5a57", PAPER, "grains", 0.09, 0.09],
  p240: ["#7a4a33", PAPER, "grains", 0.18, 0.16],
  p180: ["#8a4b2d", PAPER, "grains", 0.24, 0.22],
  p80: ["#93462a", PAPER, "grains", 0.34, 0.3],
  p40: ["#7f3420", PAPER, "grains", 0.5, 0.42],
  carpet: ["#3f7d4e", "#2c5636", "loops", 0.26, 0.4],
  "rough-carpet": ["#8d4a72", "#5e2f4c", "loops", 0.5, 0.62],
  tarmac: ["#8b8d90", "#3a3b3e", "stones", 0.62, 0.5],
  hidden: ["#6f6a8a", "#6f6a8a", "flat", 1, 0],
};
const WALL = ["#d8d2c4", "#9a9184", "flat", 1, 0];

// The same numbers between 0 and 1 at each drawing.
const chance = (n) => {
  const x = Math.sin(12.9898 * n + 4.1) * 43758.5453;
  return x - Math.floor(x);
};

/** Draws a slab from x = 0 to `length` and y = 0, where its peaks are, to `thick`. */
export function paint(pen, name, length, thick, outline) {
  const [face, body, relief, pitch, depth] = LOOKS[name] ?? WALL;
  const [step, deep] = [Math.max(pitch * thick, 1.5), depth * thick];
  const count = Math.max(Math.round(length / step), 1);
  const at = (n) => Math.min(n * length / count, length);
  // Under a relief lies the body, under grains and smooth faces first a layer of their colour.
  const layer = (relief === "grains" ? 0.3 : 0.16) * thick;
  pen.fillStyle = face;
  pen.strokeStyle = outline;
  pen.lineWidth = 1;
  pen.beginPath();
  if (relief === "stones" || relief === "loops") {
    for (let n = 0; n < count; n++) {
      const high = relief === "loops" ? deep : deep * (0.6 + 0.4 * chance(n));
      const width = (at(n + 1) - at(n)) / 2;
      pen.moveTo(at(n) + 2 * width, deep);
      pen.ellipse(at(n) + width, deep, width, high, 0, 0, 2 * Math.PI);
    }
  } else {
    pen.moveTo(0, deep + layer);
    for (let n = 0; n < count; n++) {
      if (relief === "grains") {
        pen.lineTo(at(n), deep * (0.5 + 0.5 * chance(n)));
        pen.lineTo(at(n + 0.5), deep * 0.5 * chance(n + 0.5));
      } else if (relief === "waves") {
        pen.lineTo(at(n), deep);
        pen.quadraticCurveTo(at(n + 0.5), -deep, at(n + 1), deep);
      } else {
        pen.lineTo(at(n), 0);
        pen.lineTo(at(n + 1), 0);
      }
    }
    pen.lineTo(length, deep + layer);
    pen.closePath();
  }
  pen.fill();
  pen.stroke();
  const under = relief === "loops" || relief === "stones" ? deep : deep + layer;
  pen.fillStyle = body;
  pen.fillRect(0, under, length, thick - under);
  pen.strokeRect(0, under, length, thick - under);
  if (relief === "brushed") {
    pen.beginPath();
    for (let n = 1; n < 4; n++) {
      pen.moveTo(length * 0.06 * n, thick * (0.15 + 0.22 * n));
      pen.lineTo(length * (1 - 0.09 * n), thick * (0.15 + 0.22 * n));
    }
    pen.stroke();
  }
}
