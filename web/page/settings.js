// The sliders: keys of the scene that are set in place of its own.
import { $, element } from "./dom.js";

// Key, name, what it does, least, most, step; friction has no value of the scene's own.
export const SLIDERS = [
  ["whisking.gain", "How wide it swings", "How strongly the motor is driven to and fro.", 0, 2, 0.05],
  ["whisking.frequency_hz", "Strokes a second", "Faster ones make the surface sound higher.", 0.5, 10, 0.1],
  ["rcp.gain", "Retreat (RCP)", "How far a touch makes the hair pull back.", 0, 1.5, 0.05],
  ["cia.gain", "Excitement (CIA)", "How much a touch makes all hairs reach further.", 0, 1.5, 0.05],
  ["plant.friction", "Friction", "How much surfaces hold the tip, in place of their own.", 0, 2, 0.05],
  ["classifier.threshold", "How sure it must be", "The notch on the bars: later and surer, or sooner and "
    + "more often wrong.", 0.5, 0.9995, 0.0005],
];
// What a gate needs besides, where the scene has none.
const BESIDE = { "rcp.gain": "rcp.tau_s=0.125", "cia.gain": "cia.tau_s=0.125" };

export const changes = { set: {}, gates: {} };

/** The lines `key=value` that the core takes. A gate that `player` lacks is the page's from here on. */
export function asked(player) {
  const { set, gates } = changes;
  for (const key of Object.keys(BESIDE)) {
    if (key in set && player && player.setting(key) === undefined) gates[key] = true;
  }
  const all = Object.entries(set).map(([key, value]) => `${key}=${value}`);
  for (const key of Object.keys(gates)) if (key in set) all.push(BESIDE[key]);
  return all.join("\n");
}

/** Makes the sliders; `start` restarts the scene with what is set and says whether it could. */
export function makeSliders(start) {
  for (const [key, name, does, low, high, step] of SLIDERS) {
    const about = element("p", { id: `${key}-about` }, `${does} `, element("code", {}, key));
    const input = element("input", { type: "range", id: key, min: low, max: high, step });
    input.setAttribute("aria-describedby", about.id);
    const row = element("div", { className: "slider" },
      element("label", { htmlFor: key }, name),
      element("output", { id: `${key}-value`, htmlFor: key }), input, about);
    $("sliders").append(row);
    input.oninput = () => {
      const before = { ...changes.set };
      changes.set[key] = Number(input.value);
      if (!start()) changes.set = before;
    };
  }
}

// Which sliders the scene can take that has no value for them; it depends on the text alone.
const usable = {};
export function look(player, text, fault_of) {
  for (const [key, , , low, high] of SLIDERS) {
    const beside = BESIDE[key] && player.setting(key) === undefined ? `\n${BESIDE[key]}` : "";
    usable[key] = fault_of(text, `${key}=${(low + high) / 2}${beside}`) === "";
  }
}

export function showSliders(player) {
  for (const [key] of SLIDERS) {
    const value = player.setting(key), input = $(key);
    if (document.activeElement !== input) input.value = value ?? input.min;
    input.disabled = value === undefined && !usable[key];
    const none = key === "plant.friction" ? "each its own" : "off";
    const lacking = usable[key] ? none : "no use here";
    $(`${key}-value`).textContent = value === undefined ? lacking : +value.toFixed(4);
  }
}
