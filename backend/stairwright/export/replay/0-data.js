"use strict";
// Replays one rollout in 3-D: WebGL 2 and nothing else, so that the file opens offline for years.
// Axes: x forward, y left, z up. Matrices are column-major.

const run = JSON.parse(document.getElementById("run").textContent);
const series = decode(run.series);
const time = series.time;
const count = time.length;
const duration = count ? time[count - 1] : 0;
const $ = (id) => document.getElementById(id);

/** Base64 of little-endian float32 arrays, by name, with the width of a row. */
function decode(packed) {
  const bytes = Uint8Array.from(atob(packed.data), (c) => c.charCodeAt(0));
  const all = new Float32Array(bytes.buffer);
  const out = {};
  let at = 0;
  for (const [name, width] of packed.layout) {
    out[name] = all.subarray(at, at + width * packed.count);
    at += width * packed.count;
  }
  return out;
}
