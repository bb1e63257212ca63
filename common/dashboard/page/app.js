// Wires the parts: a connection fills the store, and the page shows it.

import { ask, savePicture, takeToken } from "./actions.js";
import { Connection } from "./connection.js";
import { listen } from "./gestures.js";
import { MapView } from "./map_view.js";
import { $, showAnswer, showEvents, showLegend, showNodes, showPlaces, showScale, showTiming, STALE_S } from "./panel.js";
import { Store } from "./store.js";

const store = new Store();
const view = new MapView($("map"), store);
let connection = null;
let robot = "";
let paused = false;
let choosing = false;
let link = "connecting";
let lostAt = 0;
let wasLive = false;
let delay = null;
let shownMap = "";
let dirty = true;

// Theme: as the system says, unless somebody chose.
const system = matchMedia("(prefers-color-scheme: dark)");
const theme = () => localStorage.getItem("backcast-theme") ?? (system.matches ? "dark" : "light");
function applyTheme() {
  document.documentElement.dataset.theme = theme();
  view.theme(theme());
  dirty = true;
}
system.addEventListener("change", applyTheme);
const switchTheme = () => {
  localStorage.setItem("backcast-theme", theme() === "dark" ? "light" : "dark");
  applyTheme();
};

const handlers = {
  state(word) {
    if (word === link) return;
    if (word === "lost") {
      lostAt = Date.now();
      delay = null;
      if (wasLive) store.event("the connection was lost", "bad");
    } else if (word === "live") {
      store.event(wasLive ? "connected again" : `connected to ${robot}`);
    }
    wasLive ||= word === "live";
    link = word;
    showLink();
    dirty = true;
  },
  message(message) {
    if (paused) return;
    const part = store.receive(message);
    if (part === "snapshot" || part === "map") loadMap();
    dirty = true;
    view.draw();
  },
  image(buffer) {
    if (paused) return;
    store.image(buffer);
    view.paintField();
  },
  delay(ms) {
    delay = ms;
    showLink();
  },
};

/** Fetches the cells of a map that is not shown yet. */
async function loadMap() {
  const { map } = store;
  if (!map || map.id === shownMap) return;
  const wanted = (shownMap = map.id);
  try {
    const response = await fetch(`/api/v1/robots/${encodeURIComponent(robot)}/map`);
    const cells = new Uint8Array(await response.arrayBuffer());
    if (shownMap !== wanted) return;
    const sound = response.ok && cells.length === map.width * map.height;
    if (sound) return view.setCells(cells);
  } catch { /* Said by the connection. */ }
  shownMap = "";
}

function showLink() {
  document.body.dataset.link = link;
  const silence = store.silence();
  const silent = link === "live" && (silence === null || silence > STALE_S);
  document.body.toggleAttribute("data-silent", silent);
  const age = delay === null ? null : Math.round(delay + ((store.pose ?? store.answer)?.age_ms ?? 0));
  const live = age === null ? "live" : `live · ${age} ms`;
  const nothing = silence === null ? "no data yet" : `no data for ${Math.floor(silence)} s`;
  const words = { live: silent ? nothing : live, lost: "disconnected", connecting: "connecting", alone: "no robot yet" };
  $("link-text").textContent = paused && link === "live" ? "paused" : words[link];
  $("lost").hidden = link !== "lost";
  if (link === "lost") {
    const seconds = Math.floor((Date.now() - lostAt) / 1000);
    const since = wasLive ? `What you see is ${seconds} s old.` : "No data was received yet.";
    $("lost-text").textContent = `${since} Reconnecting.`;
  }
}

const PANEL_MS = 80; // nobody reads faster
let shownAt = 0;

/** Shows what has changed. */
function show(now) {
  requestAnimationFrame(show);
  if (!dirty || now - shownAt < PANEL_MS) return;
  dirty = false;
  shownAt = now;
  showAnswer(store);
  showPlaces(store);
  showTiming(store, theme());
  showNodes(store);
  showEvents(store);
  showLegend(store, view.layers, theme());
  $("region").disabled = !store.abilities.region;
  $("everywhere").disabled = !store.abilities.region || store.region.length === 0;
  $("save").disabled = !store.abilities.save;
  $("save").title = store.abilities.save ? "" : "No recorder keeps the last minutes: backcast run --record FILE --keep 10m";
  const word = link === "lost" ? "disconnected" : $("verdict").textContent.toLowerCase();
  const title = `${word} · ${robot} · Backcast`;
  if (document.title !== title) document.title = title;
}
setInterval(() => { dirty = true; showLink(); view.draw(); }, 500);

function watch(name) {
  connection?.close();
  robot = name;
  $("robot-name").textContent = name;
  shownMap = "";
  store.clear();
  view.setCells(null);
  setFollow(true);
  connection = new Connection(name, handlers);
  connection.field(view.layers.field);
}

const ROBOTS_MS = 1000; // how soon another robot is seen
let asked = new URLSearchParams(location.search).get("robot");

/** Finds the robots, also those that come later. */
async function find() {
  try {
    offer((await (await fetch("/api/v1/robots")).json()).robots);
  } catch {
    if (!robot) handlers.state("lost");
  }
  setTimeout(find, ROBOTS_MS);
}

function offer(robots) {
  const known = Array.from($("robot").options, ({ value }) => value);
  if (robots.join() !== known.join()) {
    $("robot").replaceChildren(...robots.map((name) => new Option(name, name)));
    $("robot").value = robot;
    $("robot").hidden = robots.length < 2;
    $("robot-name").hidden = robots.length >= 2;
  }
  const first = robots.includes(asked) ? asked : robot || robots[0];
  if (first === asked) asked = null;
  if (first && first !== robot) {
    $("robot").value = first;
    watch(first);
  } else if (!first) {
    handlers.state("alone");
  }
}

function start() {
  takeToken();
  applyTheme();
  find();
}

function setLayer(name, on = !view.layers[name]) {
  view.layers[name] = on;
  document.querySelector(`[data-layer="${name}"]`).setAttribute("aria-pressed", on);
  if (name === "field") {
    if (!on) store.field = null;
    connection?.field(on);
  }
  dirty = true;
  view.draw();
}

function setFollow(on) {
  view.follow = on;
  $("follow").setAttribute("aria-pressed", on);
  view.draw();
}

/** A paused page keeps what it shows; then it starts again. */
function setPaused(on) {
  paused = on;
  document.body.toggleAttribute("data-paused", on);
  $("pause").setAttribute("aria-pressed", on);
  $("pause").setAttribute("aria-label", on ? "Resume" : "Pause");
  showLink();
  if (!on) {
    connection?.close();
    connection = new Connection(robot, handlers);
    connection.field(view.layers.field);
  }
}

function setChoosing(on) {
  choosing = on;
  $("map").classList.toggle("choosing", on);
  $("hint").hidden = !on;
  $("hint").textContent = "Drag a box to search in, or press Enter for what is in view. Esc leaves.";
  if (!on) view.selection = null;
  view.draw();
}

async function searchIn(corners) {
  setChoosing(false);
  const [[x0, y0], [x1, y1]] = corners;
  if (Math.abs(x1 - x0) < 0.1 || Math.abs(y1 - y0) < 0.1) return;
  const rounded = corners.map((corner) => corner.map((metres) => Math.round(metres * 1000) / 1000));
  await ask(robot, "PUT", "region", { corners: rounded }, "Poses are searched in this region as soon as it is prepared.");
}

function picture() {
  const { answer } = store;
  const best = answer?.hypotheses[0]?.laser;
  const pose = best ? `x ${best.x.toFixed(2)} m, y ${best.y.toFixed(2)} m, ${((best.yaw * 180) / Math.PI).toFixed(1)}°` : "no pose";
  const stamp = answer ? new Date(answer.stamp_s * 1000).toISOString() : "";
  savePicture($("map"), view.colors, `${robot}   ${answer?.verdict ?? ""}   ${pose}   ${stamp}`, view.ratio);
}

listen(view, { choosing: () => choosing, chosen: searchIn, moved: () => setFollow(false) });
view.ondrawn = () => showScale(view.camera);
const zoom = (factor) => { view.camera.zoom(factor); view.draw(); };
const fit = () => { setFollow(false); view.fit(); };
for (const button of document.querySelectorAll("[data-layer]")) button.onclick = () => setLayer(button.dataset.layer);
$("zoom-in").onclick = () => zoom(1.5);
$("zoom-out").onclick = () => zoom(1 / 1.5);
$("fit").onclick = fit;
$("follow").onclick = () => setFollow(!view.follow);
$("pause").onclick = () => setPaused(!paused);
$("picture").onclick = picture;
$("theme").onclick = switchTheme;
$("help").onclick = () => $("keys-dialog").showModal();
$("robot").onchange = () => {
  asked = null;
  watch($("robot").value);
};
$("region").onclick = () => { setChoosing(!choosing); $("map").focus(); };
$("everywhere").onclick = () => ask(robot, "DELETE", "region", null, "Poses are searched everywhere again.");
$("save").onclick = () => ask(robot, "POST", "save", null, "The recorder saves the last minutes.");

const STEP = 80; // pixels
const KEYS = {
  ArrowLeft: () => view.camera.pan(STEP, 0), ArrowRight: () => view.camera.pan(-STEP, 0),
  ArrowUp: () => view.camera.pan(0, STEP), ArrowDown: () => view.camera.pan(0, -STEP),
  "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8), 0: fit,
  f: () => setFollow(!view.follow), p: picture, t: switchTheme, " ": () => setPaused(!paused),
  1: () => setLayer("beams"), 2: () => setLayer("hypotheses"), 3: () => setLayer("track"), 4: () => setLayer("field"),
  "?": () => $("keys-dialog").showModal(), Escape: () => setChoosing(false),
};
document.addEventListener("keydown", (event) => {
  const target = event.target;
  const typing = target.closest("input, select, dialog") || event.ctrlKey || event.metaKey || event.altKey;
  const arrows = event.key.startsWith("Arrow");
  // A button takes the space and enter keys, and what scrolls takes the arrows.
  if (typing || (target.closest("button") && event.key === " ") || (arrows && target.closest(".events"))) return;
  if (event.key === "Enter" && choosing && target === $("map")) {
    const { width, height } = view.camera;
    searchIn([view.camera.toMap(0, height), view.camera.toMap(width, 0)]);
  }
  const act = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (!act) return;
  event.preventDefault();
  if (arrows) setFollow(false);
  act();
  view.draw();
});

start();
requestAnimationFrame(show);
