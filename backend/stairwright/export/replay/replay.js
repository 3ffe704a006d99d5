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

// ---- state at a time ---------------------------------------------------------------------------

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

// ---- matrices ----------------------------------------------------------------------------------

function multiply(a, b) {
  const out = new Float32Array(16);
  for (let c = 0; c < 4; c++)
    for (let r = 0; r < 4; r++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + r] * b[4 * c + k];
      out[4 * c + r] = sum;
    }
  return out;
}

const pose = ([w, x, y, z], [px, py, pz]) =>
  new Float32Array([
    1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
    px, py, pz, 1,
  ]);

/** Turn by `angle` about y, then shift. */
const hinge = (angle, offset) => pose([Math.cos(angle / 2), 0, Math.sin(angle / 2), 0], offset);
const identity = pose([1, 0, 0, 0], [0, 0, 0]);

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
const unit = (a) => {
  const n = Math.hypot(...a) || 1;
  return [a[0] / n, a[1] / n, a[2] / n];
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function lookAt(eye, target) {
  const f = unit(sub(target, eye));
  const s = unit(cross(f, Math.abs(f[2]) > 0.999 ? [1, 0, 0] : [0, 0, 1]));
  const u = cross(s, f);
  return new Float32Array([
    s[0], u[0], -f[0], 0, s[1], u[1], -f[1], 0, s[2], u[2], -f[2], 0,
    -dot(s, eye), -dot(u, eye), dot(f, eye), 1,
  ]);
}

function perspective(fov, aspect, near, far) {
  const f = 1 / Math.tan(fov / 2);
  return new Float32Array([
    f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
    0, 0, (2 * far * near) / (near - far), 0,
  ]);
}

function orthographic(half, near, far) {
  return new Float32Array([
    1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 / (near - far), 0,
    0, 0, (far + near) / (near - far), 1,
  ]);
}

// ---- shapes: triangles with flat normals -------------------------------------------------------

class Shape {
  constructor() {
    this.data = [];
  }
  /** A flat convex polygon, anticlockwise seen from outside. */
  face(...corners) {
    const n = unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])));
    for (let i = 1; i + 1 < corners.length; i++)
      for (const p of [corners[0], corners[i], corners[i + 1]]) this.data.push(...p, ...n);
    return this;
  }
  /** A frustum along z between rectangles of half sides (ax, ay) at z0 and (bx, by) at z1. */
  frustum(ax, ay, z0, bx, by, z1, [cx, cy, cz] = [0, 0, 0]) {
    const ring = (x, y, z) =>
      [[-x, -y], [x, -y], [x, y], [-x, y]].map(([a, b]) => [a + cx, b + cy, z + cz]);
    const low = ring(ax, ay, z0);
    const high = ring(bx, by, z1);
    this.face(...high).face(...[...low].reverse());
    for (let i = 0; i < 4; i++) {
      const j = (i + 1) % 4;
      this.face(low[i], low[j], high[j], high[i]);
    }
    return this;
  }
  box([x, y, z], at) {
    return this.frustum(x / 2, y / 2, -z / 2, x / 2, y / 2, z / 2, at);
  }
  /** A solid of revolution about y through (radius, y) pairs, smooth round its axis. */
  revolve(section, segments = 32) {
    for (let k = 0; k + 1 < section.length; k++) {
      const [[r0, y0], [r1, y1]] = [section[k], section[k + 1]];
      const slope = unit([y1 - y0, r0 - r1, 0]);
      for (let i = 0; i < segments; i++) {
        const corner = (step, r, y) => {
          const a = (2 * Math.PI * (i + step)) / segments;
          const c = Math.cos(a);
          const s = Math.sin(a);
          return [r * c, y, -r * s, slope[0] * c, slope[1], -slope[0] * s];
        };
        const [a, b] = [corner(0, r0, y0), corner(1, r0, y0)];
        const [c, d] = [corner(0, r1, y1), corner(1, r1, y1)];
        this.data.push(...a, ...b, ...d, ...a, ...d, ...c);
      }
    }
    return this;
  }
  disc(r, width, chamfer = 0.1 * r, segments = 32) {
    const h = width / 2;
    return this.revolve(
      [[0, -h], [r - chamfer, -h], [r, chamfer - h], [r, h - chamfer], [r - chamfer, h], [0, h]],
      segments,
    );
  }
}

function terrainShapes(points) {
  const w = run.half_width;
  const floor = Math.min(...points.map((p) => p[1])) - 0.25;
  const treads = new Shape();
  const risers = new Shape();
  const flanks = new Shape();
  const edges = [];
  for (let i = 0; i + 1 < points.length; i++) {
    const [[x0, z0], [x1, z1]] = [points[i], points[i + 1]];
    const steep = Math.abs(Math.atan2(z1 - z0, x1 - x0)) > 1;
    (steep ? risers : treads).face([x0, w, z0], [x0, -w, z0], [x1, -w, z1], [x1, w, z1]);
    if (x1 - x0 > 1e-9)
      flanks
        .face([x0, -w, floor], [x1, -w, floor], [x1, -w, z1], [x0, -w, z0])
        .face([x0, w, z0], [x1, w, z1], [x1, w, floor], [x0, w, floor]);
    edges.push([x0, -w, z0], [x1, -w, z1], [x0, w, z0], [x1, w, z1]);
  }
  for (const [x, z] of points) edges.push([x, -w, z], [x, w, z]);
  const [x0, z0] = points[0];
  const [x1, z1] = points[points.length - 1];
  flanks
    .face([x0, w, floor], [x0, -w, floor], [x0, -w, z0], [x0, w, z0])
    .face([x1, -w, floor], [x1, w, floor], [x1, w, z1], [x1, -w, z1]);
  return { treads, risers, flanks, edges, floor };
}

function robotShapes({ trunk, half_track, hips, thigh, calf, wheel }) {
  const wide = 0.9 * wheel.width;
  const link = (l, r) => {
    const a = 1.25 * Math.max(r, 0.012);
    const b = Math.max(r, 0.01);
    return new Shape().frustum(b, wide / 2, -l, a, wide / 2, 0);
  };
  const [x, y, z] = trunk;
  const c = 0.01;
  const body = new Shape()
    .frustum(x / 2 - c, y / 2 - c, -z / 2, x / 2, y / 2, c - z / 2)
    .frustum(x / 2, y / 2, c - z / 2, x / 2, y / 2, z / 2 - c)
    .frustum(x / 2, y / 2, z / 2 - c, x / 2 - c, y / 2 - c, z / 2);
  const axle = new Shape().disc(0.3 * z, 2 * half_track - wheel.width, 0.004, 24);
  const r = wheel.radius;
  const h = wheel.width / 2;
  const tyre = new Shape().revolve(
    [[0.72 * r, -h], [0.9 * r, -h], [r, 0.1 * r - h], [r, h - 0.1 * r], [0.9 * r, h],
      [0.72 * r, h], [0.72 * r, -h]],
    40,
  );
  const rim = new Shape().disc(0.3 * r, 2.2 * h, 0.05 * r, 20);
  const bar = new Shape().box([0.13 * r, 1.1 * h, 0.5 * r], [0, 0, 0.48 * r]);
  bar.box([0.0001, 0.0001, 0.0001]);
  for (let k = 0; k < 5; k++) {
    const a = (2 * Math.PI * k) / 5;
    for (let i = 0; i < bar.data.length; i += 3) {
      const [px, py, pz] = bar.data.slice(i, i + 3);
      rim.data.push(
        px * Math.cos(a) + pz * Math.sin(a), py, pz * Math.cos(a) - px * Math.sin(a),
      );
    }
  }
  rim.box([0.2 * r, 2.04 * h, 0.16 * r], [0, 0, 0.6 * r]);
  const front = new Shape().box([0.004, 0.62 * y, 0.42 * z], [x / 2, 0, 0]);
  return {
    body, axle, tyre, rim, front,
    thigh: link(thigh.length, thigh.radius),
    calf: link(calf.length, calf.radius),
    motor: new Shape().disc(Math.max(1.7 * thigh.radius, 0.02), 1.25 * wide, 0.003, 28),
    knee: new Shape().disc(Math.max(1.25 * thigh.radius, 0.015), 1.1 * wide, 0.003, 24),
    shaft: new Shape().revolve([[0, 0], [1, 0], [1, 1], [0, 1]], 12),
    tip: new Shape().revolve([[0, 0], [1, 0], [0, 1]], 14),
    hips,
  };
}

// ---- colours -----------------------------------------------------------------------------------

const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
const THEMES = {
  dark: {
    front: rgb("#5fb0f5"), rear: rgb("#f2a541"), trunk: rgb("#dfe4ea"), trim: rgb("#4a545f"),
    tyre: rgb("#3a4149"), treads: rgb("#8290a0"), risers: rgb("#697684"), flanks: rgb("#454f5a"),
    edge: rgb("#b4c0cd"), grid: rgb("#2b343d"), force: rgb("#cfc65c"), path: rgb("#c4ccd5"),
    actual: "#e9edf2", band: 0.34, tick: "#7f8b98", line: "#262d35", hex: ["#5fb0f5", "#f2a541"],
  },
  light: {
    front: rgb("#0f6cbd"), rear: rgb("#b85f00"), trunk: rgb("#5b6673"), trim: rgb("#39424b"),
    tyre: rgb("#2c333a"), treads: rgb("#ccd4dc"), risers: rgb("#bcc6cf"), flanks: rgb("#adb8c2"),
    edge: rgb("#5d6b7a"), grid: rgb("#cbd4dc"), force: rgb("#857900"), path: rgb("#3d4752"),
    actual: "#121920", band: 0.3, tick: "#667381", line: "#d9dfe5", hex: ["#0f6cbd", "#b85f00"],
  },
};
let theme = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";

// ---- renderer ----------------------------------------------------------------------------------

const VERTEX = `#version 300 es
layout(location=0) in vec3 p; layout(location=1) in vec3 n;
uniform mat4 model, camera, light; out vec3 normal, place; out vec4 shade;
void main() { vec4 w = model * vec4(p, 1.0); place = w.xyz; normal = mat3(model) * n;
  shade = light * w; gl_Position = camera * w; }`;
const FRAGMENT = `#version 300 es
precision highp float; precision highp sampler2DShadow;
in vec3 normal, place; in vec4 shade; out vec4 colour;
uniform vec3 tint, eye; uniform float lit; uniform sampler2DShadow depths;
float sun(vec3 n, vec3 l) {
  vec3 s = shade.xyz / shade.w * 0.5 + 0.5;
  if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s, vec3(1.0)))) return 1.0;
  float bias = 0.0012 + 0.004 * (1.0 - max(dot(n, l), 0.0)); float sum = 0.0;
  for (int i = -2; i <= 2; i++) for (int j = -2; j <= 2; j++)
    sum += texture(depths, vec3(s.xy + vec2(i, j) / 1024.0, s.z - bias));
  return sum / 25.0; }
void main() {
  if (lit == 0.0) { colour = vec4(tint, 1.0); return; }
  vec3 n = normalize(normal); vec3 v = normalize(eye - place);
  if (dot(n, v) < 0.0) n = -n;
  vec3 key = normalize(vec3(-0.35, -0.5, 1.0)), fill = normalize(vec3(-0.6, -0.9, 0.3));
  float d = max(dot(n, key), 0.0) * sun(n, key);
  float f = max(dot(n, fill), 0.0);
  float sky = 0.5 + 0.5 * n.z;
  float shine = pow(max(dot(reflect(-key, n), v), 0.0), 40.0) * 0.10 * d;
  colour = vec4(tint * (0.30 + 0.22 * sky + 0.50 * d + 0.20 * f) + shine, 1.0); }`;
const SHADOW_FRAGMENT = `#version 300 es
precision highp float; void main() {}`;
const LIGHT = unit([-0.35, -0.5, 1.0]);

class Renderer {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("WebGL 2 is not available");
    this.gl = gl;
    this.canvas = canvas;
    this.program = this.link(VERTEX, FRAGMENT);
    this.shadow = this.link(VERTEX, SHADOW_FRAGMENT);
    this.depth = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.depth);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, 1024, 1024);
    for (const [key, value] of [
      [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE],
      [gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
    ]) gl.texParameteri(gl.TEXTURE_2D, key, value);
    this.target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.enable(gl.DEPTH_TEST);
  }
  link(vertex, fragment) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS))
        throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    const at = {};
    for (const name of ["model", "camera", "light", "tint", "eye", "lit", "depths"])
      at[name] = gl.getUniformLocation(program, name);
    return { program, at };
  }
  /** Upload triangles with normals (a Shape) or line ends (an array of points). */
  upload(source) {
    const gl = this.gl;
    const lines = Array.isArray(source);
    const data = lines ? source.flatMap((p) => [...p, 0, 0, 1]) : source.data;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
    for (const k of [0, 1]) {
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 24, 12 * k);
    }
    return { array, count: data.length / 6, lines };
  }
  /** Draw items [mesh, model matrix, colour]; lines are unlit and cast nothing. */
  draw(items, eye, target) {
    const gl = this.gl;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height)
      Object.assign(this.canvas, { width, height });
    const centre = items.focus;
    const from = centre.map((v, k) => v + 4 * LIGHT[k]);
    const light = multiply(orthographic(0.8, 0.5, 8), lookAt(from, centre));
    const camera = multiply(perspective(0.62, width / height, 0.05, 60), lookAt(eye, target));
    const pass = ({ program, at }, view, shadows) => {
      gl.useProgram(program);
      gl.uniformMatrix4fv(at.camera, false, view);
      gl.uniformMatrix4fv(at.light, false, light);
      if (at.eye) gl.uniform3fv(at.eye, eye);
      if (at.depths) gl.uniform1i(at.depths, 0);
      for (const [mesh, model, tint] of items) {
        if (shadows && mesh.lines) continue;
        gl.uniformMatrix4fv(at.model, false, model);
        if (at.tint) gl.uniform3fv(at.tint, tint);
        if (at.lit) gl.uniform1f(at.lit, mesh.lines ? 0 : 1);
        gl.bindVertexArray(mesh.array);
        gl.drawArrays(mesh.lines ? gl.LINES : gl.TRIANGLES, 0, mesh.count);
      }
    };
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    gl.viewport(0, 0, 1024, 1024);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.bindTexture(gl.TEXTURE_2D, null);
    pass(this.shadow, light, true);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_2D, this.depth);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    pass(this.program, camera, false);
  }
}

// ---- scene -------------------------------------------------------------------------------------

class Scene {
  constructor(canvas) {
    this.renderer = new Renderer(canvas);
    const up = (source) => this.renderer.upload(source);
    const ground = terrainShapes(run.terrain.vertices);
    this.ground = { treads: up(ground.treads), risers: up(ground.risers), flanks: up(ground.flanks) };
    this.edges = up(ground.edges);
    const middle = (run.terrain.vertices[0][0] + run.terrain.vertices.at(-1)[0]) / 2;
    const grid = [];
    for (let k = -16; k <= 16; k++) {
      const at = k * 0.5;
      grid.push([middle - 8, at, ground.floor], [middle + 8, at, ground.floor]);
      grid.push([middle + at, -8, ground.floor], [middle + at, 8, ground.floor]);
    }
    this.grid = up(grid);
    this.parts = {};
    for (const [name, shape] of Object.entries(robotShapes(run.robot)))
      if (shape instanceof Shape) this.parts[name] = up(shape);
    const path = [];
    const stride = Math.max(1, Math.floor(count / 600));
    for (let i = 0; i + stride < count; i += stride)
      for (const k of [i, i + stride]) path.push([...series.base_position.subarray(3 * k, 3 * k + 3)]);
    this.path = path.length ? up(path) : null;
  }
  items(state) {
    const c = THEMES[theme];
    const p = this.parts;
    const out = [
      [this.ground.treads, identity, c.treads], [this.ground.risers, identity, c.risers],
      [this.ground.flanks, identity, c.flanks], [this.edges, identity, c.edge],
      [this.grid, identity, c.grid],
    ];
    out.focus = state.position;
    if (this.path) out.push([this.path, identity, c.path]);
    const base = pose(state.turn, state.position);
    const { robot } = run;
    out.push([p.body, base, c.trunk], [p.front, base, c.trim]);
    for (const hip of [robot.hips.front, robot.hips.rear])
      out.push([p.axle, multiply(base, hinge(0, [hip[0], 0, hip[1]])), c.trim]);
    for (let leg = 0; leg < 4; leg++) {
      const colour = leg < 2 ? c.front : c.rear;
      const hip = leg < 2 ? robot.hips.front : robot.hips.rear;
      const y = leg % 2 ? -robot.half_track : robot.half_track;
      const [a, b, w] = state.q.slice(3 * leg, 3 * leg + 3);
      const thigh = multiply(base, hinge(a, [hip[0], y, hip[1]]));
      const calf = multiply(thigh, hinge(b, [0, 0, -robot.thigh.length]));
      const wheel = multiply(calf, hinge(w, [0, 0, -robot.calf.length]));
      const darker = colour.map((v) => 0.8 * v);
      out.push(
        [p.thigh, thigh, colour], [p.motor, thigh, darker], [p.calf, calf, colour],
        [p.knee, calf, darker], [p.tyre, wheel, c.tyre], [p.rim, wheel, colour],
      );
      this.arrow(out, wheel, state.force.slice(2 * leg, 2 * leg + 2), y, c.force);
    }
    return out;
  }
  /** The ground's force on a wheel, from under the wheel along the force, beside the tyre. */
  arrow(out, wheel, [fx, fz], y, colour) {
    const size = Math.hypot(fx, fz);
    if (size < 2) return;
    const length = 0.003 * size;
    const d = [fx / size, fz / size];
    const r = run.robot.wheel.radius;
    const side = y + Math.sign(y) * 0.8 * run.robot.wheel.width;
    const start = [wheel[12] - r * d[0], side, wheel[14] - r * d[1]];
    // Columns of the arrow's frame: radius, axis along the force, radius.
    const frame = (radius, from, span) => {
      const at = [start[0] + from * d[0], side, start[2] + from * d[1]];
      return new Float32Array([
        0, radius, 0, 0, span * d[0], 0, span * d[1], 0, -radius * d[1], 0, radius * d[0], 0,
        ...at, 1,
      ]);
    };
    const head = Math.min(0.034, 0.5 * length);
    out.push([this.parts.shaft, frame(0.006, 0, length - head), colour]);
    out.push([this.parts.tip, frame(0.015, length - head, head), colour]);
  }
}

// ---- camera ------------------------------------------------------------------------------------

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

// ---- plots -------------------------------------------------------------------------------------

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

// ---- page --------------------------------------------------------------------------------------

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
