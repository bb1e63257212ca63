// A place or a beam that somebody clicked, in numbers.

import { $, facts } from "./dom.js";
import { FATES } from "./colors.js";
import { beamEnds } from "./map_view.js";
import { candidates, inFrame } from "./situation.js";
import { degrees, exactness, fixed, percent } from "./words.js";

let beams = null; // of the scan of which a beam is shown
let at = 0;

/** What is meant by a number of a place or a beam, as it is now: it stays so. */
export function inspect(store, view, what) {
  beams = null;
  if (!what) return close(view);
  if (what.kind === "beam") {
    beams = store.beams;
    return showBeam(view, what.i);
  }
  const place = what.kind === "pose" ? store.best() : candidates(store)[what.i];
  if (!place) return close(view);
  const { x, y, yaw, frame, ellipse } = inFrame(place, view.frame);
  const exact = ellipse && exactness(ellipse);
  view.inspected = [x, y];
  show(what.kind === "pose" ? "The pose" : `Place ${what.i + 1} of ${store.answer.hypotheses.length}`, [
    ["frame", frame], ["x", `${fixed(x, 3)} m`], ["y", `${fixed(y, 3)} m`], ["heading", `${fixed(degrees(yaw), 2)}°`],
    ["probability", percent(place.probability)], ["score (fit)", fixed(place.score, 2)],
    ["95 % along", exact?.along], ["95 % across", exact?.across], ["95 % heading", exact && `± ${exact.turn}`],
    ["votes", place.support === undefined ? "" : String(place.support)],
  ]);
}

export function isOpen() {
  return !$("inspect").hidden;
}

export function close(view) {
  view.inspected = null;
  $("inspect").hidden = true;
  view.draw();
}

/** The next beam of the same scan, or the one before. */
export function step(view, by) {
  if (beams) showBeam(view, (at + by + beams.fate.length) % beams.fate.length);
}

function showBeam(view, i) {
  at = i;
  const { x, y } = beamEnds(beams)[i];
  view.inspected = [x, y];
  show(`Beam ${i + 1} of ${beams.fate.length}`, [
    ["scan", String(beams.counter)], ["reading", `${fixed(beams.range_m[i], 3)} m`],
    ["bearing", `${fixed(degrees(beams.bearing[i]), 2)}°`], ["ends", FATES[beams.fate[i]]],
    ["end x", `${fixed(x, 2)} m`], ["end y", `${fixed(y, 2)} m`],
  ]);
}

function show(title, pairs) {
  $("inspect-title").textContent = title;
  $("inspect-facts").replaceChildren(...facts(pairs));
  $("inspect").hidden = false;
  $("beam-before").hidden = $("beam-after").hidden = !beams;
}
