// Names in plain words: of surfaces, of what can be watched, of decisions.

const SURFACES = {
  smooth: "smooth plastic",
  p600: "fine sandpaper, P600",
  p240: "medium sandpaper, P240",
  carpet: "short carpet",
  "rough-carpet": "long carpet",
  tarmac: "tarmac",
  vinyl: "vinyl floor",
  aluminium: "sheet aluminium",
  p40: "coarsest sandpaper, P40",
  p80: "coarse sandpaper, P80",
  p180: "rough sandpaper, P180",
  obstacle: "a wall",
};

/** A surface or a class; one that has no words of ours is called as it is. */
export const plain = (name) => SURFACES[name] ?? name;

/** Scenes for everybody, in the order of the menu. */
export const PRESETS = [
  ["whisker", "a hair tells four surfaces apart"],
  ["unknown", "a carpet that it never learnt"],
  ["bench-textures", "surfaces held by hand"],
  ["both", "two hairs, left and right"],
  ["rcp", "a hair that touches pulls back"],
  ["cia", "one touch excites both sides"],
  ["free", "four hairs in free air"],
];

/** What a decision says. */
export function spoken({ decision, reason, among }) {
  if (reason === "pose") return "held in a way that I never learnt";
  if (reason === "between") return among.split("|").map(plain).join(" or ");
  return decision === "unknown" ? "nothing I know" : plain(decision);
}

/** What it is worth. */
export function worth(verdict) {
  if (verdict === "right") return "✓ right";
  return verdict === "wrong" ? "✗ wrong" : "? unsure, though it has learnt this one";
}

export const percent = (share) => `${(100 * share).toFixed(share > 0.99 && share < 0.9995 ? 1 : 0)} %`;
