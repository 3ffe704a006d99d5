// The state at a time, interpolated between samples.

function indexAt(t) {
  let lo = 0;
  let hi = count - 1;
  while (hi - lo > 1) {
    const mid = (lo + hi) >> 1;
    if (time[mid] <= t) lo = mid;
    else hi = mid;
  }
  return lo;
}

function stateAt(t) {
  const i = indexAt(t);
  const j = Math.min(i + 1, count - 1);
  const u = j > i ? Math.min(1, Math.max(0, (t - time[i]) / (time[j] - time[i]))) : 0;
  const mix = (a, width) => {
    const out = new Array(width);
    for (let k = 0; k < width; k++) out[k] = a[i * width + k] * (1 - u) + a[j * width + k] * u;
    return out;
  };
  const before = series.base_quaternion.subarray(4 * i, 4 * i + 4);
  const after = series.base_quaternion.subarray(4 * j, 4 * j + 4);
  const sign = before.reduce((sum, v, k) => sum + v * after[k], 0) < 0 ? -1 : 1;
  const turn = [0, 1, 2, 3].map((k) => before[k] * (1 - u) + sign * after[k] * u);
  const norm = Math.hypot(...turn);
  return {
    position: mix(series.base_position, 3),
    turn: turn.map((v) => v / norm),
    q: mix(series.q, 12),
    force: mix(series.contact_force, 8),
  };
}
