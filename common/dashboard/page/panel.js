// The panel beside the map.

import { FATES, palette } from "./colors.js";

const PLACES = 6;
export const STALE_S = 2; // without a scan: nothing is live any more

export const $ = (id) => document.getElementById(id);

/** Writes only what changes: what is read aloud is read once. */
function write(id, text) {
  if ($(id).textContent !== text) $(id).textContent = text;
}

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("data-")) made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

/** A number with a true minus, and none before zero. */
function fixed(value, digits) {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A share in words that distinguish almost none from none. */
const percent = (share) => (share > 0 && share < 0.005 ? "<1 %" : `${Math.round(share * 100)} %`);
const degrees = (radians) => (radians * 180) / Math.PI;

/** A stamp as a time of day here. */
function clock(seconds) {
  const date = new Date(seconds * 1000);
  const tenths = Math.floor((((seconds % 1) + 1) % 1) * 10);
  return `${date.toLocaleDateString("en-CA")} ${date.toLocaleTimeString("en-GB")}.${tenths}`;
}

const WORDS = { PoorFit: "Poor fit", NoScan: "No scan" };

/** What is said of the pose: by the tracker or, without one, of the last scan. */
function verdict({ pose, answer }) {
  if (pose) return { word: pose.state, kind: pose.state, says: pose.says };
  if (answer) return { word: WORDS[answer.verdict] ?? answer.verdict, kind: answer.verdict, says: answer.says };
  return null;
}

export function showAnswer(store) {
  const { answer, pose } = store;
  const silence = store.silence();
  const stale = silence === null || silence > STALE_S;
  const is = verdict(store);
  $("verdict-card").classList.toggle("stale", stale);
  if (!is) {
    write("verdict", "Waiting");
    $("verdict").dataset.verdict = "";
    write("says", "Waiting for the first scan.");
  } else {
    write("verdict", stale ? "No data" : is.word);
    $("verdict").dataset.verdict = stale ? "" : is.kind;
    write("says", stale ? `No scan for ${Math.floor(silence ?? 0)} s. Last: ${sentence(is.says)}` : sentence(is.says));
  }
  write("stamp", pose ? clock(pose.stamp_s) : answer ? clock(answer.stamp_s) : "");
  const best = store.best();
  write("pose-x", fixed(best?.laser.x, 2));
  write("pose-y", fixed(best?.laser.y, 2));
  write("pose-yaw", fixed(best && degrees(best.laser.yaw), 1));
  const ellipse = best?.ellipse;
  $("spread").textContent = ellipse
    ? `± ${fixed(ellipse.major_m * 100, 1)} cm along, ${fixed(ellipse.minor_m * 100, 1)} cm across, ${fixed(degrees(ellipse.yaw), 2)}°` : "";
  write("single", pose && answer ? `Single scan: ${WORDS[answer.verdict] ?? answer.verdict}, ${sentence(answer.says)}` : "");
}

const sentence = (text) => (/[.?!]$/.test(text) ? text : `${text}.`);

export function showPlaces({ answer }) {
  const places = answer?.hypotheses ?? [];
  write("place-count", `${places.length || ""}`);
  const rows = places.slice(0, PLACES).map(({ laser, score, probability }, i) => element("li", { className: "num" },
    element("i", {}, String(i + 1)),
    element("span", {}, `${fixed(laser.x, 1)}, ${fixed(laser.y, 1)}, ${fixed(degrees(laser.yaw), 0)}°`),
    element("progress", { max: 1, value: Math.max(0, Math.min(1, score)), title: `score ${fixed(score, 2)}` }),
    element("b", { title: "probability" }, percent(probability))));
  if (places.length > PLACES) rows.push(element("li", { className: "more" }, `and ${places.length - PLACES} that fit worse`));
  if (!places.length) rows.push(element("li", { className: "more" }, "none"));
  $("places").replaceChildren(...rows);
}

export function showTiming({ answer, latencies }, theme) {
  const last = latencies.at(-1);
  write("latency", last === undefined ? "–" : fixed(last, last < 100 ? 1 : 0));
  const sorted = [...latencies].sort((a, b) => a - b);
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))];
  $("timing").textContent = sorted.length && answer
    ? `median ${fixed(at(0.5), 1)}, max ${fixed(at(1), 1)} · search ${fixed(answer.search_ms, 1)}, fit ${fixed(answer.extract_ms, 1)}` : "";
  drawSpark($("spark"), latencies, palette(theme));
}

function drawSpark(canvas, values, colors) {
  const ratio = Math.min(3, window.devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  if (values.length < 2) return;
  const c = canvas.getContext("2d");
  c.scale(ratio, ratio);
  const top = Math.max(...values, 1) * 1.100;
  const x = (i) => width - 2 - ((values.length - 1 - i) * (width - 4)) / 119;
  const y = (v) => height - 2 - (v / top) * (height - 6);
  c.beginPath();
  values.forEach((v, i) => c.lineTo(x(i), y(v)));
  c.strokeStyle = colors.accent;
  c.lineWidth = 1.500;
  c.lineJoin = "round";
  c.stroke();
  c.lineTo(x(values.length - 1), height);
  c.lineTo(x(0), height);
  c.fillStyle = colors.accentSoft;
  c.fill();
}

export function showNodes({ nodes, answer }) {
  const all = [...nodes.values()].sort((a, b) => a.name.localeCompare(b.name));
  const well = all.filter(({ state }) => state === "ready").length;
  write("node-count", all.length ? `${well} of ${all.length} ready` : "");
  const took = { accumulator: answer?.search_ms, peak_extractor: answer?.extract_ms };
  $("nodes").replaceChildren(...all.map((node) => nodeRow(node, took[node.name])));
}

function nodeRow(node, took) {
  const rates = [];
  if (node.received_hz) rates.push(`${fixed(node.received_hz, 1)} in`);
  if (node.sent_hz) rates.push(`${fixed(node.sent_hz, 1)} out`);
  const facts = [];
  if (rates.length) facts.push(`${rates.join(", ")} a second`);
  if (took !== undefined) facts.push(`${fixed(took, 1)} ms`);
  const troubles = [];
  if (node.dropped) troubles.push(`${node.dropped} lost`);
  if (node.refused) troubles.push(`${node.refused} refused`);
  if (node.restarts) troubles.push(`started again ${node.restarts}×`);
  const more = element("div", { className: "more num" }, facts.join(" · "));
  if (troubles.length) more.append(facts.length ? " · " : "", element("b", {}, troubles.join(", ")));
  const row = element("li", { "data-state": node.state, "data-node": node.name },
    element("div", { className: "name" }, element("i"), element("span", {}, node.name), element("em", {}, node.state)));
  if (more.textContent) row.append(more);
  if (node.last_error) {
    const past = node.state === "ready" ? "earlier: " : "";
    row.append(element("div", { className: "more error" }, past + node.last_error));
  }
  return row;
}

let shownEvents = null;

export function showEvents({ events }) {
  if (events === shownEvents) return;
  shownEvents = events;
  $("events").replaceChildren(...events.map(({ at, text, level }) => element("li", { "data-level": level },
    element("time", {}, at.toLocaleTimeString("en-GB")), element("span", {}, text))));
}

/** What the colours of the beams mean, for those that there are. */
export function showLegend({ beams }, layers, theme) {
  const { beams: colors } = palette(theme);
  const kinds = layers.beams && beams ? Object.keys(FATES).filter((kind) => beams.fate.includes(kind)) : [];
  const key = `${theme}${kinds}`;
  if ($("legend").dataset.key === key) return;
  $("legend").dataset.key = key;
  $("legend").replaceChildren(...kinds.map((kind) => element("span", {}, dot(colors[kind]), FATES[kind])));
}

function dot(color) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  const circle = document.createElementNS(space, "circle");
  for (const [name, value] of [["cx", 5], ["cy", 5], ["r", 4.500], ["fill", color]]) circle.setAttribute(name, value);
  svg.setAttribute("viewBox", "0 0 10 10");
  svg.append(circle);
  return svg;
}

/** A bar as long as a round number of metres. */
export function showScale(camera) {
  const step = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((m) => m * camera.scale >= 60) ?? 1000;
  $("scale").style.width = `${step * camera.scale}px`;
  $("scale").firstElementChild.textContent = step < 1 ? `${step * 100} cm` : `${step} m`;
}
