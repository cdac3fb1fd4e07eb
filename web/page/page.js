"use strict";
(async () => {
  const begun = performance.now();
  const $ = (id) => document.getElementById(id);
  const packed = Uint8Array.from(atob($("core").textContent.trim()), (c) => c.charCodeAt(0));
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const core = await new Response(unpacked).arrayBuffer();
  await wasm_bindgen({ module_or_path: core });
  const { Player, Tracer, scenes, scene_text, textures, meaning, fault_of } = wasm_bindgen;

  // Least, most, step; friction has no value of the scene's own.
  const SLIDERS = [
    ["whisking.gain", "Gain", 0, 2, 0.05],
    ["whisking.frequency_hz", "Frequency, Hz", 0.5, 10, 0.1],
    ["rcp.gain", "Retreat (RCP)", 0, 1.5, 0.05],
    ["cia.gain", "Excitation (CIA)", 0, 1.5, 0.05],
    ["plant.friction", "Friction", 0, 2, 0.05],
    ["classifier.threshold", "Threshold", 0.5, 0.9995, 0.0005],
  ];
  // What a gate needs besides, where the scene has none.
  const BESIDE = { "rcp.gain": "rcp.tau_s=0.125", "cia.gain": "cia.tau_s=0.125" };
  const SPAN_S = 4;
  const still = matchMedia("(prefers-reduced-motion: reduce)");

  let text = scene_text("whisker");
  let set = {};
  let player = null, tracer = null, laid = null;
  let playing = !still.matches, points = [], sides = 1, width = 6;
  let right = 0, wrong = 0, unknown = 0, owed = 0, stale = true, looked = null;

  // A gate that the last player had from here on counts as given by the page.
  const gates = {};
  const asked = () => {
    for (const key of Object.keys(BESIDE)) {
      if (key in set && player && player.setting(key) === undefined) gates[key] = true;
    }
    const all = Object.entries(set).map(([key, value]) => `${key}=${value}`);
    for (const key of Object.keys(gates)) if (key in set) all.push(BESIDE[key]);
    return all.join("\n");
  };

  // Which sliders the scene can take that has no value for them; it depends on the text alone.
  const usable = {};
  function look() {
    for (const [key, , low, high] of SLIDERS) {
      const beside = BESIDE[key] && player.setting(key) === undefined ? `\n${BESIDE[key]}` : "";
      usable[key] = fault_of(text, `${key}=${(low + high) / 2}${beside}`) === "";
      $(key).closest(".slider").title = usable[key] ? meaning(key) : "This scene has no use for it.";
    }
  }

  // What is wrong, with a way to its line.
  function tell(fault) {
    $("problems").replaceChildren(...fault.split("\n").filter(Boolean).map((line) => {
      const item = document.createElement("li");
      const found = /^scene:(\d+): (.*)$/s.exec(line);
      if (!found) {
        item.textContent = line;
        return item;
      }
      const to = document.createElement("button");
      to.textContent = `line ${found[1]}`;
      to.onclick = () => {
        const before = text.split("\n").slice(0, found[1] - 1).join("\n").length;
        const from = found[1] > 1 ? before + 1 : 0;
        $("editor").focus();
        $("editor").setSelectionRange(from, from + text.split("\n")[found[1] - 1].length);
      };
      item.append(to, `: ${found[2]}`);
      return item;
    }));
  }

  // Restarts the scene as text and sliders say; after an error the last scene stays.
  function start() {
    let next;
    const keys = asked();
    try {
      next = new Player(text, keys);
    } catch (fault) {
      tell(String(fault));
      return false;
    }
    tell("");
    if (player) player.free();
    player = next;
    if (laid) player.lay(laid);
    sides = player.obstacles().length;
    width = 1 + 5 * sides;
    if (text !== looked) look();
    looked = text;
    points = [];
    [right, wrong, unknown, owed] = [0, 0, 0, 0];
    $("decisions").replaceChildren();
    trace(keys);
    show();
    stale = true;
    return true;
  }

  // The trace of text and sliders, computed in what time the picture leaves.
  function trace(keys) {
    if (tracer) tracer.free();
    tracer = new Tracer(text, keys, false);
    $("hash").textContent = "…";
  }
  function traceOn() {
    if (!tracer) return;
    const until = performance.now() + 4;
    let ended = false;
    while (!ended && performance.now() < until) ended = tracer.step(250);
    if (ended) {
      $("hash").textContent = tracer.hash();
      tracer.free();
      tracer = null;
    }
  }

  function show() {
    for (const [key] of SLIDERS) {
      const value = player.setting(key);
      const input = $(key);
      if (document.activeElement !== input) input.value = value ?? input.min;
      input.disabled = value === undefined && !usable[key];
      const none = key === "plant.friction" && usable[key] ? "own" : "–";
      $(`${key}-value`).textContent = value === undefined ? none : +value.toFixed(4);
    }
    $("textures").hidden = !player.has_textures();
    $("bars").replaceChildren(...player.classes().map((name) => {
      const row = document.createElement("div");
      row.className = "bar-row";
      const bar = document.createElement("div");
      bar.append(document.createElement("i"));
      row.append(name, bar, document.createElement("output"));
      return row;
    }));
  }

  function advance(ticks) {
    const more = player.step(ticks);
    for (let n = 0; n < more.length; n += width) points.push(more.subarray(n, n + width));
    const hz = player.tick_hz() / 4;
    if (points.length > SPAN_S * hz) points.splice(0, points.length - SPAN_S * hz);
    for (const line of player.decisions()) {
      const [t, side, decision, posterior, samples, truth, words] = line.split("\t");
      const item = document.createElement("li");
      const verdict = decision === "unknown" ? "unknown" : decision === truth ? "right" : "wrong";
      if (verdict === "right") right += 1;
      else if (verdict === "wrong") wrong += 1;
      else unknown += 1;
      item.className = `is-${verdict}`;
      const where = sides > 1 ? ` ${side}` : "";
      item.textContent = `${t} s${where}: ${words} (${posterior}, ${samples} samples)`;
      $("decisions").prepend(item);
      while ($("decisions").children.length > 30) $("decisions").lastChild.remove();
    }
    stale = true;
  }

  function fitted(canvas) {
    const scale = window.devicePixelRatio || 1;
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    if (canvas.width !== Math.round(w * scale) || canvas.height !== Math.round(h * scale)) {
      canvas.width = Math.round(w * scale);
      canvas.height = Math.round(h * scale);
    }
    const pen = canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, w, h);
    return [pen, w, h];
  }
  let colours = {};
  function restyle() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ["ink", "faint", "line", "left", "right", "surface"]) {
      colours[name] = style.getPropertyValue(`--${name}`).trim();
    }
    stale = true;
  }

  // Numbers of a body: angle, length, contact, the point where it touches, and its points.
  const POINTS = 13, BODY = 6 + 3 * POINTS;

  // Forward is up; the shaft is a smooth curve through its points.
  function drawWhiskers() {
    const [pen, w, h] = fitted($("whisker"));
    const bodies = player.bodies(), limits = player.obstacles(), each = player.whiskers_per_side();
    const longest = Math.max(...bodies.filter((_, n) => n % BODY === 1));
    const [slant, tilt] = Array.from(player.facing_deg(), (angle) => angle * Math.PI / 180);
    const reach = Math.min(sides > 1 ? w / 2 - 20 : w - 50, h / 1.25) / longest;
    const base = sides > 1 ? w / 2 : w - 30;
    const y0 = h * 0.62;
    pen.lineCap = "round";
    for (let side = 0; side < sides; side++) {
      const way = side === 0 ? -1 : 1, x0 = base + way * 8;
      // Where a point is drawn: s along an angle from the base, and x against protraction.
      const at = (angle, s, x = 0) => [
        x0 + way * reach * (s * Math.sin(angle) - x * Math.cos(angle)),
        y0 + reach * (s * Math.cos(angle) + x * Math.sin(angle)),
      ];
      if (Number.isFinite(limits[side])) {
        // Its section where the whisker touches, or where the tip is: it leans, and the whisker
        // slides aside.
        const limit = limits[side] * Math.PI / 180;
        const first = bodies.subarray(BODY * side * each, BODY * (side * each + 1));
        const aside = Number.isNaN(first[4]) ? first[BODY - 2] : first[4];
        const back = aside * Math.tan(tilt) * reach;
        let [x, y] = at(limit, longest);
        x -= way * back * Math.cos(limit - slant);
        y += back * Math.sin(limit - slant);
        const along = [way * Math.sin(limit - slant), Math.cos(limit - slant)];
        pen.strokeStyle = colours.surface;
        pen.lineWidth = 7;
        pen.beginPath();
        pen.moveTo(x - 60 * along[0], y - 60 * along[1]);
        pen.lineTo(x + 60 * along[0], y + 60 * along[1]);
        pen.stroke();
      }
      for (let n = side * each; n < (side + 1) * each; n++) {
        const body = bodies.subarray(BODY * n, BODY * (n + 1));
        const theta = body[0] * Math.PI / 180;
        // Point 0 is that of contact, the shaft's are 1 to 13.
        const point = (k) => at(theta, body[5 + 3 * k], body[3 + 3 * k]);
        const shaft = Array.from({ length: POINTS }, (_, k) => point(k + 1));
        pen.strokeStyle = side === 0 ? colours.left : colours.right;
        for (let k = 1; k < POINTS; k++) {
          // A Catmull-Rom spline: at each point parallel to the line between its neighbours.
          const from = shaft[k - 1], to = shaft[k];
          const before = shaft[Math.max(k - 2, 0)], after = shaft[Math.min(k + 1, POINTS - 1)];
          const leaving = from.map((value, axis) => value + (to[axis] - before[axis]) / 6);
          const coming = to.map((value, axis) => value - (after[axis] - from[axis]) / 6);
          pen.lineWidth = 4.5 - 3.6 * k / (POINTS - 1);
          pen.beginPath();
          pen.moveTo(...from);
          pen.bezierCurveTo(...leaving, ...coming, ...to);
          pen.stroke();
        }
        if (!Number.isNaN(body[3])) {
          pen.beginPath();
          pen.arc(...point(0), 4 + 10 * Math.min(body[2], 1), 0, 2 * Math.PI);
          pen.lineWidth = 1.5;
          pen.stroke();
        }
      }
    }
    pen.fillStyle = colours.ink;
    pen.beginPath();
    pen.ellipse(base, y0, 16, 26, 0, 0, 2 * Math.PI);
    pen.fill();
    pen.fillStyle = colours.faint;
    pen.font = "13px system-ui, sans-serif";
    pen.fillText(`in place: ${player.presented()}`, 10, 20);
  }

  // Name, column, range, and the column that is drawn faintly behind it.
  const STRIPS = [
    ["angle (faint: setpoint), 30 to 130 degrees", 1, [30, 130], 0],
    ["deflection x (faint: y), codes 0 to 16383", 2, [0, 16383], 3],
    ["contact, 0 to 1", 4, [0, 1], null],
  ];
  function drawStrips() {
    const [pen, w, h] = fitted($("strips"));
    const end = points.length ? points[points.length - 1][0] : 0;
    pen.font = "12px system-ui, sans-serif";
    STRIPS.forEach(([name, column, [low, high], faint], n) => {
      const top = n * h / 3 + 20, room = h / 3 - 24;
      const y = (value) => top + room * (1 - (value - low) / (high - low));
      pen.strokeStyle = colours.line;
      pen.lineWidth = 1;
      pen.strokeRect(0.5, top, w - 1, room);
      for (let side = 0; side < sides; side++) {
        pen.strokeStyle = side === 0 ? colours.left : colours.right;
        const curve = (at, alpha) => {
          pen.globalAlpha = alpha;
          pen.lineWidth = 1.5;
          pen.beginPath();
          for (let k = 0; k < points.length; k++) {
            const point = points[k];
            pen.lineTo(w - (end - point[0]) * w / SPAN_S, y(point[1 + 5 * side + at]));
          }
          pen.stroke();
          pen.globalAlpha = 1;
        };
        if (faint !== null) curve(faint, 0.45);
        curve(column, 1);
      }
      pen.fillStyle = colours.faint;
      pen.fillText(name, 6, top - 6);
    });
  }

  function drawMind() {
    const all = player.posteriors(), rows = $("bars").children;
    all.forEach((p, n) => {
      rows[n].querySelector("i").style.width = `${100 * p}%`;
      rows[n].querySelector("output").textContent = p.toFixed(3);
    });
    $("score").textContent = `${right} right, ${wrong} wrong, ${unknown} unknown`;
    const now = player.presented();
    for (const tile of $("textures").children) {
      tile.setAttribute("aria-pressed", String(tile.textContent === now));
    }
  }

  function draw() {
    drawWhiskers();
    drawStrips();
    drawMind();
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
    $("play").setAttribute("aria-pressed", String(on));
  }

  function edited(next, own = {}) {
    text = next;
    set = own;
    for (const key of Object.keys(gates)) delete gates[key];
    $("editor").value = text;
    start();
  }

  function saved(name, bytes, kind) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([bytes], { type: kind }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  // The scene's text and the sliders, as the part of the address that no server sees.
  function address() {
    const bytes = new TextEncoder().encode(JSON.stringify({ text, set, gates, laid }));
    const code = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
    return `#${code.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
  }
  function fromAddress() {
    if (location.hash.length < 2) return false;
    try {
      const code = atob(location.hash.slice(1).replaceAll("-", "+").replaceAll("_", "/"));
      const bytes = Uint8Array.from(code, (c) => c.charCodeAt(0));
      const found = JSON.parse(new TextDecoder().decode(bytes));
      if (typeof found.text !== "string") return false;
      laid = found.laid ?? null;
      edited(found.text);
      for (const [key] of SLIDERS) {
        if (typeof found.set?.[key] === "number") set[key] = found.set[key];
        if (found.gates?.[key]) gates[key] = true;
      }
      return start();
    } catch {
      tell("The address has no scene that can be read.");
      return false;
    }
  }

  $("scene").append(...scenes().map((name) => new Option(name, name)));
  $("scene").onchange = () => { laid = null; edited(scene_text($("scene").value)); };
  for (const [key, name, low, high, step] of SLIDERS) {
    const row = document.createElement("div");
    row.className = "slider";
    row.innerHTML = `<label for="${key}">${name}</label>
      <input type="range" id="${key}" min="${low}" max="${high}" step="${step}">
      <output id="${key}-value" for="${key}"></output>`;
    $("sliders").append(row);
    $(key).oninput = () => {
      const before = { ...set };
      set[key] = Number($(key).value);
      if (!start()) set = before;
    };
  }
  $("own").onclick = () => { laid = null; edited(text); };
  $("textures").append(...textures().map((name) => {
    const tile = document.createElement("button");
    tile.textContent = name;
    const lay = () => {
      laid = name;
      player.lay(name);
    };
    tile.onclick = lay;
    tile.onpointerenter = (event) => { if (event.pointerType === "mouse") lay(); };
    return tile;
  }));
  let typing;
  $("editor").oninput = () => {
    clearTimeout(typing);
    typing = setTimeout(() => { text = $("editor").value; start(); }, 250);
  };
  $("play").onclick = () => play(!playing);
  const forward = () => { play(false); advance(Math.round(player.tick_hz() / 100)); };
  $("step").onclick = forward;
  $("restart").onclick = start;
  $("link").onclick = async () => {
    history.replaceState(null, "", address());
    try {
      await navigator.clipboard.writeText(location.href);
      $("link").textContent = "Link copied";
    } catch {
      $("link").textContent = "Link is in the address bar";
    }
    setTimeout(() => { $("link").textContent = "Link to this scene"; }, 2000);
  };
  $("download").onclick = () => {
    let whole;
    try {
      whole = new Tracer(text, asked(), true);
    } catch (fault) {
      tell(String(fault));
      return;
    }
    while (!whole.step(100000));
    saved("trace.csv", whole.bytes(), "text/csv");
    whole.free();
  };
  document.addEventListener("keydown", (event) => {
    if (event.target.matches("textarea, input, select, button") || event.ctrlKey || event.metaKey) return;
    if (event.key === " ") { play(!playing); event.preventDefault(); }
    if (event.key === "ArrowRight") { forward(); event.preventDefault(); }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", restyle);
  still.addEventListener("change", () => play(!still.matches));
  window.addEventListener("resize", () => { stale = true; });
  window.addEventListener("hashchange", fromAddress);

  restyle();
  play(playing);
  if (!fromAddress()) edited(text);
  measured.core = performance.now() - begun;
  requestAnimationFrame(frame);
})();
