"use strict";
(() => {
const $ = (id) => document.getElementById(id);
const make = (tag, text = "", kind = "") => {
  const element = document.createElement(tag);
  if (text) element.textContent = text;
  if (kind) element.className = kind;
  return element;
};

// Tables that sort, and the list's filters.
const number = (text) => { const found = /^-?\d[\d,]*\.?\d*/.exec(text); return found ? parseFloat(found[0].replace(/,/g, "")) : NaN; };
const natural = new Intl.Collator("en", { numeric: true });
function compare(a, b) {
  const [x, y] = [number(a), number(b)];
  return Number.isNaN(x) || Number.isNaN(y) ? natural.compare(a, b) : x - y || natural.compare(a, b);
}
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells], body = table.tBodies[0];
  heads.forEach((head, column) => head.firstElementChild.addEventListener("click", () => {
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const text = (row) => row.cells[column].textContent.trim();
    const empty = (t) => t === "" || t === "-";
    const rows = [...body.rows].sort((a, b) => {
      const [x, y] = [text(a), text(b)];
      if (empty(x) || empty(y)) return empty(x) - empty(y);
      return down ? compare(y, x) : compare(x, y);
    });
    body.append(...rows);
  }));
}
const listed = [...$("list").tBodies[0].rows];
function filter() {
  const words = $("f-text").value.toLowerCase().split(/\s+/).filter(Boolean);
  const row = $("f-row") ? $("f-row").value : "", ending = $("f-ending").value, pet = parseFloat($("f-pet").value);
  let shown = 0;
  for (const line of listed) {
    const text = line.textContent.toLowerCase(), own = line.dataset;
    const fits = words.every((word) => text.includes(word)) && (!row || own.row === row) && (!ending || own.ending === ending)
      && (Number.isNaN(pet) || (own.pet !== "" && parseFloat(own.pet) < pet)) && (!$("f-replay").checked || "replay" in own);
    line.hidden = !fits;
    shown += fits;
  }
  $("f-count").textContent = `${shown} of ${listed.length}`;
}
$("filters").hidden = false;
$("filters").addEventListener("input", filter);
$("filters").addEventListener("submit", (event) => event.preventDefault());
filter();

// Light and dark.
const root = document.documentElement, themes = ["system", "light", "dark"];
function paint(theme) {
  root.dataset.theme = theme;
  $("theme").textContent = `Theme: ${theme}`;
  palette = null;
  draw();
}
const kept = () => { try { return localStorage.getItem("codriving-theme"); } catch { return null; } };
$("theme").addEventListener("click", () => {
  const next = themes[(themes.indexOf(root.dataset.theme) + 1) % themes.length];
  try { localStorage.setItem("codriving-theme", next); } catch { /* Not every browser keeps things for files. */ }
  paint(next);
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => paint(root.dataset.theme));
let palette = null;
function colours() {
  if (palette) return palette;
  palette = {};
  for (const name of ["ground", "asphalt", "paint", "building", "cav", "hdv", "good", "bad", "ink", "faint", "paper", "hair", "danger0", "danger1", "danger2"]) {
    $("probe").style.color = `var(--${name})`;
    palette[name] = getComputedStyle($("probe")).color;
  }
  return palette;
}

// Episodes: unpacked when they are opened.
const roads = JSON.parse($("roads").textContent), index = JSON.parse($("index").textContent);
const places = new Map(index.map(([key], k) => [key, k])), unpacked = new Map(), paths = new Map();
function load(key) {
  if (!unpacked.has(key)) unpacked.set(key, unpack(places.get(key)));
  return unpacked.get(key);
}
async function unpack(k) {
  const bytes = Uint8Array.from(atob($(`e${k}`).textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const found = JSON.parse(await new Response(stream).text());
  for (const vehicle of found.vehicles) {
    for (const [name, scale] of [["x", 100], ["y", 100], ["h", 1000], ["v", 100]]) {
      let sum = 0;
      vehicle[name] = vehicle[name].map((n) => (sum += n) / scale);
    }
  }
  found.vehicles.sort((a, b) => natural.compare(a.id, b.id));
  found.cavs = found.vehicles.filter((v) => v.kind === "CAV").map((v) => v.id);
  found.duration = Math.max(...found.vehicles.map((v) => (v.first + v.x.length - 1) * found.step));
  found.road = index[k][1];
  found.views = views(found);
  return found;
}
function at(vehicle, time, step) {
  const row = time / step - vehicle.first, last = vehicle.x.length - 1;
  if (row < -1e-6 || row > last + 1e-6) return null;
  const k = Math.min(Math.max(Math.floor(row + 1e-9), 0), Math.max(last - 1, 0)), next = Math.min(k + 1, last), share = Math.min(Math.max(row - k, 0), 1);
  const mix = (values) => values[k] + share * (values[next] - values[k]);
  return { x: mix(vehicle.x), y: mix(vehicle.y), h: mix(vehicle.h), v: mix(vehicle.v) };
}
// What the camera sees every 0.2 s: the box around the CAVs, with what is about to come, moved calmly.
const EVERY = 0.2;
function views(episode) {
  const boxes = [];
  for (let k = 0; k <= episode.duration / EVERY; k++) {
    let seen = episode.vehicles.filter((v) => v.kind === "CAV").map((v) => at(v, k * EVERY, episode.step)).filter(Boolean);
    if (!seen.length && !boxes.length) seen = episode.vehicles.map((v) => ({ x: v.x[0], y: v.y[0] }));
    boxes.push(seen.length ? [Math.min(...seen.map((p) => p.x)), Math.min(...seen.map((p) => p.y)), Math.max(...seen.map((p) => p.x)), Math.max(...seen.map((p) => p.y))] : boxes[k - 1]);
  }
  const around = (list, k, reach) => list.slice(Math.max(0, k - reach), k + reach + 1);
  const wide = boxes.map((_, k) => [0, 1, 2, 3].map((i) => (i < 2 ? Math.min : Math.max)(...around(boxes, k, 6).map((b) => b[i]))));
  return wide.map((_, k) => [0, 1, 2, 3].map((i) => { const near = around(wide, k, 6); return near.reduce((sum, b) => sum + b[i], 0) / near.length; }));
}
function pathOf(road) {
  if (paths.has(road)) return paths.get(road);
  const line = (path, points, closed) => {
    for (let i = 0; i < points.length; i += 2) path[i ? "lineTo" : "moveTo"](points[i] / 100, points[i + 1] / 100);
    if (closed) path.closePath();
  };
  const whole = (lines, closed) => { const path = new Path2D(); for (const points of lines) line(path, points, closed); return path; };
  const data = roads[road], made = {};
  for (const [name, closed] of [["asphalt", true], ["buildings", true], ["blocks", true], ["full", false], ["striped", false], ["goals", false]]) made[name] = whole(data[name], closed);
  made.ahead = (name, place) => {
    const points = data.routes[name] || [];
    let from = 0, least = Infinity;
    for (let i = 0; i < points.length; i += 2) {
      const away = Math.hypot(points[i] / 100 - place.x, points[i + 1] / 100 - place.y);
      if (away < least) [least, from] = [away, i];
    }
    return whole([points.slice(from)], false);
  };
  const xs = data.asphalt.flatMap((p) => p.filter((_, i) => i % 2 === 0)), ys = data.asphalt.flatMap((p) => p.filter((_, i) => i % 2));
  const least = (values) => values.reduce((a, b) => Math.min(a, b)) / 100, most = (values) => values.reduce((a, b) => Math.max(a, b)) / 100;
  made.box = [least(xs), least(ys), most(xs), most(ys)];
  const [wide, tall] = [made.box[2] - made.box[0], made.box[3] - made.box[1]];
  made.long = Math.max(wide, tall) > 4 * Math.min(wide, tall);
  paths.set(road, made);
  return made;
}

// The replay.
const SIGNS = { FASTER: "\u25B2", SLOWER: "\u25BC", IDLE: "\u2013", HOLD: "=", LANE_LEFT: "\u25C4", LANE_RIGHT: "\u25BA" };
let episode = null, key = "", now = 0, cav = "", playing = false, last = 0, twin = null, shown = "";
const open = new Map();
const stepAt = (which, time) => { let k = -1; while (k + 1 < which.steps.length && which.steps[k + 1].t <= time + 1e-6) k++; return k; };

function canvasOf(id, height) {
  const canvas = $(id), ratio = devicePixelRatio || 1, width = canvas.clientWidth;
  if (height) canvas.style.height = `${height}px`;
  const tall = canvas.clientHeight, size = [Math.round(width * ratio), Math.round(tall * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return { pen, width, height: tall, ratio };
}
function draw() {
  if (!episode || $("replay").hidden) return;
  const c = colours(), road = pathOf(episode.road);
  $("road").classList.toggle("long", road.long);
  const { pen, width, height, ratio } = canvasOf("road");
  if (!width) return;
  const box = $("follow").checked ? episode.views[Math.min(Math.round(now / EVERY), episode.views.length - 1)] : road.box;
  const margin = $("follow").checked ? 16 : 2, least = 60;
  const chosen = episode.vehicles.find((v) => v.id === cav), here = chosen && at(chosen, now, episode.step);
  const fitting = Math.min(width / Math.max(box[2] - box[0] + 2 * margin, least), height / Math.max(box[3] - box[1] + 2 * margin, least * height / width), 12);
  // A long road does not fit in: what is seen of it moves with the chosen CAV.
  const zoom = road.long && $("follow").checked ? Math.max(fitting, 4.5) : fitting;
  const centre = (k, size) => {
    const [low, high] = [box[k] - margin + size / zoom / 2, box[k + 2] + margin - size / zoom / 2];
    return low < high && here ? Math.min(Math.max(k ? here.y : here.x, low), high) : (low + high) / 2;
  };
  const x0 = width / 2 - zoom * centre(0, width), y0 = height / 2 - zoom * centre(1, height);
  const on = (x, y) => [x0 + zoom * x, y0 + zoom * y];
  pen.fillStyle = c.ground;
  pen.fillRect(0, 0, width, height);
  pen.setTransform(ratio * zoom, 0, 0, ratio * zoom, ratio * x0, ratio * y0);
  const stroke = (path, colour, pixels, dash = []) => { pen.strokeStyle = colour; pen.lineWidth = pixels / zoom; pen.setLineDash(dash); pen.stroke(path); pen.setLineDash([]); };
  pen.fillStyle = c.building; pen.fill(road.buildings);
  pen.fillStyle = c.asphalt; pen.fill(road.asphalt); stroke(road.asphalt, c.asphalt, 1);
  const line = Math.max(0.15 * zoom, 1);
  stroke(road.full, c.paint, line); stroke(road.striped, c.paint, line, [3, 4.5]);
  stroke(road.goals, c.good, 3, [4 / zoom, 3 / zoom]);
  pen.fillStyle = c.ink; pen.fill(road.blocks);
  const step = episode.steps[stepAt(episode, now)], own = step && step.cavs[cav];
  if (here) { pen.globalAlpha = 0.6; stroke(road.ahead((own && own.route) || chosen.route, here), c.cav, 2.5); pen.globalAlpha = 1; }
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  const seen = new Map();
  for (const vehicle of episode.vehicles) { const place = at(vehicle, now, episode.step); if (place) seen.set(vehicle.id, place); }
  if (step) for (const mark of [...step.marks].reverse()) meeting(pen, c, on, seen, mark);
  if (twin) for (const vehicle of twin.vehicles) { const place = at(vehicle, now, twin.step); if (place) body(pen, c, on, zoom, vehicle, place, true); }
  for (const vehicle of episode.vehicles) if (seen.has(vehicle.id)) body(pen, c, on, zoom, vehicle, seen.get(vehicle.id), false);
  pen.font = "600 11px system-ui, sans-serif"; pen.textAlign = "center"; pen.lineJoin = "round"; pen.textBaseline = "alphabetic";
  const written = [];
  const rank = (vehicle) => (vehicle.id === cav ? 0 : vehicle.kind === "CAV" ? 1 : 2);
  for (const vehicle of [...episode.vehicles].sort((a, b) => rank(a) - rank(b))) {
    const place = seen.get(vehicle.id);
    if (!place) continue;
    const [x, y] = on(place.x, place.y), decided = step && step.cavs[vehicle.id], sign = decided ? ` ${SIGNS[decided.a] || decided.a}` : "";
    const words = `${vehicle.id}${sign} ${place.v.toFixed(1)}`, half = pen.measureText(words).width / 2, off = 1.6 * zoom + 5;
    // Above it, or where that is taken below it, or above that.
    const free = (top) => written.every(([a, b, wide]) => Math.abs(a - x) > wide + half + 3 || Math.abs(b - top) > 12);
    const top = [y - off, y + off + 9, y - off - 13, y + off + 22].find(free);
    if (top === undefined) continue;
    written.push([x, top, half]);
    pen.strokeStyle = c.ground; pen.lineWidth = 3; pen.globalAlpha = 0.85; pen.strokeText(words, x, top); pen.globalAlpha = 1;
    pen.fillStyle = vehicle.kind === "CAV" ? c.ink : c.faint; pen.fillText(words, x, top);
  }
  if (now >= episode.duration - 1e-6 && episode.ending.hit.length) {
    const hit = episode.ending.hit.map((id) => seen.get(id)).filter(Boolean);
    if (hit.length) {
      const [x, y] = on(hit.reduce((s, p) => s + p.x, 0) / hit.length, hit.reduce((s, p) => s + p.y, 0) / hit.length);
      pen.strokeStyle = c.bad; pen.lineWidth = 3; pen.beginPath(); pen.arc(x, y, Math.max(4.5 * zoom, 18), 0, 7); pen.stroke();
    }
  }
  strip();
}
function body(pen, c, on, zoom, vehicle, place, ghost) {
  const [x, y] = on(place.x, place.y), long = vehicle.size[0] * zoom, wide = Math.max(vehicle.size[1] * zoom, 4);
  pen.save(); pen.translate(x, y); pen.rotate(place.h);
  pen.beginPath();
  if (vehicle.kind === "CAV") { pen.moveTo(-long / 2, -wide / 2); pen.lineTo(long * 0.22, -wide / 2); pen.lineTo(long / 2, 0); pen.lineTo(long * 0.22, wide / 2); pen.lineTo(-long / 2, wide / 2); pen.closePath(); }
  else pen.rect(-long / 2, -wide / 2, long, wide);
  const colour = vehicle.kind === "CAV" ? c.cav : c.hdv;
  if (ghost) { pen.setLineDash([3, 2]); pen.strokeStyle = c.ink; pen.lineWidth = 1; pen.stroke(); }
  else {
    pen.fillStyle = vehicle.kind === "CAV" ? colour : c.paper; pen.fill();
    pen.strokeStyle = colour; pen.lineWidth = 1.8; pen.stroke();
    if (vehicle.id === cav) { pen.strokeStyle = c.ink; pen.lineWidth = 2; pen.strokeRect(-long / 2 - 4, -wide / 2 - 4, long + 8, wide + 8); }
  }
  pen.restore();
}
function meeting(pen, c, on, seen, [one, other, band, , certain, place]) {
  const own = one === cav || other === cav, ends = [seen.get(one), seen.get(other)], colour = c[`danger${band}`];
  if (!ends[0] || !ends[1]) return;
  pen.globalAlpha = own ? 1 : 0.35; pen.strokeStyle = colour;
  const spot = place ? on(place[0] / 100, place[1] / 100) : on((ends[0].x + ends[1].x) / 2, (ends[0].y + ends[1].y) / 2);
  if (own) {
    pen.lineWidth = [2.5, 2, 1.5][band]; pen.setLineDash(band ? [6, 4] : []);
    pen.beginPath();
    for (const end of ends) { pen.moveTo(...on(end.x, end.y)); pen.lineTo(...spot); }
    pen.globalAlpha = 0.5; pen.stroke(); pen.globalAlpha = 1; pen.setLineDash([]);
  }
  const half = [9, 7.5, 6][band];
  pen.beginPath(); pen.moveTo(spot[0], spot[1] - half); pen.lineTo(spot[0] + half, spot[1]); pen.lineTo(spot[0], spot[1] + half); pen.lineTo(spot[0] - half, spot[1]); pen.closePath();
  pen.fillStyle = certain ? colour : c.paper; pen.fill(); pen.lineWidth = 1.5; pen.stroke();
  pen.globalAlpha = 1;
}

// What each CAV decided at each step, at a glance.
const NAMES = 46, TALL = 16;
function strip() {
  const { pen, width } = canvasOf("strip", episode.cavs.length * TALL + 4), c = colours();
  pen.clearRect(0, 0, width, episode.cavs.length * TALL + 4);
  const scale = (width - NAMES - 2) / episode.duration, steps = episode.steps;
  const fill = { FASTER: c.good, SLOWER: c.bad, LANE_LEFT: c.cav, LANE_RIGHT: c.cav };
  pen.textBaseline = "middle";
  episode.cavs.forEach((id, row) => {
    const top = row * TALL + 2;
    pen.font = `${id === cav ? "700" : "400"} 11px system-ui, sans-serif`; pen.textAlign = "left"; pen.fillStyle = c.ink;
    pen.fillText(id, 0, top + TALL / 2);
    steps.forEach((step, k) => {
      const one = step.cavs[id];
      if (!one) return;
      const left = NAMES + step.t * scale, wide = ((steps[k + 1] || { t: episode.duration }).t - step.t) * scale;
      pen.globalAlpha = one.a in fill ? 0.8 : one.a === "HOLD" ? 0.5 : 0.25;
      pen.fillStyle = fill[one.a] || c.faint; pen.fillRect(left, top + 1, Math.max(wide - 0.6, 0.8), TALL - 3);
      pen.globalAlpha = 1;
      if (one.x) { pen.fillStyle = c.ink; pen.fillRect(left, top + TALL - 4, Math.max(wide - 0.6, 0.8), 2); }
    });
  });
  pen.strokeStyle = c.ink; pen.lineWidth = 1.5; pen.beginPath();
  const x = NAMES + now * scale; pen.moveTo(x, 0); pen.lineTo(x, episode.cavs.length * TALL + 4); pen.stroke();
}
$("strip").addEventListener("click", (event) => {
  const area = $("strip").getBoundingClientRect(), row = Math.floor((event.clientY - area.top - 2) / TALL);
  if (episode.cavs[row]) cav = episode.cavs[row];
  const time = (event.clientX - area.left - NAMES) / ((area.width - NAMES - 2) / episode.duration);
  go(time < 0 ? now : time);
});
$("signs").textContent = "Green: FASTER, orange: SLOWER, dark grey: HOLD, light grey: IDLE, blue: a lane change. A line below: actions were removed.";

// Beside the road: what the chosen CAV knew and decided.
function panel() {
  const k = stepAt(episode, now), step = episode.steps[k], entry = step && step.cavs[cav];
  const other = twin && twin.steps[stepAt(twin, now)], theirs = other && other.cavs[cav];
  const vehicle = episode.vehicles.find((v) => v.id === cav), here = vehicle && at(vehicle, now, episode.step);
  const mark = [key, k, cav, !!here, twin ? twin.key : "", twin ? stepAt(twin, now) : ""].join("|");
  if (mark === shown) return;
  shown = mark;
  for (const button of $("cavs").children) {
    button.setAttribute("aria-pressed", String(button.dataset.cav === cav));
    button.classList.toggle("gone", !step || !step.cavs[button.dataset.cav]);
  }
  const arrived = vehicle && vehicle.arrived !== null && vehicle.arrived <= now + 1e-6;
  $("decision").textContent = entry ? `${cav} at ${step.t.toFixed(1)} s: ${entry.a || "no action"}` : `${cav} ${arrived ? `arrived at ${vehicle.arrived.toFixed(1)} s` : here ? "decides nothing here" : "is not on the road"}`;
  $("reason").textContent = entry ? entry.r + (entry.w.length ? ` (waits for ${entry.w.join(", ")})` : "") : "";
  $("other").hidden = !twin;
  $("other").textContent = twin ? `${twin.name}: ${theirs ? `${theirs.a}, ${theirs.r}` : "no decision of it here"}` : "";
  const parts = entry ? [...entry.s] : [];
  if (step && step.talk.length) parts.push({ h: "Who agrees with whom", p: step.talk.map((words) => `${words}.`) });
  if (step && !entry && step.order.length) parts.push({ h: "Passing order of the others", p: [`${step.order.join(", then ")}.`] });
  $("sections").replaceChildren(...parts.map(section));
}
function section(part) {
  const box = make("details"), kind = part.h.replace(/:.*/, "");
  box.append(make("summary", part.h));
  box.open = open.has(kind) ? open.get(kind) : !part.t;
  box.addEventListener("toggle", () => open.set(kind, box.open));
  for (const text of part.p || []) box.append(make("p", text));
  if (part.r) {
    const table = make("table"), head = table.createTHead().insertRow(), body = table.createTBody(), wide = make("div", "", "wide");
    for (const text of part.c) { const cell = make("th", text); cell.scope = "col"; head.append(cell); }
    for (const row of part.r) {
      const line = body.insertRow();
      if (part.h === "Actions") line.className = row[1].split(" ")[0];
      for (const text of row) line.append(make("td", text, text.length < 13 ? "short" : ""));
    }
    wide.append(table); box.append(wide);
  }
  for (const [label, text] of part.t || []) box.append(make("h4", label), make("pre", text));
  return box;
}

function show() {
  $("scrub").value = now;
  $("time").textContent = `${now.toFixed(1)} s`;
  const over = now >= episode.duration - 1e-6;
  $("ending").textContent = over ? episode.ending.text : "";
  $("ending").className = over ? (episode.ending.good ? "good" : "bad") : "";
  draw();
  panel();
}
function note() {
  const beside = twin ? `&with=${twin.key}` : "";
  history.replaceState(null, "", `#ep=${key}&t=${+now.toFixed(1)}&cav=${encodeURIComponent(cav)}${beside}`);
}
function go(time) { pause(); now = Math.min(Math.max(time, 0), episode.duration); show(); note(); }
function pause() { playing = false; $("play").textContent = "Play"; }
function play() {
  if (playing) { pause(); note(); return; }
  if (now >= episode.duration - 1e-6) now = 0;
  playing = true; last = performance.now(); $("play").textContent = "Pause";
  requestAnimationFrame(frame);
}
function frame(time) {
  if (!playing) return;
  now = Math.min(now + Math.max(time - last, 0) / 1000 * parseFloat($("speed").value), episode.duration);
  last = time;
  show();
  if (now >= episode.duration) { pause(); note(); } else requestAnimationFrame(frame);
}
function hop(by) {
  const k = stepAt(episode, now), steps = episode.steps;
  const target = by < 0 ? (steps[k] && now > steps[k].t + 1e-6 ? k : k - 1) : k + 1;
  go(target < 0 ? 0 : target >= steps.length ? episode.duration : steps[target].t);
}
function turn(by) {
  const k = places.get(key) + by;
  if (index[k]) location.hash = `ep=${index[k][0]}`;
}
function choose(id) { cav = id; show(); note(); }
async function setTwin(other) {
  twin = null;
  if (other && places.has(other)) { twin = await load(other); twin.key = other; }
  $("twin").value = twin ? other : "";
}

async function follow() {
  const asked = Object.fromEntries(location.hash.slice(1).split("&").map((part) => [part.split("=")[0], part.split("=").slice(1).join("=")]));
  const wanted = "ep" in asked && places.has(asked.ep);
  pause();
  $("overview").hidden = wanted;
  $("replay").hidden = !wanted;
  if (!wanted) {
    episode = null; key = "";
    document.title = document.querySelector("h1").textContent;
    if (location.hash.length > 1 && !("ep" in asked)) { const part = $(location.hash.slice(1)); if (part) part.scrollIntoView(); }
    return;
  }
  const found = await load(asked.ep), fresh = key !== asked.ep;
  episode = found; key = asked.ep; shown = "";
  $("name").textContent = `${episode.name}, seed ${episode.seed}`;
  document.title = $("name").textContent;
  $("scrub").max = episode.duration; $("scrub").step = episode.step;
  $("before").disabled = places.get(key) === 0; $("after").disabled = places.get(key) === index.length - 1;
  const others = index[places.get(key)][2];
  $("twin-label").hidden = !others.length;
  $("twin").replaceChildren(new Option("nothing", ""), ...others.map((other) => new Option(index[places.get(other)][3], other)));
  await setTwin(asked.with);
  $("cavs").replaceChildren(...episode.cavs.map((id) => { const button = make("button", id); button.type = "button"; button.dataset.cav = id; button.addEventListener("click", () => choose(id)); return button; }));
  const named = decodeURIComponent(asked.cav || "");
  cav = episode.cavs.includes(named) ? named : episode.cavs.includes(cav) ? cav : episode.cavs[0] || "";
  now = Math.min(Math.max(parseFloat(asked.t) || 0, 0), episode.duration);
  if (fresh) { scrollTo(0, 0); $("name").focus({ preventScroll: true }); }
  show();
}

$("play").addEventListener("click", play);
$("back-step").addEventListener("click", () => hop(-1));
$("next-step").addEventListener("click", () => hop(1));
$("before").addEventListener("click", () => turn(-1));
$("after").addEventListener("click", () => turn(1));
$("scrub").addEventListener("input", () => go(parseFloat($("scrub").value)));
$("follow").addEventListener("change", draw);
$("twin").addEventListener("change", async () => { await setTwin($("twin").value); show(); note(); });
$("road").addEventListener("click", () => play());
addEventListener("keydown", (event) => {
  const target = event.target, typing = target.matches("select, input:not([type=range], [type=checkbox])");
  if (!episode || typing || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === " " && target.matches("button, summary, input[type=checkbox]") && target.id !== "play") return;
  const next = episode.cavs[(episode.cavs.indexOf(cav) + 1) % episode.cavs.length];
  const done = {
    " ": play, ArrowLeft: () => (event.shiftKey ? go(now - 0.1) : hop(-1)), ArrowRight: () => (event.shiftKey ? go(now + 0.1) : hop(1)),
    Home: () => go(0), End: () => go(episode.duration), c: () => choose(next), n: () => turn(1), p: () => turn(-1),
    f: () => { $("follow").checked = !$("follow").checked; draw(); }, Escape: () => { location.hash = "episodes"; },
  }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (done) { event.preventDefault(); done(); }
});
addEventListener("hashchange", follow);
addEventListener("resize", () => { shown = ""; if (episode) show(); });
$("theme").hidden = false;
paint(themes.includes(kept()) ? kept() : "system");
follow();
})();
