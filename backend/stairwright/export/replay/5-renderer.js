// WebGL 2: one lit pass and one shadow map.

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
