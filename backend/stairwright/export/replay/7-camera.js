// Orbit, pan, zoom, presets and follow.

const VIEWS = {
  Iso: { yaw: -2.10, tilt: 0.50, distance: 2.7 },
  Side: { yaw: -Math.PI / 2, tilt: 0.09, distance: 2.4 },
  Front: { yaw: -0.32, tilt: 0.34, distance: 2.1 },
};
const view = { ...VIEWS.Iso, target: [0, 0, 0.2], follow: true };

function eye() {
  const c = Math.cos(view.tilt) * view.distance;
  return [
    view.target[0] + c * Math.cos(view.yaw), view.target[1] + c * Math.sin(view.yaw),
    view.target[2] + Math.sin(view.tilt) * view.distance,
  ];
}

function setUpCamera(canvas) {
  const press = () => {
    for (const b of $("cameras").children)
      b.setAttribute("aria-pressed", String(b.dataset.follow === "" && view.follow));
  };
  for (const [name, preset] of Object.entries(VIEWS)) {
    const button = document.createElement("button");
    button.textContent = name;
    button.onclick = () => { Object.assign(view, preset); redraw(); };
    $("cameras").append(button);
  }
  const follow = document.createElement("button");
  follow.textContent = "Follow";
  follow.dataset.follow = "";
  follow.onclick = () => { view.follow = !view.follow; press(); redraw(); };
  $("cameras").append(follow);
  press();
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (!canvas.hasPointerCapture(event.pointerId)) return;
    const [dx, dy] = [event.movementX, event.movementY];
    if (event.buttons & 2 || event.shiftKey) {
      const scale = (view.distance * 0.62) / canvas.clientHeight;
      view.target[0] += scale * (dx * Math.sin(view.yaw) - dy * 0);
      view.target[1] -= scale * dx * Math.cos(view.yaw);
      view.target[2] += scale * dy;
      view.follow = false;
      press();
    } else {
      view.yaw -= 0.008 * dx;
      view.tilt = Math.min(1.5, Math.max(-0.2, view.tilt + 0.008 * dy));
    }
    redraw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    view.distance = Math.min(12, Math.max(0.5, view.distance * Math.exp(0.001 * event.deltaY)));
    redraw();
  }, { passive: false });
}
