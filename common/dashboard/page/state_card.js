// The card that says where the robot is, how sure and how exact, and what to do.

import { $, element, facts, replace, write } from "./dom.js";
import { inFrame, since } from "./situation.js";
import { clock, degrees, duration, exactness, fixed, percent, sentence, stamp, STATES } from "./words.js";

export function showState(store, is, frame) {
  const { pose, answer } = store;
  $("verdict-card").classList.toggle("stale", is.stale);
  write("verdict", is.word);
  $("verdict").dataset.verdict = is.kind;
  write("since", is.kind ? held(store) : is.silence === null ? "" : `newest scan ${duration(is.silence)} ago`);
  write("means", is.means);
  write("why", is.why);
  replace($("todo"), is.todo.join("\n"), () => is.todo.map((text) => element("li", {}, text)));
  $("todo-part").hidden = !is.todo.length;
  write("todo-title", is.title);
  showPose(store, is, frame);
  showTrust(store, is, frame);
  const newest = pose ?? answer;
  write("stamp", newest ? `Scan of ${stamp(newest.stamp_ns / 1e9)}` : "");
  const single = pose && answer && STATES[answer.verdict];
  write("single", single ? `The last scan that was searched, alone: ${single.word}, ${sentence(answer.says)}` : "");
}

function held(store) {
  const seconds = since(store, performance.now());
  if (seconds === null) return "";
  return `since ${clock(new Date(Date.now() - 1000 * seconds))}, ${duration(seconds)}`;
}

function showPose(store, is, frame) {
  const shown = is.known ? inFrame(store.best(), frame) : null;
  $("pose").hidden = !shown;
  $("pose").classList.toggle("sure", is.best && !is.stale);
  write("pose-x", fixed(shown?.x, 2));
  write("pose-y", fixed(shown?.y, 2));
  write("pose-yaw", fixed(shown && degrees(shown.yaw), 1));
  const best = store.best();
  const choice = Boolean(best?.base);
  $("frames").hidden = !best;
  for (const button of $("frames").querySelectorAll("button")) {
    const name = button.dataset.frame;
    button.setAttribute("aria-pressed", name === (choice ? frame : "laser"));
    button.disabled = name === "base_link" && !choice;
  }
  write("frame-note", best && !choice ? "The laser's mount is not known: the pose is the laser's." : "");
}

/** One probability, and one measure of how exact: what holds 95 %. */
function showTrust(store, is, frame) {
  const { map, pose, answer } = store;
  const best = store.best();
  const shown = inFrame(best, frame);
  const exact = is.known && shown?.ellipse ? exactness(shown.ellipse) : null;
  const places = pose?.places ?? (answer?.alternatives ?? 0) + 1;
  const of = is.known || places < 2 ? "" : `, the best of ${places} places`;
  const pairs = [
    ["How sure", is.state === "Doubtful" ? "in doubt" : best ? `${percent(best.probability)} probable${of}` : ""],
    ["Map", best ? map?.name : ""],
    ["How exact", exact ? `within ${exact.along} and ${exact.turn} (95 %)` : best ? "not known" : ""],
  ];
  replace($("trust"), JSON.stringify(pairs), () => facts(pairs));
}
