// Desired (a wide pale band) and actual (a thin line) over time.

const degrees = 180 / Math.PI;
const column = (name, width, k, scale) => {
  const out = new Float32Array(count);
  for (let i = 0; i < count; i++) out[i] = scale * series[name][width * i + k];
  return out;
};
const PLOTS = [
  ["Pitch, nose-up", "°", [["pitch", "pitch_desired", 1, 0, -degrees, null]]],
  ["Thigh", "°", [["q", "q_desired", 12, 0, degrees, 0], ["q", "q_desired", 12, 6, degrees, 1]]],
  ["Calf", "°", [["q", "q_desired", 12, 1, degrees, 0], ["q", "q_desired", 12, 7, degrees, 1]]],
  ["Calf torque", "Nm", [["torque", null, 12, 1, 1, 0], ["torque", null, 12, 7, 1, 1]]],
];

class Plot {
  constructor([name, unitName, lines]) {
    this.lines = lines.map(([actual, desired, width, k, scale, leg]) => ({
      actual: column(actual, width, k, scale),
      desired: desired && column(desired, width, k, scale),
      leg,
    }));
    const figure = document.createElement("figure");
    figure.innerHTML = "<figcaption></figcaption><canvas></canvas>";
    figure.firstChild.append(name);
    this.value = document.createElement("span");
    figure.firstChild.append(this.value);
    $("plots").append(figure);
    this.unit = unitName;
    this.canvas = figure.lastChild;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${name} over time, desired and actual`);
    const seek = (event) => {
      if (event.type === "pointermove" && !event.buttons) return;
      const box = this.canvas.getBoundingClientRect();
      const share = (event.clientX - box.left - Plot.LEFT) / (box.width - Plot.LEFT - 4);
      setTime(Math.min(1, Math.max(0, share)) * duration);
    };
    this.canvas.addEventListener("pointerdown", seek);
    this.canvas.addEventListener("pointermove", seek);
    let [low, high] = [Infinity, -Infinity];
    for (const line of this.lines)
      for (const values of [line.actual, line.desired])
        if (values) for (const v of values) { low = Math.min(low, v); high = Math.max(high, v); }
    const room = 0.08 * (high - low) + 0.5;
    [this.low, this.high] = count ? [low - room, high + room] : [-1, 1];
  }
  /** Curves, once per size and theme. */
  prepare() {
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.round(this.canvas.clientWidth * ratio);
    const height = Math.round(this.canvas.clientHeight * ratio);
    Object.assign(this.canvas, { width, height });
    const still = new OffscreenCanvas(Math.max(1, width), Math.max(1, height));
    const g = still.getContext("2d");
    const c = THEMES[theme];
    g.scale(ratio, ratio);
    const [w, h] = [width / ratio, height / ratio];
    this.x = (t) => Plot.LEFT + ((w - Plot.LEFT - 4) * t) / (duration || 1);
    const y = (v) => 6 + ((h - 22) * (this.high - v)) / (this.high - this.low);
    g.font = "10px Inter, system-ui, sans-serif";
    g.fillStyle = c.tick;
    g.strokeStyle = c.line;
    g.textAlign = "right";
    for (const v of ticks(this.low, this.high, 4)) {
      g.fillText(String(v), Plot.LEFT - 5, y(v) + 3);
      g.beginPath(); g.moveTo(Plot.LEFT, y(v)); g.lineTo(w - 4, y(v)); g.stroke();
    }
    g.textAlign = "center";
    for (const t of ticks(0, duration, 5)) g.fillText(`${t}`, this.x(t), h - 3);
    for (const { actual, desired, leg } of this.lines) {
      const colour = leg === null ? c.actual : c.hex[leg];
      const curve = (values, pixels, alpha) => {
        g.beginPath();
        const step = Math.max(1, Math.floor(count / (2 * w)));
        for (let i = 0; i < count; i += step) g.lineTo(this.x(time[i]), y(values[i]));
        Object.assign(g, { strokeStyle: colour, lineWidth: pixels, globalAlpha: alpha });
        g.lineJoin = "round";
        g.stroke();
        g.globalAlpha = 1;
      };
      if (desired) curve(desired, 5, c.band);
      curve(actual, 1.3, 1);
    }
    this.still = still;
    this.ratio = ratio;
  }
  draw(t) {
    if (!this.still || this.stale) this.prepare();
    this.stale = false;
    const g = this.canvas.getContext("2d");
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, this.canvas.width, this.canvas.height);
    g.drawImage(this.still, 0, 0);
    g.fillStyle = THEMES[theme].actual;
    g.fillRect(this.x(t) * this.ratio, 0, this.ratio, this.canvas.height - 14 * this.ratio);
    const i = count ? indexAt(t) : 0;
    const values = this.lines.map((line) => (count ? line.actual[i].toFixed(1) : "–"));
    this.value.textContent = `${values.join("  ")} ${this.unit}`;
  }
}
Plot.LEFT = 34;

function ticks(low, high, wanted) {
  const raw = (high - low) / wanted || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((k) => k * power >= raw) * power;
  const out = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++)
    out.push(Number((k * step).toPrecision(6)));
  return out;
}
