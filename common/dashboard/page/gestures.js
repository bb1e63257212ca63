// Mouse, finger and wheel on the map. Keys are the page's business.

const STILL = 5; // pixels that a click may move

/** Moves the view; while `choosing()` says so, takes where a drag begins and ends. A click
 * and the place of the pointer, in the map, are passed on. */
export function listen(view, { choosing, chosen, moved, clicked, pointed }) {
  const { canvas, camera } = view;
  const fingers = new Map();
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  let corner = null;
  let pressed = null; // where a click may have begun

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button > 0) return;
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    pressed = fingers.size === 1 ? at(event) : null;
    canvas.classList.add("moving");
    if (choosing()) corner = camera.toMap(...at(event));
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    const now = at(event);
    pointed(camera.toMap(...now));
    if (pressed && isFar(pressed, now)) pressed = null;
    if (!before) return;
    if (corner) {
      view.selection = [corner, camera.toMap(...now)];
    } else if (fingers.size === 1) {
      camera.pan(now[0] - before[0], now[1] - before[1]);
      if (!pressed) moved();
    } else {
      pinch(event.pointerId, before, now);
    }
    fingers.set(event.pointerId, now);
    view.draw();
  });

  /** Two fingers: what is under them stays there. */
  function pinch(id, before, now) {
    const [, other] = [...fingers].find(([key]) => key !== id);
    const distance = (a, b) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));
    const middle = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const [was, is] = [middle(before, other), middle(now, other)];
    camera.pan(is[0] - was[0], is[1] - was[1]);
    camera.zoom(distance(now, other) / distance(before, other), ...is);
    moved();
  }

  const release = (event) => {
    if (!fingers.delete(event.pointerId)) return;
    if (fingers.size === 0) canvas.classList.remove("moving");
    if (corner) {
      const box = [corner, camera.toMap(...at(event))];
      corner = null;
      chosen(box);
    } else if (pressed && event.type === "pointerup") {
      clicked(...at(event));
    }
    pressed = null;
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => pointed(null));

  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1;
    camera.zoom(Math.exp(-event.deltaY * lines * 0.0015), ...at(event));
    if (!view.follow) moved();
    view.draw();
  }, { passive: false });

  canvas.addEventListener("dblclick", (event) => {
    camera.zoom(2, ...at(event));
    view.draw();
  });
}

const isFar = ([x0, y0], [x1, y1]) => Math.hypot(x1 - x0, y1 - y0) > STILL;
