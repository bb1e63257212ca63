// Wires the parts: a connection fills the store, and the page shows it.

import { ask, savePicture, takeToken } from "./actions.js";
import { Connection } from "./connection.js";
import { listen } from "./gestures.js";
import { headingOf, MapView } from "./map_view.js";
import { $, write } from "./dom.js";
import * as inspector from "./inspect.js";
import { keys } from "./keys.js";
import * as notify from "./notify.js";
import { showEvents, showLegend, showNodes, showPlaces, showRecording, showScale, showTiming } from "./panel.js";
import { inFrame, situation } from "./situation.js";
import { showState } from "./state_card.js";
import { Store } from "./store.js";
import { flagsOf, Timeline } from "./timeline.js";
import { degrees, duration, fixed } from "./words.js";

const store = new Store();
const view = new MapView($("map"), store);
const timeline = new Timeline(store, showMoment);
let connection = null;
let robot = "";
let paused = false;
let link = "connecting";
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
    if (word === "lost" || word === "stopped") {
      delay = null;
      if (wasLive) store.event(word === "stopped" ? "the graph was stopped" : "the connection was lost", "bad");
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
  if (!map || map.map_id === shownMap) return;
  const wanted = (shownMap = map.map_id);
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
  const is = situation(store, link, paused);
  const silent = link === "live" && is.stale;
  document.body.toggleAttribute("data-silent", silent);
  document.body.toggleAttribute("data-well", link === "live" && Boolean(is.well));
  const age = delay === null ? null : Math.round(delay + ((store.pose ?? store.answer)?.age_ms ?? 0));
  const live = age === null ? "live" : `live · ${age} ms`;
  const nothing = is.silence === null ? "no data yet" : `no data for ${duration(is.silence)}`;
  const words = { live: silent ? nothing : live, lost: "disconnected", stopped: "stopped", connecting: "connecting", alone: "no robot yet" };
  write("link-text", paused && link === "live" ? "Paused" : words[link]);
  $("lost").hidden = link !== "lost";
  if (link === "lost") {
    const since = is.silence === null ? "No data was received yet." : `What you see is ${duration(is.silence)} old.`;
    write("lost-text", `${since} Reconnecting.`);
  }
  $("past").hidden = !silent || is.silence === null;
  write("past", `${is.word} · ${duration(is.silence ?? 0)} old`);
  notify.tell(robot, is); // here, too: hidden pages draw nothing
}

const PANEL_MS = 80; // nobody reads faster
let shownAt = 0;

/** Shows what has changed. */
function show(now) {
  requestAnimationFrame(show);
  if (!dirty || now - shownAt < PANEL_MS) return;
  dirty = false;
  shownAt = now;
  const is = situation(store, link, paused);
  showState(store, is, view.frame);
  notify.tell(robot, is);
  showPlaces(store, view.frame, (i) => look({ kind: "place", i }, true));
  timeline.show(theme());
  showTiming(store, theme());
  showNodes(store, restart);
  showEvents(store, moment, momentEnds);
  showLegend(store, view.beamsShown(), theme());
  $("hint-button").disabled = !store.abilities.hint;
  $("region").disabled = !store.abilities.region;
  $("everywhere").disabled = !store.abilities.region || store.region.length === 0;
  $("save").disabled = !store.abilities.save;
  $("save").title = store.abilities.save ? "" : "No recorder keeps the last minutes: backcast run --record FILE --keep 10m";
  showRecording(store.recording);
  $("graph-name").hidden = !store.graph;
  write("graph-name", store.graph ?? "");
  const title = [is.word.toLowerCase(), robot, store.graph, "Backcast"].filter(Boolean).join(" · ");
  if (document.title !== title) document.title = title;
}
setInterval(() => { dirty = true; showLink(); view.draw(); }, 500);

function watch(name) {
  connection?.close();
  robot = name;
  $("robot-name").textContent = name;
  shownMap = "";
  store.clear();
  timeline.select(null);
  inspector.close(view);
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

let moment = null; // the period that is looked at
let momentEnds = null;

/** Shows where the robot was around a period; without one, where it is. */
function showMoment(period, before, after) {
  if (!period && !moment) return;
  moment = period;
  momentEnds = after?.at ?? null;
  view.flags = flagsOf(period, before, after);
  if (view.flags.length) view.fitPoints(view.flags);
  setFollow(!period);
  dirty = true;
}

/** Shows a place or a beam in numbers and, if it is `far` perhaps, where it is. */
function look(what, far = false) {
  inspector.inspect(store, view, what);
  if (far && view.inspected && !view.camera.sees(...view.inspected)) {
    setFollow(false);
    [view.camera.x, view.camera.y] = view.inspected;
  }
  view.draw();
}

function setFrame(name) {
  view.frame = name;
  inspector.close(view);
  dirty = true;
}

/** Where the pointer or, with keys, the middle is. */
function showCursor(at) {
  view.cross = at === "middle";
  const point = view.cross ? [view.camera.x, view.camera.y] : at;
  write("cursor", point ? `x ${fixed(point[0], 2)} m, y ${fixed(point[1], 2)} m` : "");
}

function start() {
  takeToken();
  notify.start();
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

const HOW = {
  region: "Drag a box to search in, or press Enter for what is in view. Esc leaves.",
  hint: "Drag from where the robot is to where it looks, or press Enter for each. Esc leaves.",
};

/** Begins to choose a region or the pose of a hint; with an empty word, ends it. */
function setChoosing(what) {
  view.choosing = what;
  view.selection = null;
  $("map").classList.toggle("choosing", Boolean(what));
  $("hint").hidden = !what;
  $("hint").textContent = HOW[what] ?? "";
  if (what) setFollow(false);
  view.draw();
}

const AIMED_PX = 12; // a shorter drag has no direction

/** Restarts a node after a confirmation. */
async function restart(node) {
  if (!confirm(`Restart ${node}?`)) return;
  await ask(robot, "POST", `nodes/${encodeURIComponent(node)}/restart`, null, `${node} is restarted.`);
}

/** Starts a recording; stops one after a confirmation. */
async function record() {
  const file = store.recording?.file;
  if (!file) return ask(robot, "POST", "recording", null, "The recording begins.");
  if (confirm(`Stop recording ${file}?`)) await ask(robot, "DELETE", "recording", null, `The recorder finishes ${file}.`);
}

/** Takes where a drag began and ended. */
function chosen(corners) {
  const what = view.choosing;
  setChoosing("");
  return what === "hint" ? hintAt(corners) : searchIn(corners);
}

async function hintAt(corners) {
  const [[x, y], [x1, y1]] = corners;
  if (view.camera.scale * Math.hypot(x1 - x, y1 - y) < AIMED_PX) {
    $("actions-note").textContent = "Drag from where the robot is to where it looks.";
    return;
  }
  await ask(robot, "POST", "hint", { x, y, yaw: headingOf(corners) }, "The tracker looks there first, and takes the pose if scans confirm it.");
}

async function searchIn(corners) {
  const [[x0, y0], [x1, y1]] = corners;
  if (Math.abs(x1 - x0) < 0.1 || Math.abs(y1 - y0) < 0.1) return;
  const rounded = corners.map((corner) => corner.map((metres) => Math.round(metres * 1000) / 1000));
  await ask(robot, "PUT", "region", { corners: rounded }, "Poses are searched in this region as soon as it is prepared.");
}

function picture() {
  const { answer } = store;
  const is = situation(store, link, paused);
  const best = is.known ? inFrame(store.best(), view.frame) : null;
  const pose = best ? `${best.frame} x ${fixed(best.x, 2)} m, y ${fixed(best.y, 2)} m, ${fixed(degrees(best.yaw), 1)}°` : "pose not known";
  const stamp = answer ? new Date(answer.stamp_ns / 1e6).toISOString() : "";
  savePicture($("map"), view.colors, [robot, store.graph, is.word, pose, stamp].filter(Boolean).join("   "), view.ratio);
}

listen(view, {
  choosing: () => Boolean(view.choosing), chosen, moved: () => setFollow(false),
  clicked: (px, py) => look(view.pick(px, py)), pointed: showCursor,
});
view.ondrawn = () => {
  showScale(view.camera);
  if (view.cross) showCursor("middle");
};
const zoom = (factor) => { view.camera.zoom(factor); view.draw(); };
const fit = () => { setFollow(false); view.fit(); };
const leave = () => {
  if (view.choosing) setChoosing("");
  else if (inspector.isOpen()) inspector.close(view);
  else timeline.select(null);
};
for (const button of document.querySelectorAll("[data-layer]")) button.onclick = () => setLayer(button.dataset.layer);
for (const button of $("frames").querySelectorAll("button")) button.onclick = () => setFrame(button.dataset.frame);
$("zoom-in").onclick = () => zoom(1.5);
$("zoom-out").onclick = () => zoom(1 / 1.5);
$("fit").onclick = fit;
$("follow").onclick = () => setFollow(!view.follow);
$("pause").onclick = () => setPaused(!paused);
$("picture").onclick = picture;
$("theme").onclick = switchTheme;
$("help").onclick = () => $("keys-dialog").showModal();
$("inspect-close").onclick = () => { inspector.close(view); $("map").focus(); };
$("beam-before").onclick = () => { inspector.step(view, -1); view.draw(); };
$("beam-after").onclick = () => { inspector.step(view, 1); view.draw(); };
$("log-level").onchange = $("log-node").onchange = () => { dirty = true; };
$("map").onblur = () => { showCursor(null); view.draw(); };
$("robot").onchange = () => {
  asked = null;
  watch($("robot").value);
};
const choose = (what) => { setChoosing(view.choosing === what ? "" : what); $("map").focus(); };
$("region").onclick = () => choose("region");
$("hint-button").onclick = () => choose("hint");
$("everywhere").onclick = () => ask(robot, "DELETE", "region", null, "Poses are searched everywhere again.");
$("record").onclick = record;
$("save").onclick = () => ask(robot, "POST", "save", null, "The recorder saves the last minutes.");

keys({
  move(dx, dy) {
    setFollow(false);
    view.camera.pan(dx, dy);
    if (view.selection) view.selection[1] = [view.camera.x, view.camera.y];
    showCursor("middle");
  },
  enter() {
    const { width, height } = view.camera;
    const middle = view.camera.toMap(width / 2, height / 2);
    if (view.choosing === "hint" && !view.selection) view.selection = [middle, middle];
    else if (view.choosing === "hint") chosen([view.selection[0], middle]);
    else if (view.choosing) chosen([view.camera.toMap(0, height), view.camera.toMap(width, 0)]);
    else look(view.pick(width / 2, height / 2));
  },
  zoom, fit, picture, leave,
  follow: () => setFollow(!view.follow),
  theme: switchTheme,
  pause: () => setPaused(!paused),
  layer: setLayer,
  frame: () => setFrame(view.frame === "laser" ? "base_link" : "laser"),
  help: () => $("keys-dialog").showModal(),
  drawn: () => view.draw(),
});

start();
requestAnimationFrame(show);
