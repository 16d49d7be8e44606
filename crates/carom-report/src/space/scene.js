(async () => {
  const data = JSON.parse(document.getElementById("animation-data").textContent);
  const root = document.getElementById("animation"), frames = data.frames, N = data.nodes;
  const [canvas, corner] = root.querySelectorAll("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  // Without WebGL 2 the figures remain.
  if (!gl || typeof DecompressionStream === "undefined") return;

  // Triangles, edges, reference positions, and what differs from expectation in each frame.
  const packed = Uint8Array.from(atob(data.packed), c => c.charCodeAt(0));
  const plain = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(plain).arrayBuffer());
  const triangles = new Uint32Array(bytes.buffer, 0, data.triangles);
  const edges = new Uint32Array(bytes.buffer, 4 * data.triangles, data.edges);
  let next = 4 * (data.triangles + data.edges);
  const numbers = () => {
    const list = new Uint16Array(N);
    for (let i = 0; i < N; i++) list[i] = bytes[next + i] | bytes[next + N + i] << 8;
    next += 2 * N;
    return list;
  };
  const places = [0, 1, 2].map(d => Float32Array.from(numbers(), n => data.low[d] + n * (data.high[d] - data.low[d]) / 65535));
  // Three of the displacement, the last quantity, and one of each other quantity.
  const stored = data.quantities.length - 1, channels = 3 + stored, shown = [];
  frames.forEach((_, k) => {
    shown.push(Array.from({ length: channels }, (_, channel) => {
      const now = new Int16Array(N), steps = numbers();
      const last = k > 0 ? shown[k - 1][channel] : null, older = k > 1 && channel < 3 ? shown[k - 2][channel] : null;
      let error = 0;
      for (let i = 0; i < N; i++) {
        error += (steps[i] >>> 1) ^ -(steps[i] & 1);
        now[i] = error + (older ? 2 * last[i] - older[i] : last ? last[i] : 0);
      }
      return now;
    }));
  });

  const vertex = `#version 300 es
    uniform mat3 turn; uniform vec3 middle; uniform vec4 view; uniform float reach; uniform bool lines;
    in vec3 place; in float value;
    out vec3 seen; out vec3 body; out float share;
    void main() {
      seen = turn * (place - middle); body = place; share = value;
      // Edges lie a little before their faces, which would hide them where depths are coarse.
      gl_Position = vec4((seen.xy + view.xy) * view.zw, -seen.z / reach - (lines ? 0.015 : 0.0), 1.0);
    }`;
  const fragment = `#version 300 es
    precision highp float;
    uniform sampler2D colors; uniform int count; uniform bool lines; uniform float grey; uniform vec4 cut;
    in vec3 seen; in vec3 body; in float share;
    out vec4 color;
    void main() {
      if (dot(cut.xyz, body) > cut.w) discard;
      vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
      // Little shade, so that colours are found at the bar.
      float light = 0.91 + 0.09 * max(0.0, dot(normal, vec3(-0.32, 0.51, 0.8)));
      int band = clamp(int(floor(share * float(count))), 0, count - 1);
      vec3 surface = share < -0.001 ? vec3(1.0) : texelFetch(colors, ivec2(band, 0), 0).rgb;
      color = vec4(lines ? vec3(grey) : gl_FrontFacing ? surface * light : vec3(0.62), 1.0);
    }`;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return;
  gl.useProgram(program);
  const at = Object.fromEntries(["turn", "middle", "view", "reach", "count", "lines", "grey", "cut"].map(n => [n, gl.getUniformLocation(program, n)]));
  const spots = ["place", "value"].map(name => gl.getAttribLocation(program, name));
  const bind = (buffer, k) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(spots[k]);
    gl.vertexAttribPointer(spots[k], k ? 1 : 3, gl.FLOAT, false, 0, 0);
  };
  const buffers = [0, 1].map(() => gl.createBuffer()), rigid = gl.createBuffer();
  const corners = data.rigid.reduce((sum, list) => sum + list.length / 3, 0);
  const indices = [triangles, edges].map(list => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, list, gl.STATIC_DRAW);
    return buffer;
  });
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);

  // The middle and the size of the picture hold for all frames.
  const position = new Float32Array(3 * N), value = new Float32Array(N), unit = data.largest / 32767;
  const low = [1, 1, 1].map(() => Infinity), high = low.map(() => -Infinity);
  for (const u of shown) for (let d = 0; d < 3; d++) for (let i = 0; i < N; i++) {
    const x = places[d][i] + u[d][i] * unit;
    if (x < low[d]) low[d] = x;
    if (x > high[d]) high[d] = x;
  }
  const middle = low.map((x, d) => (x + high[d]) / 2), radius = Math.hypot(...low.map((x, d) => high[d] - x)) / 2 || 1;
  const W = 400, H = 430, ratio = Math.min(2, window.devicePixelRatio || 1);
  canvas.width = W * ratio; canvas.height = H * ratio;
  canvas.style.width = W + "px"; canvas.style.aspectRatio = W + " / " + H;
  corner.width = corner.height = 160;
  // A fifth of the picture, so that it stays beside the bodies of a small one.
  corner.style.cssText = "width: 20%; height: auto; max-width: 80px";
  const flat = corner.getContext("2d");

  let turn, zoom, shift, frame = 0, quantity = 0, cut = [0, 0, 0, 1], queued = false;
  const home = () => { turn = data.view.map(axis => [...axis]); zoom = 1; shift = [0, 0.06 * radius]; };
  home();
  const render = () => {
    queued = false;
    const scale = zoom / (1.04 * radius);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(1, 1, 1, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1);
    gl.uniformMatrix3fv(at.turn, false, [0, 1, 2].flatMap(column => turn.map(row => row[column])));
    gl.uniform3fv(at.middle, middle); gl.uniform1f(at.reach, 2 * radius);
    gl.uniform4f(at.view, shift[0], shift[1], scale * H / W, scale); gl.uniform4fv(at.cut, cut);
    buffers.forEach(bind);
    gl.uniform1f(at.grey, 0.2);
    [triangles, edges].forEach((list, k) => {
      gl.uniform1i(at.lines, k);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices[k]);
      gl.drawElements(k ? gl.LINES : gl.TRIANGLES, list.length, gl.UNSIGNED_INT, 0);
    });
    // Rigid obstacles: the last list was lines.
    bind(rigid, 0);
    gl.disableVertexAttribArray(spots[1]);
    gl.uniform1f(at.grey, 0.65);
    gl.drawArrays(gl.LINES, 0, corners);
    flat.setTransform(2, 0, 0, 2, 0, 0);
    flat.clearRect(0, 0, 80, 80);
    flat.font = `italic ${13 * Math.min(1.3, Math.max(1, 80 / (corner.clientWidth || 80)))}px Helvetica, Arial, sans-serif`; flat.textAlign = "center"; flat.textBaseline = "middle";
    ["x", "y", "z"].forEach((name, d) => {
      const [x, y] = [40 + 24 * turn[0][d], 40 - 24 * turn[1][d]];
      flat.beginPath(); flat.moveTo(40, 40); flat.lineTo(x, y); flat.stroke();
      flat.fillText(name, 40 + 32 * turn[0][d], 40 - 32 * turn[1][d]);
    });
  };
  const redraw = () => { if (!queued) { queued = true; requestAnimationFrame(render); } };
  const fill = k => {
    frame = k;
    const u = shown[k], range = data.quantities[quantity];
    for (let i = 0; i < N; i++) {
      const [x, y, z] = [u[0][i] * unit, u[1][i] * unit, u[2][i] * unit];
      position[3 * i] = places[0][i] + x; position[3 * i + 1] = places[1][i] + y; position[3 * i + 2] = places[2][i] + z;
      value[i] = quantity < stored ? u[3 + quantity][i] / data.levels : Math.hypot(x, y, z) / range.high;
    }
    [position, value].forEach((list, j) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[j]);
      gl.bufferData(gl.ARRAY_BUFFER, list, gl.DYNAMIC_DRAW);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, rigid);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(data.rigid.flatMap((list, j) => list.map((x, i) => x + data.moves[k][j][i % 3]))), gl.DYNAMIC_DRAW);
    render();
  };
  const paint = () => {
    const colors = data.quantities[quantity].colors;
    const texels = Uint8Array.from(colors.flatMap(c => [1, 3, 5].map(k => parseInt(c.slice(k, k + 2), 16)).concat(255)));
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, colors.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    gl.uniform1i(at.count, colors.length);
  };

  // Turned by angles about the axes of the page; rows stay orthonormal.
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const rotate = (across, up) => {
    const mix = (a, b, angle) => [a.map((x, d) => x * Math.cos(angle) + b[d] * Math.sin(angle)), b.map((x, d) => x * Math.cos(angle) - a[d] * Math.sin(angle))];
    [turn[0], turn[2]] = mix(turn[0], turn[2], across);
    [turn[1], turn[2]] = mix(turn[1], turn[2], -up);
    const one = a => a.map(x => x / Math.hypot(...a)), off = (a, b) => a.map((x, d) => x - dot(a, b) * b[d]);
    turn[0] = one(turn[0]); turn[1] = one(off(turn[1], turn[0])); turn[2] = one(off(off(turn[2], turn[0]), turn[1]));
    redraw();
  };
  const pixel = () => 2 * 1.04 * radius / (zoom * canvas.clientHeight);
  const move = (x, y) => { shift[0] += x * pixel(); shift[1] -= y * pixel(); redraw(); };
  const closer = by => { zoom = Math.min(200, Math.max(0.1, zoom * by)); redraw(); };
  const fingers = new Map();
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", event => {
    const from = fingers.get(event.pointerId), to = [event.clientX, event.clientY];
    if (!from) return;
    const dx = to[0] - from[0], dy = to[1] - from[1];
    if (fingers.size > 1) {
      const other = [...fingers].find(([id]) => id !== event.pointerId)[1], apart = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
      if (apart(from) > 4) closer(apart(to) / apart(from));
      move(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) move(dx, dy);
    else rotate(-dx * 0.01, dy * 0.01);
    fingers.set(event.pointerId, to);
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, event => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    if (document.activeElement !== canvas) return;
    closer(Math.exp(-0.0015 * event.deltaY)); event.preventDefault();
  }, { passive: false });
  canvas.addEventListener("keydown", event => {
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const wide = { "+": 1.2, "=": 1.2, "-": 1 / 1.2, "−": 1 / 1.2 }[event.key];
    if (arrow && event.shiftKey) move(20 * arrow[0], 20 * arrow[1]);
    else if (arrow) rotate(-0.1 * arrow[0], 0.1 * arrow[1]);
    else if (wide) closer(wide);
    else if (event.key === "0") { home(); redraw(); }
    else return;
    event.preventDefault(); event.stopPropagation();
  });
  const [plane, depth, reset] = [".cut", ".depth", ".home"].map(s => root.querySelector(s));
  coloured(root, k => { quantity = k; paint(); fill(frame); });
  reset.addEventListener("click", () => { home(); redraw(); });
  const cutting = () => {
    const d = "xyz".indexOf(plane.value.slice(-1)), sign = plane.value.length > 1 ? -1 : 1;
    depth.disabled = !plane.value;
    cut = [0, 0, 0, 1];
    if (plane.value) { cut[d] = sign; cut[3] = sign * (low[d] + depth.value * (high[d] - low[d])); }
    redraw();
  };
  plane.addEventListener("change", cutting);
  depth.addEventListener("input", cutting);
  canvas.addEventListener("webglcontextlost", () => { root.hidden = true; });
  paint();
  player(root, frames, data.unit, fill, data.first);
})();
