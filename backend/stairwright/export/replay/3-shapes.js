// Triangles with normals: terrain, robot and arrows.

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

/** Convex pieces of the trunk, extruded along y, their outer edges chamfered. */
function trunkShape(pieces) {
  const body = new Shape();
  for (const { points, width } of pieces) {
    const area = points.reduce((sum, [x, z], i) => {
      const [u, v] = points[(i + 1) % points.length];
      return sum + x * v - z * u;
    }, 0);
    const ring = area > 0 ? points : [...points].reverse();
    const middle = [0, 1].map((k) => ring.reduce((sum, p) => sum + p[k], 0) / ring.length);
    const far = Math.max(...ring.map((p) => Math.hypot(p[0] - middle[0], p[1] - middle[1])));
    const c = Math.min(0.01, 0.2 * width, 0.2 * far);
    const at = (y, inset) => ring.map(([x, z]) => {
      const keep = 1 - inset / far;
      return [middle[0] + keep * (x - middle[0]), y, middle[1] + keep * (z - middle[1])];
    });
    const h = width / 2;
    const bands = [at(-h, c), at(c - h, 0), at(h - c, 0), at(h, c)];
    body.face(...bands[0]).face(...[...bands[3]].reverse());
    for (let k = 0; k < 3; k++)
      for (let i = 0; i < ring.length; i++) {
        const j = (i + 1) % ring.length;
        body.face(bands[k][i], bands[k + 1][i], bands[k + 1][j], bands[k][j]);
      }
  }
  return body;
}

/** Bars along a link's capsules, in the link's frame. */
function linkShape({ capsules }, wide) {
  const out = new Shape();
  for (const [[ax, az], [bx, bz], radius] of capsules) {
    const length = Math.hypot(bx - ax, bz - az);
    const a = 1.25 * Math.max(radius, 0.012);
    const b = Math.max(radius, 0.01);
    const bar = new Shape().frustum(b, wide / 2, -length, a, wide / 2, 0);
    const [c, s] = length ? [(az - bz) / length, (ax - bx) / length] : [1, 0];
    for (let i = 0; i < bar.data.length; i += 6) {
      const [px, py, pz, nx, ny, nz] = bar.data.slice(i, i + 6);
      out.data.push(ax + c * px + s * pz, py, az - s * px + c * pz, c * nx + s * nz, ny, c * nz - s * nx);
    }
  }
  return out;
}

function robotShapes({ trunk, half_track, hips, legs, wheel }) {
  const wide = 0.9 * wheel.width;
  const body = trunkShape(trunk);
  const [{ points, width: y }] = trunk;
  const range = (k) => [Math.min(...points.map((p) => p[k])), Math.max(...points.map((p) => p[k]))];
  const [[, x], [low, high]] = [range(0), range(1)];
  const z = high - low;
  const thick = (part) => Math.max(...legs[0][part].capsules.map((capsule) => capsule[2]));
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
  const front = new Shape().box([0.004, 0.62 * y, 0.42 * z], [x, 0, (low + high) / 2]);
  return {
    body, axle, tyre, rim, front,
    thigh0: linkShape(legs[0].thigh, wide),
    thigh1: linkShape(legs[1].thigh, wide),
    calf0: linkShape(legs[0].calf, wide),
    calf1: linkShape(legs[1].calf, wide),
    motor: new Shape().disc(Math.max(1.7 * thick("thigh"), 0.02), 1.25 * wide, 0.003, 28),
    knee: new Shape().disc(Math.max(1.25 * thick("thigh"), 0.015), 1.1 * wide, 0.003, 24),
    shaft: new Shape().revolve([[0, 0], [1, 0], [1, 1], [0, 1]], 12),
    tip: new Shape().revolve([[0, 0], [1, 0], [0, 1]], 14),
    hips,
  };
}
