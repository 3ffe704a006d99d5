// The page: clock, controls, start.

let now = 0;
let playing = false;
let last = 0;
let scene = null;
let pending = false;
const plots = PLOTS.map((plot) => new Plot(plot));

function redraw() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(frame);
}

function frame(stamp) {
  pending = false;
  if (playing) {
    now += ((stamp - last) / 1000) * Number($("speed").value);
    if (now >= duration) { now = duration; setPlaying(false); }
  }
  last = stamp;
  $("time").value = now;
  $("clock").textContent = `${now.toFixed(2)} / ${duration.toFixed(2)} s`;
  for (const plot of plots) plot.draw(now);
  if (scene && count) {
    const state = stateAt(now);
    if (view.follow) view.target = [state.position[0] + 0.1, 0, state.position[2] - 0.12];
    scene.renderer.draw(scene.items(state), eye(), view.target);
  }
  if (playing) redraw();
}

function setTime(t) { now = t; redraw(); }

function setPlaying(on) {
  if (on && now >= duration) now = 0;
  playing = on;
  last = performance.now();
  $("play").textContent = on ? "Pause" : "Play";
  redraw();
}

function setTheme(name) {
  theme = name;
  document.documentElement.dataset.theme = name;
  for (const plot of plots) plot.stale = true;
  redraw();
}

function fill() {
  $("title").textContent = `${run.terrain.name} · ${run.robot.name} · friction ${run.friction}`;
  $("outcome").textContent = run.outcome;
  $("outcome").classList.add(run.outcome === "success" ? "good" : "bad");
  $("outcome").title = run.reason;
  for (const [label, value] of run.metrics) {
    const [dt, dd] = [document.createElement("dt"), document.createElement("dd")];
    dt.textContent = label;
    dd.textContent = value;
    $("metrics").append(dt, dd);
  }
  $("source").textContent = run.source;
  $("note").textContent = run.outcome === "success" ? "" : run.reason;
}

fill();
try {
  scene = new Scene($("view"));
} catch (error) {
  $("note").textContent = `No 3-D view: ${error.message}. The plots below still work.`;
}
$("time").max = duration;
$("time").oninput = () => { setPlaying(false); setTime(Number($("time").value)); };
$("play").onclick = () => setPlaying(!playing);
$("theme").onclick = () => setTheme(theme === "dark" ? "light" : "dark");
addEventListener("keydown", (event) => {
  if (event.target.matches("button, input, select")) return;
  if (event.code === "Space") { event.preventDefault(); setPlaying(!playing); }
  if (event.code === "ArrowRight") setTime(Math.min(duration, now + 0.1));
  if (event.code === "ArrowLeft") setTime(Math.max(0, now - 0.1));
});
new ResizeObserver(() => { for (const plot of plots) plot.stale = true; redraw(); })
  .observe(document.body);
setUpCamera($("view"));
setTheme(theme);
if (!matchMedia("(prefers-reduced-motion: reduce)").matches) setPlaying(count > 1);
window.replay = { setTime, setPlaying, setTheme, stateAt, get time() { return now; } };
