"use strict";
// What moves: attitudes of the scene by the clock of the page, the controls, and the readings below them.

const by = id => document.getElementById(id);
const scene = JSON.parse(by("scene").textContent);
const canvas = by("canvas");

function numbers(text, Kind, unit = 1) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), found = new Kind(bytes.buffer);
  return unit === 1 ? found : Float32Array.from(found, x => x * unit);
}

// A track with its lists as numbers.
function trackOf(written) {
  const track = { ...written, attitudes: numbers(written.attitudes, Int16Array, 1 / 32767) };
  track.omegas = numbers(written.omegas, Int16Array, written.omega_unit / 32767);
  track.momenta = numbers(written.momenta, Int16Array, 1 / 32767);
  track.angles = numbers(written.angles, Float32Array);
  track.energy_changes = numbers(written.energy_changes, Float32Array);
  if (written.times.listed !== undefined) {
    const listed = numbers(written.times.listed, Float64Array);
    track.times = { first: listed[0], last: listed[listed.length - 1], count: listed.length, listed };
  }
  return track;
}
// The state before a time, and what share of the way to the next has passed.
function placeOf({ times }, t) {
  const { first, last, count, listed } = times;
  if (count < 2 || t <= first) return [0, 0];
  if (t >= last) return [count - 2, 1];
  if (!listed) {
    const x = (t - first) / (last - first) * (count - 1), k = Math.min(count - 2, Math.floor(x));
    return [k, x - k];
  }
  let [low, high] = [0, count - 1];
  while (high - low > 1) { const middle = (low + high) >> 1; if (listed[middle] <= t) low = middle; else high = middle; }
  return [low, (t - listed[low]) / (listed[high] - listed[low])];
}
// Whether a track has a state at a time.
const isThere = (track, t) => t >= track.times.first - 1e-9 * span && !(track.ending && t > track.ending[0]);
const row = (list, k, size) => Array.from(list.subarray(size * k, size * k + size));
function mixed(list, [k, s], size) {
  const a = row(list, k, size), b = s > 0 ? row(list, k + 1, size) : a;
  return a.map((x, j) => (1 - s) * x + s * b[j]);
}
// The even turn from one attitude to the next.
function attitude(track, [k, s]) {
  const p = row(track.attitudes, k, 4), q = s > 0 ? row(track.attitudes, k + 1, 4) : p;
  let cos = p.reduce((sum, x, j) => sum + x * q[j], 0);
  const sign = cos < 0 ? -1 : 1, angle = Math.acos(Math.min(1, cos * sign)), sin = Math.sin(angle);
  const [a, b] = sin > 1e-3 ? [Math.sin((1 - s) * angle) / sin, Math.sin(s * angle) / sin] : [1 - s, s];
  const mix = p.map((x, j) => a * x + b * sign * q[j]), norm = Math.hypot(...mix);
  return mix.map(x => x / norm);
}

const body = trackOf(scene.body), rivals = scene.rivals.map(trackOf), ellipsoid = scene.ellipsoid;
const first = body.times.first, span = body.times.last - first || 1;
const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
// part of the way from the first time to the last
let time = 0, pace = scene.pace, running = !calm.matches, before = null, stale = true;
let azimuth = 0.6, elevation = 0.3, zoom = 1;
const shown = name => by(name).checked;
// The energy at a place of the motion, as a share of that of the start.
const energy = place => body.energy_changes.length ? Math.max(1e-9, 1 + mixed(body.energy_changes, place, 1)[0]) : 1;

function style() {
  const found = getComputedStyle(document.documentElement);
  const colour = name => {
    const hex = found.getPropertyValue("--" + name).trim();
    const long = hex.length === 4 ? hex.replace(/[0-9a-f]/gi, x => x + x) : hex;
    return [1, 3, 5].map(k => parseInt(long.slice(k, k + 2), 16) / 255);
  };
  const names = ["body", "mark", "part", "rival0", "rival1", "rival2", "plane", "ellipsoid", "omega", "momentum", "polhode", "herpolhode", "quiet"];
  return Object.fromEntries(names.map(name => [name, colour(name)]));
}
let ink = style();

// pieces of the scene in the memory of the graphics card
let draw = null, shape = null, ball = null, head = null, shaft = null, sheet = null, rim = null, rings = [];
let polhode = null, herpolhode = null, herpolhodeStep = 1, scale = 1;
const FULL = 1.2;

function prepare() {
  if (scene.shape) {
    const vertices = numbers(scene.shape.vertices, Int16Array, 1 / 32767);
    shape = draw.solid(vertices, numbers(scene.shape.triangles, Uint16Array), numbers(scene.shape.tints, Uint8Array));
  }
  ball = draw.solid(...ballOf(64), null, true);
  head = draw.solid(...arrowHead(20));
  shaft = draw.line([[0, 0, 0], [0, 0, 1]]);
  let largest = 0;
  for (let k = 0; k < body.omegas.length; k += 3) largest = Math.max(largest, Math.hypot(...body.omegas.subarray(k, k + 3)));
  const most = body.energy_changes.reduce((most, change) => Math.max(most, 1 + change), 1);
  scale = FULL / (ellipsoid ? Math.sqrt(most) * Math.max(...ellipsoid.semi_axes) : largest || 1);
  if (!ellipsoid) return;
  sheet = draw.solid([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [0, 1, 2, 0, 2, 3]);
  rim = draw.line([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [-1, -1, 0]]);
  const circle = f => Array.from({ length: 97 }, (_, k) => f(Math.cos(k * Math.PI / 48), Math.sin(k * Math.PI / 48)));
  rings = [circle((c, s) => [0, c, s]), circle((c, s) => [c, 0, s]), circle((c, s) => [c, s, 0])].map(draw.line);
  // a line of some thousand points shows as much as all of them
  const round = placeOf(body, ellipsoid.round)[0] + 1, step = Math.max(1, Math.ceil(round / 12000));
  const once = Array.from({ length: Math.floor(round / step) + 1 }, (_, k) => Math.min(k * step, body.times.count - 1));
  // on the ellipsoid of the start
  polhode = draw.line(once.map(k => times(row(body.omegas, k, 3), scale * 1.004 / Math.sqrt(energy([k, 0])))));
  herpolhodeStep = Math.max(1, Math.ceil(body.times.count / 12000));
  const path = Array.from({ length: Math.floor((body.times.count - 1) / herpolhodeStep) + 1 }, (_, k) => {
    const at = turned(row(body.attitudes, k * herpolhodeStep, 4), row(body.omegas, k * herpolhodeStep, 3));
    return [at[0] * scale, at[1] * scale, 0];
  });
  herpolhode = draw.line(path);
}

// The turn of z to a direction.
function zTo(v) {
  const d = unit(v);
  return d[2] < -0.999999 ? [0, 1, 0, 0] : (q => times4(q, 1 / Math.hypot(...q)))([1 + d[2], -d[1], d[0], 0]);
}
const times4 = (q, s) => q.map(x => x * s);

function arrow(v, colour, label, offset) {
  const length = Math.hypot(...v), tag = by(label + "-label");
  tag.hidden = length < 1e-3;
  if (tag.hidden) return;
  const q = zTo(v), tip = Math.min(0.11, length);
  draw.drawLine(shaft, { q, stretch: [1, 1, length - 0.5 * tip], offset, colour, width: 3.5, faint: 0.6 });
  draw.drawSolid(head, { q, stretch: [tip, tip, tip], offset: plus(offset, times(v, 1 - tip / length)), colours: [colour], hides: false, faint: 0.6 });
  const [x, y] = draw.seen(plus(offset, v));
  tag.style.transform = `translate(${Math.min(Math.max(x + 8, 0), canvas.clientWidth - 20)}px, ${Math.min(Math.max(y - 10, 0), canvas.clientHeight - 24)}px)`;
}

function paint() {
  const t = first + time * span, place = placeOf(body, t), q = attitude(body, place);
  const rolls = ellipsoid && (shown("polhode") || shown("herpolhode")), plane = ellipsoid && shown("herpolhode");
  const stands = !scene.shape && ellipsoid, count = 1 + rivals.length, apart = rivals.length > 0 && shown("apart");
  let radius = shown("omega") || shown("momentum") || rolls || stands ? 1.25 : 1.05;
  if (plane) radius = Math.max(radius, Math.hypot(1.4 * ellipsoid.plane, ellipsoid.distance) * scale);
  const breadth = radius + (apart ? 1.1 * (count - 1) : 0);
  const { right } = draw.begin(azimuth, elevation, radius / zoom, breadth / zoom, running ? quality : 1);
  const aside = k => apart ? times(right, 2.2 * (k - (count - 1) / 2)) : [0, 0, 0];
  const offset = aside(0);
  if (shape) draw.drawSolid(shape, { q, offset, colours: [ink.body, ink.mark, ink.part] });

  const omega = body.omegas.length ? mixed(body.omegas, place, 3) : [0, 0, 0];
  if (rolls || stands) {
    const share = energy(place), root = Math.sqrt(share);
    const frame = product(q, ellipsoid.frame), stretch = times(ellipsoid.semi_axes, root * scale);
    if (plane) {
      const low = plus(offset, [0, 0, -ellipsoid.distance * share * scale]), wide = ellipsoid.plane * scale;
      // from below the bodies are seen through the plane
      draw.drawSolid(sheet, { q: [1, 0, 0, 0], stretch: [wide, wide, 1], offset: low, colours: [ink.plane], opacity: 0.55, hides: false });
      draw.drawLine(rim, { stretch: [wide, wide, 1], offset: low, colour: ink.quiet, width: 1 });
      draw.drawLine(herpolhode, { offset: low, colour: ink.herpolhode, width: 2, pieces: Math.ceil((place[0] + place[1]) / herpolhodeStep) });
    }
    draw.drawSolid(ball, { q: frame, stretch, offset, colours: [ink.ellipsoid], opacity: stands ? 0.7 : 0.25, hides: Boolean(stands) });
    for (const ring of rings) draw.drawLine(ring, { q: frame, stretch: times(stretch, 1.002), offset, colour: ink.quiet, width: 1, faint: 0.2 });
    if (shown("polhode")) draw.drawLine(polhode, { q, stretch: [root, root, root], offset, colour: ink.polhode, width: 2.5 });
  }
  rivals.forEach((rival, k) => {
    if (!shape || !isThere(rival, t)) return;
    const turn = attitude(rival, placeOf(rival, t));
    // a little larger, so that equal surfaces do not flicker
    const larger = apart ? 1 : 1.004 + 0.002 * k, colour = ink["rival" + k % 3];
    draw.drawSolid(shape, { q: turn, offset: aside(k + 1), stretch: [larger, larger, larger],
      colours: [colour, times(plus(colour, [0.3, 0.3, 0.3]), 0.85), colour], opacity: apart ? 0.75 : 0.42 });
  });
  for (const name of ["omega", "momentum"]) by(name + "-label").hidden = true;
  if (shown("omega") && body.omegas.length) arrow(times(turned(q, omega), scale), ink.omega, "omega", offset);
  if (shown("momentum") && body.momenta.length) {
    const l = mixed(body.momenta, place, 3), length = ellipsoid ? 1.28 * ellipsoid.distance * scale : FULL * Math.hypot(...l);
    arrow(times(unit(l), length), ink.momentum, "momentum", offset);
  }
  tell(t);
}

const UNITS = [[86400 * 3, "d", 86400], [3600 * 3, "h", 3600], [0.1, "s", 1], [1e-4, "ms", 1e-3], [1e-7, "µs", 1e-6], [1e-10, "ns", 1e-9], [0, "ps", 1e-12]];
const [, unitName, unitSize] = UNITS.find(([least]) => Math.max(span, Math.abs(first)) >= least);
const digits = Math.max(0, Math.min(6, 3 - Math.floor(Math.log10(span / unitSize))));
const timeText = t => (t / unitSize).toFixed(digits) + " " + unitName;
function short(x) {
  const size = Math.abs(x);
  if (size === 0) return "0";
  return (size >= 1e-3 && size < 1e5 ? String(Number(x.toPrecision(3))) : x.toExponential(1)).replace(/-/g, "−").replace("e+", "e");
}
const flipsText = (flips, t) => !flips ? "–"
  : flips.count > flips.times.length ? `${flips.count} in all` : String(flips.times.filter(x => x <= t).length);

function tell(t) {
  by("now").value = "t = " + timeText(t);
  by("time").value = time;
  by("time").setAttribute("aria-valuetext", "t = " + timeText(t));
  const rows = by("readings").querySelectorAll("tbody tr");
  [body, ...rivals].forEach((track, k) => {
    const cells = rows[k].children, place = placeOf(track, t), there = isThere(track, t);
    const value = list => there && list.length ? mixed(list, place, 1)[0] : null;
    const ended = track.ending && t > track.ending[0];
    const angle = value(track.angles), change = value(track.energy_changes);
    cells[1].textContent = flipsText(track.flips, t);
    cells[2].textContent = ended ? `${track.ending[1]} at ${timeText(track.ending[0])}` : angle === null ? "–" : short(angle * 180 / Math.PI) + "°";
    cells[3].textContent = change === null ? "–" : (change > 0 ? "+" : "") + short(change * 100) + " %";
  });
}
function lay() {
  const table = by("readings"), tracks = [body, ...rivals];
  table.hidden = !rivals.length && !body.flips;
  for (const [k, track] of tracks.entries()) {
    const line = table.tBodies[0].insertRow(), name = line.insertCell(), swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = `var(--${k ? "rival" + (k - 1) % 3 : "body"})`;
    name.append(swatch, track.name);
    for (let j = 0; j < 3; j++) line.insertCell();
  }
  by("apart").parentElement.hidden = !rivals.length;
  for (const name of ["polhode", "herpolhode"]) by(name).parentElement.hidden = !ellipsoid;
  by("omega").parentElement.hidden = !body.omegas.length;
  by("momentum").parentElement.hidden = !body.momenta.length;
  for (const [name, value] of Object.entries(scene.shown)) by(name).checked = value;
}

function setRunning(value) {
  running = value; before = null; stale = true;
  by("play").textContent = running ? "Pause" : "Play";
}
function setPace(value) {
  pace = Math.min(1e18, Math.max(1e-18, value));
  by("pace").value = pace === 1 ? "real time" : "× " + short(pace);
}
// 1, 2, 5, 10, 20, ... times
function nextPace(up) {
  const power = Math.floor(Math.log10(pace) + 1e-9), digit = Math.round(pace / 10 ** power);
  const steps = [0.5, 1, 2, 5, 10], k = steps.findIndex(x => x >= digit);
  return Number((steps[k + (up ? 1 : -1)] * 10 ** power).toPrecision(1));
}
function seek(value) { time = Math.min(1, Math.max(0, value)); stale = true; }

by("play").onclick = () => setRunning(!running);
by("slower").onclick = () => setPace(nextPace(false));
by("faster").onclick = () => setPace(nextPace(true));
by("real").onclick = () => setPace(1);
by("time").oninput = event => { setRunning(false); seek(Number(event.target.value)); };
by("shown").onchange = () => { stale = true; };
by("controls").onsubmit = () => false;
window.onresize = () => { stale = true; };
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { ink = style(); stale = true; });

function turnView(across, up) {
  azimuth -= across;
  elevation = Math.max(-1.5, Math.min(1.5, elevation + up));
  stale = true;
}
const held = new Map();
canvas.onpointerdown = event => { held.set(event.pointerId, [event.clientX, event.clientY]); canvas.setPointerCapture(event.pointerId); };
canvas.onpointermove = event => {
  const from = held.get(event.pointerId), to = [event.clientX, event.clientY];
  if (!from) return;
  held.set(event.pointerId, to);
  if (held.size === 1) return turnView((to[0] - from[0]) / 150, (to[1] - from[1]) / 150);
  // two fingers zoom
  const other = [...held].find(([id]) => id !== event.pointerId)[1];
  const distance = at => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1;
  setZoom(zoom * distance(to) / distance(from));
};
canvas.onpointerup = canvas.onpointercancel = event => { held.delete(event.pointerId); };
function setZoom(value) { zoom = Math.min(5, Math.max(0.3, value)); stale = true; }
const KEYS = {
  ArrowLeft: () => turnView(0.1, 0), ArrowRight: () => turnView(-0.1, 0), ArrowUp: () => turnView(0, -0.1), ArrowDown: () => turnView(0, 0.1),
  "+": () => setZoom(zoom * 1.15), "=": () => setZoom(zoom * 1.15), "-": () => setZoom(zoom / 1.15), " ": () => setRunning(!running),
  ",": () => { setRunning(false); seek(time - pace / 30 / span); }, ".": () => { setRunning(false); seek(time + pace / 30 / span); },
};
canvas.onkeydown = event => {
  const action = !event.ctrlKey && !event.metaKey && !event.altKey && KEYS[event.key];
  if (action) { action(); event.preventDefault(); }
};

// What draws slowly draws fewer pixels while it moves, down to half of them in a row; a picture that stands still has all.
const SLOW = 40;
let quality = 1, interval = 16;
function keepUp(elapsed) {
  interval += (Math.min(elapsed, 200) - interval) / 8;
  if (interval < SLOW || quality <= 0.5) return;
  quality = Math.max(0.5, 0.8 * quality);
  interval = 16;
}

function tick(stamp) {
  if (running && before !== null) {
    keepUp(stamp - before);
    // a page that was hidden goes on where it was
    time += Math.min(0.1, (stamp - before) / 1000) * pace / span;
    if (time > 1) time %= 1;
    stale = true;
  }
  before = stamp;
  if (stale) { stale = false; paint(); }
  requestAnimationFrame(tick);
}

// An address that ends in #t=3.5&omega&polhode begins there, paused, with these shown.
function readAddress() {
  for (const part of location.hash.slice(1).split("&")) {
    const [name, value] = part.split("=");
    if (name === "t" && isFinite(value)) { setRunning(false); seek((Number(value) - first) / span); }
    if (["omega", "momentum", "polhode", "herpolhode", "apart"].includes(name)) by(name).checked = value !== "0";
    if (name === "view" && value) [azimuth, elevation] = value.split(",").map(x => Number(x) * Math.PI / 180);
  }
}

function begin() {
  lay();
  setPace(pace);
  setRunning(running);
  readAddress();
  try { draw = rendererOf(canvas); } catch (error) { console.error(error); }
  if (!draw) {
    by("failure").textContent = "This browser draws no WebGL; the page needs it to show the body.";
    by("failure").hidden = false;
    canvas.hidden = true;
    tell(first);
    return;
  }
  prepare();
  canvas.addEventListener("webglcontextlost", event => event.preventDefault());
  canvas.addEventListener("webglcontextrestored", () => { draw = rendererOf(canvas); prepare(); stale = true; });
  requestAnimationFrame(tick);
}
begin();
