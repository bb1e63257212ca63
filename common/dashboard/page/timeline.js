// The states of the last hour, and a look at one of them.

import { $, element, replace, write } from "./dom.js";
import { palette } from "./colors.js";
import { clock, degrees, duration, fixed, gravity, sentence, STATES } from "./words.js";

const HOUR_S = 3600;
const RECENT_S = 300;
const LISTED = 4;
const NEAR_PX = 12; // so near a click means a moment when it was lost
const HEIGHTS = [0.4, 0.7, 1, 0.2]; // by gravity: colours alone do not say it

/** Periods of the last `span` seconds with their ends, seconds ago, oldest first. */
function periods({ states }, now, span) {
  const ago = (at) => Math.max(0, (now - at) / 1000);
  return states.map((period, i) => ({
    ...period, i, from: ago(period.at), to: i + 1 < states.length ? ago(states[i + 1].at) : 0,
  })).filter(({ to }) => to < span);
}

const wordOf = (state) => STATES[state]?.word ?? state;
const timeOf = (secondsAgo) => clock(new Date(Date.now() - 1000 * secondsAgo));

/** Which period is shown: the one that began then, or none. */
export class Timeline {
  #selected = null; // when it began
  #span = HOUR_S; // what the canvas covers

  /** `shown(period, before, after)` is called with what is selected; without, at the end. */
  constructor(store, shown) {
    this.store = store;
    this.shown = shown;
    this.canvas = $("timeline");
    this.canvas.addEventListener("click", ({ offsetX }) => this.#click(offsetX));
    this.canvas.addEventListener("keydown", (event) => this.#key(event));
    $("now").onclick = () => this.select(null);
    $("recent").onclick = () => this.#cover(this.#span === HOUR_S ? RECENT_S : HOUR_S);
  }

  get isOpen() {
    return this.#selected !== null;
  }

  select(period) {
    this.#selected = period?.at ?? null;
    if (!period) return this.shown(null);
    const { states } = this.store;
    const at = states.findIndex((other) => other.at === period.at);
    this.shown(states[at], states[at - 1], states[at + 1]);
  }

  #cover(span) {
    this.#span = span;
    $("recent").setAttribute("aria-pressed", span === RECENT_S);
    write("hour-title", span === RECENT_S ? "Last 5 minutes" : "Last hour");
    write("span-begin", span === RECENT_S ? "5 minutes ago" : "an hour ago");
    this.canvas.setAttribute("aria-valuemin", -span);
    this.show();
  }

  #click(x) {
    const all = periods(this.store, performance.now(), this.#span);
    const seconds = (1 - x / this.canvas.clientWidth) * this.#span;
    const near = (NEAR_PX / this.canvas.clientWidth) * this.#span;
    const meant = (p) => p.to <= seconds && seconds < p.from;
    const lost = all.filter(({ state, from, to }) => state === "Lost" && to - near <= seconds && seconds <= from + near);
    this.select(lost.at(-1) ?? all.find(meant) ?? null);
  }

  #key(event) {
    const all = periods(this.store, performance.now(), this.#span);
    if (!all.length) return;
    const at = all.findIndex(({ at }) => at === this.#selected);
    const from = at < 0 ? all.length : at;
    const to = { ArrowLeft: Math.max(0, from - 1), ArrowRight: from + 1, Home: 0, End: all.length, Escape: all.length }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.select(all[to] ?? null);
    this.show();
  }

  show(theme = document.documentElement.dataset.theme) {
    const now = performance.now();
    const all = periods(this.store, now, this.#span);
    draw(this.canvas, all, this.#selected, palette(theme), this.#span);
    const selected = all.find(({ at }) => at === this.#selected);
    if (this.isOpen && !selected) this.select(null);
    const text = selected ? spoken(selected) : all.length ? `Now: ${wordOf(all.at(-1).state)}` : "Nothing yet";
    this.canvas.setAttribute("aria-valuetext", text);
    this.canvas.setAttribute("aria-valuenow", selected ? -Math.round(selected.from) : 0);
    const lost = all.filter(({ state }) => state === "Lost");
    write("lost-count", lost.length ? `lost ${lost.length}×` : all.length ? "never lost" : "");
    const rows = lost.slice(-LISTED).reverse();
    const key = rows.map(({ at, to }) => `${at} ${to > 0}`).join();
    replace($("lost-moments"), key, () => rows.map((period) => element("li", {}, element("button", {
      "data-focus": String(period.at), onclick: () => this.select(period),
    }, `Lost ${timeOf(period.from)}`, element("span", { className: "faint" }, period.to ? `for ${duration(period.from - period.to)}` : "still")))));
    $("moment").hidden = !selected;
    if (selected) showMoment(selected, this.store.states);
  }
}

const spoken = ({ state, from, to }) => `${wordOf(state)} at ${timeOf(from)}, ${to ? `for ${duration(from - to)}` : "still"}`;

function showMoment(period, states) {
  const [before, after] = [states[period.i - 1], states[period.i + 1]];
  write("moment-title", spoken(period));
  write("moment-why", sentence(period.why));
  const at = (pose) => `x ${fixed(pose.x, 2)} m, y ${fixed(pose.y, 2)} m, ${fixed(degrees(pose.yaw), 0)}°`;
  const known = ({ state } = {}) => gravity(state) === 0;
  const lines = [
    known(before) && before.last ? `Last known place: ${at(before.last)}` : "",
    known(period) && period.first ? `At first: ${at(period.first)}` : "",
    known(period) && period.last ? `At last: ${at(period.last)}` : "",
    known(after) && after.first ? `Found again: ${at(after.first)}` : "",
  ].filter(Boolean);
  replace($("moment-places"), lines.join("\n"), () => lines.map((line) => element("li", { className: "num" }, line)));
}

/** Where the robot was around a period, to be marked on the map. */
export function flagsOf(period, before, after) {
  if (!period) return [];
  const known = ({ state } = {}) => gravity(state) === 0;
  const flag = (pose, text) => (pose ? [{ ...pose, text }] : []);
  if (known(period)) return [...flag(period.first, "at first"), ...flag(period.last, "at last")];
  return [...(known(before) ? flag(before.last, "last known") : []), ...(known(after) ? flag(after.first, "found again") : [])];
}

function draw(canvas, all, selected, colors, span) {
  const ratio = Math.min(3, window.devicePixelRatio || 1);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const c = canvas.getContext("2d");
  c.scale(ratio, ratio);
  const x = (ago) => width * (1 - Math.min(span, ago) / span);
  const fills = [colors.accent, colors.beams.s, colors.beams.t, colors.soft];
  const bottom = height - 4;
  // What is graver lies on top, and is never too narrow to see.
  for (const period of [...all].sort((a, b) => gravity(a.state) % 3 - gravity(b.state) % 3)) {
    const grave = gravity(period.state);
    const top = bottom - (bottom - 4) * HEIGHTS[grave];
    c.fillStyle = fills[grave];
    c.fillRect(x(period.from), top, Math.max(1.5, x(period.to) - x(period.from)), bottom - top);
    if (period.at !== selected) continue;
    c.strokeStyle = colors.ink;
    c.lineWidth = 2;
    c.strokeRect(x(period.from) - 2, 1, Math.max(5, x(period.to) - x(period.from) + 4), height - 2);
  }
  c.strokeStyle = colors.soft;
  c.lineWidth = 1;
  c.beginPath();
  c.moveTo(0, bottom + 0.5);
  c.lineTo(width, bottom + 0.5);
  c.stroke();
}
