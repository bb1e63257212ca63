// The lists of the panel beside the map: places, times, nodes, log.

import { $, element, replace, write } from "./dom.js";
import { FATES, palette } from "./colors.js";
import { candidates, inFrame } from "./situation.js";
import { clock, degrees, duration, fixed, percent } from "./words.js";

const PLACES = 8;

/** `chosen(i)` is called with the number of a place. */
export function showPlaces(store, frame, chosen) {
  const all = store.answer?.hypotheses ?? [];
  const places = candidates(store);
  const shown = places.slice(0, PLACES).map((place) => ({ ...inFrame(place, frame), place }));
  write("place-count", all.length ? `${all.length} of the last scan searched, ${shown[0]?.frame ?? ""}` : "");
  const rows = shown.map(({ x, y, yaw, place }) => [
    fixed(x, 1), fixed(y, 1), `${fixed(degrees(yaw), 0)}°`, fixed(place.score, 2), percent(place.probability)]);
  replace($("places"), JSON.stringify(rows), () => rows.map(([x, y, yaw, score, probability], i) => element("tr", { className: "num" },
    element("th", { scope: "row" }, element("button", {
      "data-focus": `place ${i}`, "aria-label": `Inspect place ${i + 1}`, onclick: () => chosen(i) }, String(i + 1))),
    ...[x, y, yaw, score].map((text) => element("td", {}, text)), element("td", {}, element("b", {}, probability)))));
  $("places-table").hidden = !rows.length;
  const [worse, hidden] = [places.length - shown.length, all.length - places.length];
  const notes = [worse > 0 ? `${worse} more fit worse` : "", hidden > 0 ? `${hidden} below 1 % are hidden` : "", all.length ? "" : "none"];
  write("places-note", notes.filter(Boolean).join(", "));
}

export function showTiming({ answer, latencies }, theme) {
  const last = latencies.at(-1);
  write("latency", last === undefined ? "–" : fixed(last, last < 100 ? 1 : 0));
  const sorted = [...latencies].sort((a, b) => a - b);
  const at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))];
  $("timing").textContent = sorted.length && answer
    ? `median ${fixed(at(0.5), 1)}, max ${fixed(at(1), 1)} · search ${fixed(answer.search_cpu_ms, 1)}, fit ${fixed(answer.extract_cpu_ms, 1)}` : "";
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
  const top = Math.max(...values, 1) * 1.1;
  const x = (i) => width - 2 - ((values.length - 1 - i) * (width - 4)) / 119;
  const y = (v) => height - 2 - (v / top) * (height - 6);
  c.beginPath();
  values.forEach((v, i) => c.lineTo(x(i), y(v)));
  c.strokeStyle = colors.accent;
  c.lineWidth = 1.5;
  c.lineJoin = "round";
  c.stroke();
  c.lineTo(x(values.length - 1), height);
  c.lineTo(x(0), height);
  c.fillStyle = colors.accentSoft;
  c.fill();
}

/** The last report of each; whoever never reported is not known here. */
export function showNodes({ robot, nodes, answer, abilities }, restart) {
  const all = [...nodes.values()].sort((a, b) => a.name.localeCompare(b.name));
  const well = all.filter(({ state }) => state === "ready").length;
  write("node-count", all.length ? `${well} of ${all.length} ready` : robot ? "none has reported: not started" : "not known");
  const took = { accumulator: answer?.search_cpu_ms, peak_extractor: answer?.extract_cpu_ms };
  const rows = all.map((node) => nodeWords(node, took[node.name]));
  const button = abilities.restart ? restart : null;
  replace($("nodes"), JSON.stringify([rows, abilities.restart]), () => rows.map((row) => nodeRow(row, button)));
}

/** What is recorded, or why nothing can be. */
export function showRecording(recording) {
  const { file, size_mb, refused } = recording ?? {};
  $("record").disabled = !recording || Boolean(refused && !file);
  $("record").title = recording ? refused ?? "" : "No launcher records: backcast run --record FILE";
  write("record", file ? "Stop recording" : "Record");
  const size = size_mb ? `, ${fixed(size_mb, 1)} MB` : "";
  write("recording", file ? `Recording to ${file}${size}` : refused ? `Cannot record: ${refused}` : "");
}

function nodeWords(node, took) {
  const rates = [];
  if (node.received_hz) rates.push(`${fixed(node.received_hz, 1)} in`);
  if (node.sent_hz) rates.push(`${fixed(node.sent_hz, 1)} out`);
  const done = [];
  if (rates.length) done.push(`${rates.join(", ")} a second`);
  if (took !== undefined) done.push(`${fixed(took, 1)} ms`);
  const troubles = [];
  if (node.dropped) troubles.push(`${node.dropped} lost`);
  if (node.refused) troubles.push(`${node.refused} rejected`);
  if (node.restarts) troubles.push(`started again ${node.restarts}×`);
  const quiet = node.state === "silent" ? ` for ${duration((performance.now() - node.at) / 1000)}` : "";
  const error = node.last_error && (node.state === "ready" ? `earlier: ${node.last_error}` : node.last_error);
  return { name: node.name, state: node.state, quiet, done: done.join(" · "), troubles: troubles.join(", "), error };
}

function nodeRow({ name, state, quiet, done, troubles, error }, restart) {
  const more = element("div", { className: "more num" }, done);
  if (troubles) more.append(done ? " · " : "", element("b", {}, troubles));
  const row = element("li", { "data-state": state, "data-node": name },
    element("div", { className: "name" }, element("i"), element("span", {}, name), element("em", {}, state + quiet)));
  // The launcher itself has no launcher.
  if (restart && state !== "ready" && name !== "backcast") row.firstChild.append(element("button", { "data-focus": `restart ${name}`, "aria-label": `Restart ${name}`, onclick: () => restart(name) }, "restart"));
  if (more.textContent) row.append(more);
  if (error) row.append(element("div", { className: "more error" }, error));
  return row;
}

const LEVELS = ["faint", "info", "good", "warn", "bad"];
const AROUND_MS = 10000; // of the log, before and after a moment

/** The lines of the log from a level on, of a node, and around a period if one is given. */
export function showEvents({ events }, period, ends) {
  const names = [...new Set(events.map(({ node }) => node))].sort();
  replace($("log-node"), names.join(), () => [new Option("all nodes", ""), ...names.map((name) => new Option(name, name))]);
  const [least, node] = [Number($("log-level").value), $("log-node").value];
  const wall = (at) => Date.now() - performance.now() + at;
  const [from, to] = period ? [wall(period.at) - AROUND_MS, wall(ends ?? performance.now()) + AROUND_MS] : [-Infinity, Infinity];
  const rows = events.filter((event) => LEVELS.indexOf(event.level) >= least && (!node || event.node === node)
    && event.at >= from && event.at <= to);
  const key = `${events.length} ${events[0]?.at.getTime()} ${events[0]?.text} ${rows.length} ${least} ${node} ${period?.at}`;
  replace($("events"), key, () => rows.map(({ at, text, level, node }) => element("li", { "data-level": level },
    element("time", {}, clock(at)),
    element("span", {}, text.startsWith(node) || node === "page" ? text : `${node}: ${text}`))));
  write("log-count", period ? "around that moment" : rows.length < events.length ? `${rows.length} of ${events.length}` : "");
}

/** What the colours of the beams mean, for those that there are. */
export function showLegend({ beams }, shown, theme) {
  const { beams: colors } = palette(theme);
  const kinds = shown ? Object.keys(FATES).filter((kind) => beams.fate.includes(kind)) : [];
  const key = `${theme}${kinds}`;
  if ($("legend").dataset.key === key) return;
  $("legend").dataset.key = key;
  $("legend").replaceChildren(...kinds.map((kind) => element("span", {}, dot(colors[kind]), FATES[kind])));
}

function dot(color) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  const circle = document.createElementNS(space, "circle");
  for (const [name, value] of [["cx", 5], ["cy", 5], ["r", 4.5], ["fill", color]]) circle.setAttribute(name, value);
  svg.setAttribute("viewBox", "0 0 10 10");
  svg.append(circle);
  return svg;
}

/** A bar as long as a round number of metres. */
export function showScale(camera) {
  const step = camera.step();
  $("scale").style.width = `${step * camera.scale}px`;
  write("scale-text", step < 1 ? `${step * 100} cm` : `${step} m`);
}
