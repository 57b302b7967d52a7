"use strict";
// What draws: triangles that are turned by a quaternion, and lines of a width in pixels. Lengths: a body has radius 1.
// Quaternions are w, x, y, z; z of the page is up.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const unit = a => times(a, 1 / (Math.hypot(a[0], a[1], a[2]) || 1));
const product = (p, q) => [
  p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
  p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
  p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
  p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]];
function turned(q, v) {
  const u = [q[1], q[2], q[3]], t = times(cross(u, v), 2);
  return plus(plus(v, times(t, q[0])), cross(u, t));
}

const TURN = `
  uniform vec4 turn; uniform vec3 stretch, offset; uniform mat4 view;
  vec3 turned(vec3 v) { return v + 2.0 * cross(turn.yzw, cross(turn.yzw, v) + turn.x * v); }
  vec3 placed(vec3 v) { return turned(v * stretch) + offset; }`;
// Eye and light are so far away that a flat triangle has one shade: it is found at the corners, not at each pixel.
const SOLID = [`
  attribute vec3 position, normal; attribute float tint;
  uniform vec3 colours[3]; uniform vec3 eye, light;
  varying vec3 shade;` + TURN + `
  void main() {
    gl_Position = view * vec4(placed(position), 1.0);
    vec3 n = normalize(turned(normal / stretch));
    if (dot(n, eye) < 0.0) n = -n;
    vec3 colour = tint < 0.5 ? colours[0] : tint < 1.5 ? colours[1] : colours[2];
    float shine = pow(max(dot(n, normalize(light + eye)), 0.0), 24.0);
    shade = colour * (0.42 + 0.58 * max(dot(n, light), 0.0)) + 0.12 * shine;
  }`, `
  precision mediump float;
  uniform float opacity;
  varying vec3 shade;
  void main() { gl_FragColor = vec4(shade, opacity); }`];
const LINE = [`
  attribute vec3 here, there; attribute float side;
  uniform vec2 size; uniform float width;` + TURN + `
  void main() {
    vec4 a = view * vec4(placed(here), 1.0), b = view * vec4(placed(there), 1.0);
    vec2 along = (b.xy / b.w - a.xy / a.w) * size;
    float length = max(sqrt(dot(along, along)), 1e-6);
    gl_Position = a + vec4(vec2(-along.y, along.x) / length * side * width / size * a.w, 0.0, 0.0);
  }`, `
  precision mediump float;
  uniform vec3 colour; uniform float opacity;
  void main() { gl_FragColor = vec4(colour, opacity); }`];

// The renderer of a canvas; null where the browser has no WebGL.
function rendererOf(canvas) {
  // without a graphics card smooth edges cost more than all the rest
  const gl = canvas.getContext("webgl", { antialias: true, failIfMajorPerformanceCaveat: true })
    || canvas.getContext("webgl", { antialias: false });
  if (!gl) return null;

  function program([vertex, fragment]) {
    const made = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    const found = { made, places: {} };
    for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k++) {
      const name = gl.getActiveUniform(made, k).name.replace("[0]", "");
      found.places[name] = gl.getUniformLocation(made, name);
    }
    return found;
  }
  const solid = program(SOLID), line = program(LINE);
  let view = null;

  // Numbers in the memory of the graphics card: `parts` names attributes and how many numbers each has.
  function kept(data, parts, which) {
    const buffer = gl.createBuffer(), whole = parts.reduce((sum, [, size]) => sum + size, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
    const places = parts.map(([name]) => gl.getAttribLocation(which.made, name));
    return { buffer, parts, places, whole, count: data.length / whole };
  }
  function use(which, kept, q, stretch, offset) {
    gl.useProgram(which.made);
    gl.bindBuffer(gl.ARRAY_BUFFER, kept.buffer);
    let start = 0;
    kept.parts.forEach(([, size], k) => {
      gl.enableVertexAttribArray(kept.places[k]);
      gl.vertexAttribPointer(kept.places[k], size, gl.FLOAT, false, 4 * kept.whole, 4 * start);
      start += size;
    });
    gl.uniform4fv(which.places.turn, q);
    gl.uniform3fv(which.places.stretch, stretch || [1, 1, 1]);
    gl.uniform3fv(which.places.offset, offset || [0, 0, 0]);
    gl.uniformMatrix4fv(which.places.view, false, view.matrix);
  }

  return {
    // Triangles from lists of coordinates, of three corners each, and of tints; every triangle has its own normal, those of a
    // ball the normals of the ball.
    solid(vertices, triangles, tints, isBall) {
      const data = new Float32Array(triangles.length * 7);
      for (let k = 0; k < triangles.length / 3; k++) {
        const at = [0, 1, 2].map(j => { const n = 3 * triangles[3 * k + j]; return [vertices[n], vertices[n + 1], vertices[n + 2]]; });
        const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        const normal = unit(cross(minus(at[1], at[0]), minus(at[2], at[0])));
        at.forEach((corner, j) => data.set([...corner, ...(isBall ? corner : normal), tints ? tints[k] : 0], 21 * k + 7 * j));
      }
      return kept(data, [["position", 3], ["normal", 3], ["tint", 1]], solid);
    },
    // A line through points, six corners for each piece; seen from its other end the sides of a piece change.
    line(points) {
      const data = new Float32Array(Math.max(0, points.length - 1) * 42);
      for (let k = 0; k + 1 < points.length; k++) {
        const a = points[k], b = points[k + 1];
        [[a, b, 1], [a, b, -1], [b, a, 1], [a, b, 1], [b, a, 1], [b, a, -1]]
          .forEach(([here, there, side], j) => data.set([...here, ...there, side], 42 * k + 7 * j));
      }
      return kept(data, [["here", 3], ["there", 3], ["side", 1]], line);
    },
    drop(kept) { gl.deleteBuffer(kept.buffer); },
    // Clears, and looks from an azimuth and an elevation so that a ball of `radius` is seen whole, and `breadth` to both sides; with
    // a share `quality` of the pixels that there are in a row.
    begin(azimuth, elevation, radius, breadth, quality) {
      const ratio = (window.devicePixelRatio || 1) * quality;
      const wide = Math.round(canvas.clientWidth * ratio), high = Math.round(canvas.clientHeight * ratio);
      if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
      gl.viewport(0, 0, wide, high);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
      const right = [-sa, ca, 0], up = [-se * ca, -se * sa, ce], eye = [ce * ca, ce * sa, se];
      const away = 6 * radius, near = 2 * radius, far = 10 * radius, size = Math.min(wide / breadth, high / radius);
      const f = [away * size / wide, away * size / high];
      const a = (far + near) / (far - near), b = -2 * far * near / (far - near), matrix = [];
      for (let k = 0; k < 3; k++) matrix.push(f[0] * right[k], f[1] * up[k], -a * eye[k], -eye[k]);
      matrix.push(0, 0, a * away + b, away);
      view = { matrix, right, eye, ratio, wide, high, light: unit(plus(plus(times(up, 0.8), times(right, -0.45)), times(eye, 0.7))) };
      return view;
    },
    // Colours are lists of red, green and blue; a body that is not opaque shows its nearest side alone, and `faint` is what is
    // seen of it through others.
    drawSolid(kept, { q, stretch, offset, colours, opacity = 1, hides = true, faint = 0 }) {
      use(solid, kept, q, stretch, offset);
      // of faces that coincide the opaque one is seen
      gl.polygonOffset(opacity < 1 ? 1 : 0, opacity < 1 ? 4 : 0);
      gl.uniform3fv(solid.places.colours, colours.concat(colours, colours).slice(0, 3).flat());
      gl.uniform3fv(solid.places.eye, view.eye);
      gl.uniform3fv(solid.places.light, view.light);
      if (faint) {
        gl.depthMask(false);
        gl.depthFunc(gl.GREATER);
        gl.uniform1f(solid.places.opacity, faint);
        gl.drawArrays(gl.TRIANGLES, 0, kept.count);
      }
      gl.uniform1f(solid.places.opacity, opacity);
      gl.depthFunc(gl.LEQUAL);
      gl.depthMask(hides);
      if (opacity < 1 && hides) {
        gl.colorMask(false, false, false, false);
        gl.drawArrays(gl.TRIANGLES, 0, kept.count);
        gl.colorMask(true, true, true, true);
      }
      gl.drawArrays(gl.TRIANGLES, 0, kept.count);
      gl.depthMask(true);
    },
    // What bodies hide of a line is faint; `pieces` of it are drawn.
    drawLine(kept, { q = [1, 0, 0, 0], stretch, offset, colour, width = 2, pieces = Infinity, faint = 0.3 }) {
      use(line, kept, q, stretch, offset);
      gl.uniform3fv(line.places.colour, colour);
      gl.uniform2f(line.places.size, view.wide, view.high);
      gl.uniform1f(line.places.width, width * view.ratio);
      gl.depthMask(false);
      for (const [test, opacity] of [[gl.GREATER, faint], [gl.LEQUAL, 1]]) {
        gl.depthFunc(test);
        gl.uniform1f(line.places.opacity, opacity);
        gl.drawArrays(gl.TRIANGLES, 0, Math.min(kept.count, 6 * pieces));
      }
      gl.depthFunc(gl.LEQUAL);
      gl.depthMask(true);
    },
    // Where a point is seen, pixels of the page from the left and the top of the canvas.
    seen(v) {
      const m = view.matrix, [x, y, , w] = [0, 1, 2, 3].map(k => m[k] * v[0] + m[4 + k] * v[1] + m[8 + k] * v[2] + m[12 + k]);
      return [(1 + x / w) * canvas.clientWidth / 2, (1 - y / w) * canvas.clientHeight / 2];
    },
  };
}

// A ball of radius 1, and an arrow along z of length 1: lists of coordinates, corners and nothing else.
function ballOf(sides) {
  const vertices = [], triangles = [];
  for (let j = 0; j <= sides / 2; j++) {
    for (let k = 0; k < sides; k++) {
      const [s, h, a] = [Math.sin(2 * Math.PI * j / sides), -Math.cos(2 * Math.PI * j / sides), 2 * Math.PI * k / sides];
      vertices.push(s * Math.cos(a), s * Math.sin(a), h);
      const [m, n, next] = [j * sides + k, j * sides + (k + 1) % sides, sides];
      if (j < sides / 2) triangles.push(m, n, n + next, m, n + next, m + next);
    }
  }
  return [vertices, triangles];
}
function arrowHead(sides) {
  const vertices = [0, 0, 1, 0, 0, 0], triangles = [];
  for (let k = 0; k < sides; k++) {
    const a = 2 * Math.PI * k / sides, [m, n] = [2 + k, 2 + (k + 1) % sides];
    vertices.push(Math.cos(a) / 3, Math.sin(a) / 3, 0);
    triangles.push(m, n, 0, n, m, 1);
  }
  return [vertices, triangles];
}
