// The surfaces to lay before the hair, and the game of guessing them.
import { colours } from "./canvas.js";
import { $, element } from "./dom.js";
import { lastDecision } from "./mind.js";
import { paint } from "./surfaces.js";
import { plain } from "./words.js";

const TURNS = "they take turns";
// Of the game: what lies there while it is asked for, and who was right how often.
const game = { on: false, wanted: null, rounds: 0, you: 0, hair: 0 };
const tiles = new Map();
// Of the tiles there are, and who is asked.
let [tilesOf, present] = ["", null];

export const isSecret = () => game.wanted !== null;

function tile(name, words, press) {
  const picture = element("canvas", { width: 128, height: 40, ariaHidden: "true" });
  const made = element("button", {}, picture, element("span", {}, words));
  made.dataset.surface = name;
  made.onclick = press;
  return made;
}

/** Makes a tile for each surface that the scene can lay; `lay` takes a name, or null: in turns. */
export function drawTiles(player, lay) {
  const names = player.textures(), learnt = player.classes();
  present = player;
  $("choose").hidden = $("textures").hidden = names.length === 0;
  $("game").hidden = names.length === 0 || learnt.length === 0;
  // The same ones stay, lest the focus is lost.
  const of = JSON.stringify([names, learnt]);
  if (of === tilesOf) return;
  tilesOf = of;
  tiles.clear();
  tiles.set(null, tile("", TURNS, () => lay(null)));
  for (const name of names) {
    const strange = learnt.length > 0 && !learnt.includes(name);
    const made = tile(name, plain(name), () => (game.on ? guess(present, name) : lay(name)));
    if (strange) made.ariaLabel = `${plain(name)}, never learnt`;
    made.classList.toggle("is-strange", strange);
    tiles.set(name, made);
  }
  $("textures").replaceChildren(...tiles.values());
  paintTiles();
}

export function paintTiles() {
  for (const [name, made] of tiles) {
    const canvas = made.firstChild, pen = canvas.getContext("2d");
    pen.clearRect(0, 0, canvas.width, canvas.height);
    const shown = name === null ? ["smooth", "p240", "carpet"] : [name];
    const width = (canvas.width - 4) / shown.length;
    shown.forEach((each, n) => {
      pen.setTransform(1, 0, 0, 1, 2 + n * width, 2);
      paint(pen, each, width, canvas.height - 4, colours.ink);
    });
    pen.resetTransform();
  }
}

/** Says which one is chosen and which the game leaves out. */
export function showTiles(player, laid) {
  const learnt = player.classes();
  let strange = false;
  for (const [name, made] of tiles) {
    made.hidden = game.on && !learnt.includes(name);
    strange ||= made.classList.contains("is-strange") && !made.hidden;
    if (game.on) made.removeAttribute("aria-pressed");
    else made.ariaPressed = String(name === laid);
  }
  $("strange").hidden = !strange;
}

/** Puts the focus on the first surface that can be named. */
export const focusTiles = () => [...tiles.values()].find((tile) => !tile.hidden)?.focus();

/** Lays one, covered. */
export function ask(player) {
  const choice = player.classes().filter((name) => tiles.has(name));
  game.on = true;
  game.wanted = choice[Math.floor(Math.random() * choice.length)];
  player.lay(game.wanted);
  $("game").textContent = "End the game";
  $("next").hidden = true;
  say("One of these lies there, covered. Look at the curves, or listen, and press the one you feel.");
}

function guess(player, name) {
  if (!isSecret()) return;
  const { wanted } = game, last = lastDecision();
  const heard = player.presented() === wanted && last?.truth === wanted ? last.decision : null;
  game.rounds += 1;
  game.you += name === wanted;
  game.hair += heard === wanted;
  game.wanted = null;
  $("next").hidden = false;
  const you = `You: ${plain(name)} ${name === wanted ? "✓" : "✗"}`;
  const hair = heard === null ? "The hair had not decided yet"
    : `The hair: ${heard === "unknown" ? "unsure ?" : `${plain(heard)} ${heard === wanted ? "✓" : "✗"}`}`;
  say(`It was ${plain(wanted)}. ${you}. ${hair}. You ${game.you} of ${game.rounds}, the hair ${game.hair}.`);
}

function say(text) {
  $("game-said").hidden = false;
  $("game-said").textContent = text;
}

export const isPlayed = () => game.on;

export function endGame() {
  Object.assign(game, { on: false, wanted: null, rounds: 0, you: 0, hair: 0 });
  $("game").textContent = "Guess what it touches";
  $("next").hidden = $("game-said").hidden = true;
}
