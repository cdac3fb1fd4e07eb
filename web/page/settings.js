// The sliders: keys of the scene that are set in place of its own.
import { $, element } from "./dom.js";

// Key, name, what it does, least, most, step; friction has no value of the scene's own.
export const SLIDERS = [
  ["whisking.gain", "How wide it swings", "How strongly the motor is driven to and fro.", 0, 2, 0.05],
  ["whisking.frequency_hz", "Strokes a second", "Faster ones make the surface sound higher.", 0.5, 10, 0.1],
  ["rcp.gain", "Retreat (RCP)", "How far a touch makes the hair pull back.", 0, 2, 0.05],
  ["cia.gain", "Excitement (CIA)", "How much a touch makes all hairs reach further.", 0, 1.5, 0.05],
  ["plant.friction", "Friction", "How much surfaces hold the tip, in place of their own.", 0, 2, 0.05],
  ["classifier.threshold", "How sure it must be", "The notch on the bars: later and surer, or sooner and "
    + "more often wrong.", 0.5, 0.9995, 0.0005],
];
// What a gate needs besides, where the scene has none.
const BESIDE = { "rcp.gain": "rcp.tau_s=0.125", "cia.gain": "cia.tau_s=0.125" };

export const changes = { set: {} };

/** The lines `key=value` that the core takes, with what a gate needs that `text` lacks. */
export function asked(text, lacks) {
  return Object.entries(changes.set).map(([key, value]) => {
    const line = `${key}=${value}`;
    return BESIDE[key] && lacks(text, key) ? `${line}\n${BESIDE[key]}` : line;
  }).join("\n");
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
      if (start()) return;
      changes.set = before;
      input.value = input.dataset.runs;
    };
  }
}

// Which sliders the scene can take that has no value for them; it depends on the text alone.
const usable = {};
export function look(text, { fault_of, lacks }) {
  for (const [key, , , low, high] of SLIDERS) {
    const beside = BESIDE[key] && lacks(text, key) ? `\n${BESIDE[key]}` : "";
    usable[key] = fault_of(text, `${key}=${(low + high) / 2}${beside}`) === "";
  }
}

export function showSliders(player) {
  for (const [key] of SLIDERS) {
    const value = player.setting(key), input = $(key);
    input.dataset.runs = value ?? input.min;
    if (document.activeElement !== input) input.value = input.dataset.runs;
    // It is the notch on the bars, which a scene without classes has not.
    const hasNone = key === "classifier.threshold" && player.classes().length === 0;
    input.disabled = hasNone || value === undefined && !usable[key];
    const none = key === "plant.friction" ? "each its own" : "off";
    const lacking = usable[key] ? none : "no use here";
    $(`${key}-value`).textContent = value === undefined ? lacking : +value.toFixed(4);
  }
}
