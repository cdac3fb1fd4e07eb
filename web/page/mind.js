// What the classifier believes and decides.
import { $, element } from "./dom.js";
import { percent, plain, spoken, worth } from "./words.js";

const LISTED = 6;
const MARKS = { right: "✓", wrong: "✗", refused: "?" };
const mind = { counts: {}, last: null, top: null, before: null, rows: [] };

/** Written only where it changed, so that a screen reader reads it once. */
export function write(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}

export const lastDecision = () => mind.last;

/** Before the first decision of a scene. */
export function clearMind(player) {
  const classes = player.classes();
  mind.counts = { right: 0, wrong: 0, refused: 0 };
  [mind.last, mind.top, mind.before] = [null, null, null];
  $("minds").hidden = $("verdict").hidden = classes.length === 0;
  const threshold = player.threshold();
  mind.rows = classes.map((name) => {
    const [fill, number] = [element("i", {}), element("output", {})];
    const bar = element("div", { className: "track" }, fill);
    if (threshold !== undefined) {
      const notch = element("b", { className: "notch" });
      notch.style.left = `${100 * threshold}%`;
      bar.append(notch);
    }
    number.ariaLabel = plain(name);
    const row = element("div", { className: "bar-row" }, element("span", {}, plain(name)), bar, number);
    return { fill, number, row };
  });
  $("bars").replaceChildren(...mind.rows.map(({ row }) => row));
  $("decisions").replaceChildren();
}

/** Takes the core's lines of decisions in. Samples of several hairs are no time. */
export function decide(player, sides) {
  const [tick_hz, together] = [player.tick_hz(), player.decides_together()];
  for (const line of player.decisions()) {
    const [t, whisker, decision, posterior, samples, truth, verdict, reason, among, touch] = line.split("\t");
    const made = { decision, truth, verdict, reason, among, sure: Number(posterior) };
    mind.counts[verdict] += 1;
    mind.last = { ...made, felt: together ? `${samples} readings`
      : `${Math.round(1000 * Number(samples) / tick_hz)} ms of touch` };
    // One line for all decisions of a touch that say the same.
    const key = [whisker, touch, truth, decision, among].join();
    if (mind.top?.key === key) {
      mind.top.times += 1;
      mind.top.again.textContent = ` × ${mind.top.times}`;
      continue;
    }
    const where = sides > 1 || whisker.includes(" ") ? ` ${whisker}` : "";
    const again = element("span", {});
    const said = `${MARKS[verdict]} ${Number(t).toFixed(1)} s${where}: ${spoken(made)}`;
    $("decisions").prepend(element("li", { className: `is-${verdict}` }, said, again));
    mind.top = { key, times: 1, again };
    while ($("decisions").children.length > LISTED) $("decisions").lastChild.remove();
  }
}

/** Writes beliefs and verdict; a `secret` one stays covered. Before a decision it feels, if it plays. */
export function drawMind(player, secret, playing) {
  const now = player.presented();
  // What was said of another surface says nothing of this one.
  if (now !== mind.before) mind.last = mind.last?.truth === now ? mind.last : null;
  mind.before = now;
  const { last, counts } = mind;
  player.posteriors().forEach((share, n) => {
    const row = mind.rows[n], text = secret ? "?" : percent(share);
    if (text === row.text) return;
    row.text = text;
    row.fill.style.transform = `scaleX(${secret ? 0 : share})`;
    row.number.textContent = text;
  });
  $("decisions").hidden = $("score").hidden = secret;
  const covered = last ? "It has decided. You?" : "It is feeling…";
  write("said", secret ? covered : last ? spoken(last) : playing ? "feeling…" : "press Play");
  // Of a decision that names nothing the posterior is that of the class that came nearest.
  const named = last && last.decision !== "unknown";
  const sure = named ? ` · ${percent(last.sure)} sure · after ${last.felt}` : "";
  write("judged", last && !secret ? worth(last.verdict) + sure : "");
  $("judged").className = last && !secret ? `is-${last.verdict}` : "";
  write("score", `${counts.right} right, ${counts.wrong} wrong, ${counts.refused} unsure`);
}
