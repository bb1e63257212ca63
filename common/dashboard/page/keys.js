// What keys do. Those of the timeline are its own.

import { $ } from "./dom.js";

const STEP = 80; // pixels

/** Calls `act` for the keys of the page, but where somebody types or a button has the focus. */
export function keys(act) {
  const moves = { ArrowLeft: [STEP, 0], ArrowRight: [-STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };
  const others = {
    "+": () => act.zoom(1.25), "=": () => act.zoom(1.25), "-": () => act.zoom(0.8), 0: act.fit,
    f: act.follow, p: act.picture, t: act.theme, b: act.frame, " ": act.pause, "?": act.help, Escape: act.leave,
    1: () => act.layer("beams"), 2: () => act.layer("hypotheses"), 3: () => act.layer("track"),
    4: () => act.layer("field"), 5: () => act.layer("grid"),
  };
  document.addEventListener("keydown", (event) => {
    const { target, key } = event;
    if (target.closest("input, select, dialog") || event.ctrlKey || event.metaKey || event.altKey) return;
    // A button takes the space and enter keys, and what scrolls takes the arrows.
    if (target.closest("button") && key === " ") return;
    if (key in moves) {
      if (target.closest(".events")) return;
      act.move(...moves[key]);
    } else if (key === "Enter") {
      if (target !== $("map")) return;
      act.enter();
    } else {
      const other = others[key] ?? others[key.toLowerCase()];
      if (!other) return;
      other();
    }
    event.preventDefault();
    act.drawn();
  });
}
