// The page: one scene, played, and what a person does with it.
import { decoded, encoded } from "./address.js";
import { isSeen, restyle, whenShown } from "./canvas.js";
import { columns, gather } from "./columns.js";
import { load } from "./core.js";
import { drawCurves, drawLegend } from "./curves.js";
import { $ } from "./dom.js";
import { download, link, report, startTrace, traceOn } from "./experts.js";
import { clearMind, decide, drawMind } from "./mind.js";
import { SLIDERS, asked, changes, look, makeSliders, showSliders } from "./settings.js";
import { hear, listen, sounds } from "./sound.js";
import { drawStage, restage } from "./stage.js";
import { ask, drawTiles, endGame, focusTiles, isPlayed, isSecret, paintTiles, showTiles } from "./tiles.js";
import { PRESETS } from "./words.js";

const begun = performance.now();
const { Player, Tracer, scenes, scene_text, fault_of, lacks } = await load();
const still = matchMedia("(prefers-reduced-motion: reduce)");

let text = scene_text("whisker"), looked = null;
let player = null, laid = null, playing = !still.matches;
let sides = 1, owed = 0, stale = true;

// Restarts the scene as text and sliders say; after an error the last scene stays.
function start() {
  const keys = asked(text, lacks);
  let next;
  try {
    next = new Player(text, keys);
  } catch (fault) {
    report(String(fault), text);
    showMenus();
    return false;
  }
  report("", text);
  if (player) player.free();
  player = next;
  if (!player.textures().includes(laid)) laid = null;
  if (laid) player.lay(laid);
  player.listen(sounds());
  sides = player.obstacles().length;
  if (text !== looked) look(text, { fault_of, lacks });
  looked = text;
  columns.length = 0;
  [owed, stale] = [0, true];
  endGame();
  clearMind(player);
  restage(player);
  drawTiles(player, lay);
  showTiles(player, laid);
  drawLegend(sides);
  showSliders(player);
  showMenus();
  startTrace(new Tracer(text, keys, false));
  return true;
}

// The menus name the scene that runs; "" stands for one that is not on the page.
function showMenus() {
  const name = scenes().find((each) => scene_text(each) === text) ?? "";
  $("scene").value = name;
  $("preset").value = PRESETS.some(([each]) => each === name) ? name : "";
}

function advance(ticks) {
  gather(player.step(ticks), sides);
  decide(player, sides);
  const speed = Number($("speed").value);
  if (sounds()) hear(player.heard(), player.tick_hz() * speed, speed);
  stale = true;
}

function draw() {
  const shown = isSecret() ? "hidden" : player.presented();
  if (isSeen($("whisker"))) drawStage($("whisker"), player, shown);
  if (isSeen($("strips"))) drawCurves($("strips"), sides);
  drawMind(player, isSecret(), playing);
  stale = false;
}

// Frames a second, and the core's share of them, for measurements.
const measured = { frames: 0, firstFrame: 0, ticks: 0, coreMs: 0 };
window.whisker = measured;
let last = null;
function frame(now) {
  const passed = last === null ? 0 : Math.min(now - last, 100);
  last = now;
  if (playing) {
    owed += passed / 1000 * player.tick_hz() * Number($("speed").value);
    const ticks = Math.floor(owed);
    owed -= ticks;
    const before = performance.now();
    if (ticks > 0) advance(ticks);
    measured.coreMs += performance.now() - before;
    measured.ticks += ticks;
  }
  if (stale) draw();
  traceOn();
  if (!measured.frames) {
    measured.firstFrame = performance.now();
    document.documentElement.dataset.ready = "yes";
  }
  measured.frames += 1;
  requestAnimationFrame(frame);
}

function play(on) {
  playing = on;
  $("play").textContent = on ? "Pause" : "Play";
  stale = true;
}

function edited(next) {
  text = next;
  changes.set = {};
  $("editor").value = text;
  return start();
}

function lay(name) {
  if (name === null) {
    laid = null;
    start();
    return;
  }
  laid = name;
  player.lay(name);
  showTiles(player, laid);
}

function fromAddress() {
  let found;
  try {
    found = decoded(location.hash);
  } catch {
    report("The address has no scene that can be read.", text);
  }
  if (!found) return false;
  laid = typeof found.laid === "string" ? found.laid : null;
  text = found.text;
  $("editor").value = text;
  changes.set = {};
  for (const [key] of SLIDERS) {
    const value = Number(found.set?.[key] ?? NaN);
    if (Number.isFinite(value)) changes.set[key] = value;
  }
  return start();
}

function chosen(name) {
  if (name === "") return;
  laid = null;
  edited(scene_text(name));
}
$("preset").append(...PRESETS.map(([name, words]) => new Option(words, name)),
  new Option("another scene: see For experts", ""));
$("scene").append(...scenes().map((name) => new Option(name, name)),
  new Option("of your own, or linked", ""));
$("preset").onchange = () => chosen($("preset").value);
$("scene").onchange = () => chosen($("scene").value);
makeSliders(start);
$("own").onclick = () => { laid = null; edited(text); };

$("game").onclick = () => {
  if (isPlayed()) {
    endGame();
    lay(null);
    return;
  }
  play(true);
  ask(player);
  showTiles(player, null);
  stale = true;
};
$("next").onclick = () => { ask(player); focusTiles(); stale = true; };
$("sound").onclick = () => {
  listen(!sounds());
  player.listen(sounds());
  $("sound").ariaPressed = String(sounds());
};

let typing;
$("editor").oninput = () => {
  clearTimeout(typing);
  typing = setTimeout(() => { text = $("editor").value; start(); }, 250);
};
const forward = () => { play(false); advance(Math.round(player.tick_hz() / 100)); };
$("play").onclick = () => play(!playing);
$("step").onclick = forward;
$("restart").onclick = start;
$("link").onclick = () => link(encoded({ text, ...changes, laid }));
$("download").onclick = async () => {
  try {
    await download(new Tracer(text, asked(text, lacks), true));
  } catch (fault) {
    report(String(fault), text);
  }
};
document.addEventListener("keydown", (event) => {
  const busy = event.target.matches("textarea, input, select");
  if (busy || event.ctrlKey || event.metaKey || event.altKey) return;
  const presses = event.target.matches("button, summary");
  if (event.key === " " && !presses) { play(!playing); event.preventDefault(); }
  if (event.key === "ArrowRight") { forward(); event.preventDefault(); }
});
const repaint = () => {
  restyle();
  if (player) {
    paintTiles();
    drawLegend(sides);
  }
  stale = true;
};
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
still.addEventListener("change", () => play(!still.matches));
whenShown(() => { stale = true; });
window.addEventListener("resize", () => { stale = true; });
window.addEventListener("hashchange", fromAddress);

repaint();
play(playing);
edited(text);
fromAddress();
measured.core = performance.now() - begun;
requestAnimationFrame(frame);
