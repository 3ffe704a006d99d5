// What stands in the picture at one moment.

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
      const pair = leg < 2 ? 0 : 1;
      const own = robot.legs[pair];
      const calf = multiply(thigh, hinge(b, [0, 0, -own.thigh.length]));
      const wheel = multiply(calf, hinge(w, [0, 0, -own.calf.length]));
      const darker = colour.map((v) => 0.8 * v);
      out.push(
        [p[`thigh${pair}`], thigh, colour], [p.motor, thigh, darker],
        [p[`calf${pair}`], calf, colour],
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
