// Zooming and moving the view: wheel, dragging, two fingers.

export function listen(canvas, zoomAt, moveBy, reset) {
  const fingers = new Map();
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left - box.width / 2, event.clientY - box.top - box.height / 2];
  };
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], distance: Math.hypot(a[0] - b[0], a[1] - b[1]) };
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoomAt(place(event), Math.exp(-event.deltaY * 0.0015));
  }, { passive: false });
  canvas.addEventListener("dblclick", reset);
  canvas.addEventListener("pointerdown", (event) => {
    fingers.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add("dragged");
  });
  canvas.addEventListener("pointermove", (event) => {
    const old = fingers.get(event.pointerId);
    if (!old) return;
    const before = fingers.size === 2 ? spread() : null;
    const now = place(event);
    fingers.set(event.pointerId, now);
    if (before) {
      const after = spread();
      zoomAt(after.middle, after.distance / Math.max(before.distance, 1));
      moveBy(after.middle[0] - before.middle[0], after.middle[1] - before.middle[1]);
    } else if (fingers.size === 1 && event.pointerType !== "touch") {
      moveBy(now[0] - old[0], now[1] - old[1]);
    }
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => {
      fingers.delete(event.pointerId);
      if (fingers.size === 0) canvas.classList.remove("dragged");
    });
  }
}
