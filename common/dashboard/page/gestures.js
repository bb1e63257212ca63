// Mouse, finger and wheel on the map. Keys are the page's business.

/** Moves the view; while `choosing()` says so, chooses a box and hands it over. */
export function listen(view, { choosing, chosen, moved }) {
  const { canvas, camera } = view;
  const fingers = new Map();
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  let corner = null;

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button > 0) return;
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, at(event));
    canvas.classList.add("moving");
    if (choosing()) corner = camera.toMap(...at(event));
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = at(event);
    if (corner) {
      view.selection = [corner, camera.toMap(...now)];
    } else if (fingers.size === 1) {
      camera.pan(now[0] - before[0], now[1] - before[1]);
      if (now[0] !== before[0] || now[1] !== before[1]) moved();
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
    }
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);

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
