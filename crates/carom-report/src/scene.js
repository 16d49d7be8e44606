// Draws the scene of a run: bodies by WebGL, lines and arrows of the plane on a canvas above it.
const scene = async (root, data) => {
  const [canvas, over] = root.querySelectorAll("canvas"), frames = data.frames, N = data.nodes, D = data.dimension;
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  // Without WebGL 2 the figures remain.
  const leave = () => {
    const note = document.createElement("p");
    note.className = "small";
    note.textContent = "The animation needs WebGL 2, which this browser does not offer here. The figures below show the same run.";
    root.hidden = true;
    root.before(note);
  };
  if (!gl || typeof DecompressionStream === "undefined") return leave();
  const find = name => root.querySelector(name), isSolid = D === 3;

  // The mesh, reference positions, and the numbers of each frame.
  const text = Uint8Array.from(atob(data.packed), c => c.charCodeAt(0));
  const plain = new Blob([text]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(plain).arrayBuffer());
  let next = 0;
  const words = count => { const list = new Uint32Array(bytes.buffer.slice(next, next += 4 * count)); return list; };
  const numbers = count => {
    const list = new Uint16Array(count);
    for (let i = 0; i < count; i++) list[i] = bytes[next + i] | bytes[next + count + i] << 8;
    next += 2 * count;
    return list;
  };
  const facets = [];
  data.facets.forEach((count, k) => {
    const size = (k + 2) * (k + 3) / 2, all = words(count * size);
    for (let i = 0; i < count; i++) facets.push({ degree: k + 1, nodes: all.subarray(i * size, (i + 1) * size) });
  });
  const cells = data.cells.map(([isCube, degree, count]) => ({ isCube, degree, nodes: words(count) }));
  const flags = numbers(facets.length);
  const places = data.places.map(([low, high]) => Float32Array.from(numbers(N), n => low + n * (high - low) / data.placed));
  const shown = [];
  frames.forEach((_, k) => shown.push(data.ranges.map((_, channel) => {
    const now = new Int16Array(N), steps = numbers(N);
    const last = k > 0 ? shown[k - 1][channel] : null, older = k > 1 && channel < D ? shown[k - 2][channel] : null;
    let error = 0;
    for (let i = 0; i < N; i++) {
      error += (steps[i] >>> 1) ^ -(steps[i] & 1);
      now[i] = error + (older ? 2 * last[i] - older[i] : last ? last[i] : 0);
    }
    return now;
  })));
  // Numbers of a channel in a frame.
  const channel = (k, c) => {
    const [low, high] = data.ranges[c], by = c < D ? high / data.moved : (high - low) / data.levels, from = c < D ? 0 : low;
    return Float32Array.from(shown[k][c], n => c >= D && n < 0 ? NaN : from + n * by);
  };
  const combined = (k, quantity) => {
    const parts = quantity.channels.map(c => channel(k, c)), sum = f => i => parts.reduce((s, part) => s + f(part[i]), 0);
    const of = { value: i => parts[0][i], length: i => Math.sqrt(sum(x => x * x)(i)), mean: i => sum(x => x)(i) / parts.length,
      dilation: i => Math.expm1(sum(x => x)(i)) }[quantity.rule];
    return Float32Array.from({ length: N }, (_, i) => of(i));
  };

  // Each triangle is drawn as small flat ones between points of its polynomials.
  const fine = facets.length > 1500 ? [0, 1, 2, 3] : [0, 1, 4, 6];
  const shape = (degree, [a, b, c]) => {
    const l = [a, b, c], pairs = [[a, b], [b, c], [c, a]];
    if (degree === 1) return l;
    if (degree === 2) return [...l.map(x => x * (2 * x - 1)), ...pairs.map(([x, y]) => 4 * x * y)];
    return [...l.map(x => x * (3 * x - 1) * (3 * x - 2) / 2),
      ...pairs.flatMap(([x, y]) => [4.5 * x * y * (3 * x - 1), 4.5 * x * y * (3 * y - 1)]), 27 * a * b * c];
  };
  const grids = [1, 2, 3].map(degree => {
    const m = fine[degree], weights = [], triangles = [], at = (i, j) => j * (m + 1) - j * (j - 1) / 2 + i;
    for (let j = 0; j <= m; j++) for (let i = 0; i <= m - j; i++) {
      weights.push(shape(degree, [1 - (i + j) / m, i / m, j / m]));
      if (i + j < m) triangles.push(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + j < m - 1) triangles.push(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
    const along = Array.from({ length: m + 1 }, (_, i) => i);
    return { weights, triangles, sides: [along.map(i => at(i, 0)), along.map(i => at(m - i, i)), along.map(i => at(0, m - i))] };
  });
  const triangles = [], edges = [], marked = [[], []], outline = new Map();
  let V = 0;
  facets.forEach((facet, f) => {
    const grid = grids[facet.degree - 1];
    facet.first = V;
    V += grid.weights.length;
    for (const i of grid.triangles) triangles.push(facet.first + i);
    for (let e = 0; e < 3; e++) if (flags[f] >> e & 1) {
      const a = facet.nodes[e], b = facet.nodes[(e + 1) % 3], key = Math.min(a, b) + "," + Math.max(a, b);
      const line = grid.sides[e].map(i => facet.first + i), side = flags[f] >> (3 + 2 * e) & 3;
      // Two bodies of the plane share no edge, and an edge inside a body has two triangles.
      outline.set(key, outline.has(key) ? null : { line, side });
      for (let i = 1; i < line.length; i++) {
        edges.push(line[i - 1], line[i]);
        for (const k of [0, 1]) if (side >> k & 1) marked[k].push(line[i - 1], line[i]);
      }
    }
  });
  const boundary = [...outline.values()].filter(Boolean);
  const position = new Float32Array(3 * V), value = new Float32Array(V);

  const vertex = `#version 300 es
    uniform mat3 turn; uniform vec3 middle; uniform vec4 view; uniform float reach; uniform float before;
    uniform vec3 image; uniform vec3 origin; uniform float sign; uniform vec2 span;
    in vec3 place; in float value;
    out vec3 seen; out vec3 body; out float share;
    void main() {
      body = place;
      seen = turn * (image * (place - origin) + origin - middle);
      share = (sign * value - span.x) / (span.y - span.x);
      // Lines lie a little before their faces, which would hide them where depths are coarse.
      gl_Position = vec4((seen.xy + view.xy) * view.zw, -seen.z / reach - before, 1.0);
    }`;
  const fragment = `#version 300 es
    precision highp float;
    uniform sampler2D colors; uniform int count; uniform int kind; uniform vec3 ink; uniform vec4 cut;
    in vec3 seen; in vec3 body; in float share;
    out vec4 color;
    void main() {
      // Lines and the skin are cut; faces of the section (kind 2) are where the cut is.
      if (kind != 2 && dot(cut.xyz, body) > cut.w) discard;
      if (kind == 1) { color = vec4(ink, 1.0); return; }
      vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
      // Little shade, so that colours are found at the bar.
      float light = kind == 0 ? 0.91 + 0.09 * max(0.0, dot(normal, vec3(-0.32, 0.51, 0.8))) : 1.0;
      int band = clamp(int(floor(share * float(count))), 0, count - 1);
      vec3 surface = share == share ? texelFetch(colors, ivec2(band, 0), 0).rgb : vec3(1.0);
      color = vec4(kind == 0 && !gl_FrontFacing ? vec3(0.62) : surface * light, 1.0);
    }`;
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source); gl.compileShader(shader); gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return;
  gl.useProgram(program);
  const at = Object.fromEntries(["turn", "middle", "view", "reach", "before", "image", "origin", "sign", "span", "count", "kind", "ink", "cut"]
    .map(name => [name, gl.getUniformLocation(program, name)]));
  const spots = ["place", "value"].map(name => gl.getAttribLocation(program, name));
  const stored = list => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, Uint32Array.from(list), gl.STATIC_DRAW);
    return { buffer, count: list.length };
  };
  const lists = { triangles: stored(triangles), edges: stored(edges), marked: marked.map(stored) };
  const of = {}, sizes = {};
  for (const name of ["skin", "section", "rigid"]) of[name] = [gl.createBuffer(), gl.createBuffer()];
  const load = (name, points, values) => {
    [points, values].forEach((list, k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, of[name][k]);
      gl.bufferData(gl.ARRAY_BUFFER, list, gl.DYNAMIC_DRAW);
    });
    sizes[name] = points.length / 3;
  };
  const bind = name => of[name].forEach((buffer, k) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(spots[k]);
    gl.vertexAttribPointer(spots[k], k ? 1 : 3, gl.FLOAT, false, 0, 0);
  });
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);

  // Tetrahedra that fill the cells, for sections: Kuhn's division of the cubes of a lattice, of which
  // a tetrahedron keeps those with m ≥ x ≥ y ≥ z ≥ 0.
  let filled = null;
  const lattice = ({ isCube, degree: m }) => {
    const found = new Map(), key = p => p.join(), corner = isCube
      ? [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
      : [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]];
    const lines = isCube ? [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]]
      : [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    const faces = isCube ? [[0, 7], [1, 6], [0, 5], [3, 6], [0, 2], [4, 6]] : [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]];
    let number = 0;
    const add = weighted => found.set(key([0, 1, 2].map(d => Math.round(weighted.reduce((s, [c, w]) => s + w * corner[c][d], 0)))), number++);
    corner.forEach((_, c) => add([[c, m]]));
    for (const [a, b] of lines) for (let i = 1; i < m; i++) add([[a, m - i], [b, i]]);
    if (m > 1) for (const face of faces) if (isCube || m > 2) add(face.map(c => [c, m / face.length]));
    if (isCube && m > 1) add([[0, 1], [6, 1]]);
    const parts = [], orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    for (let x = 0; x < m; x++) for (let y = 0; y < m; y++) for (let z = 0; z < m; z++) for (const order of orders) {
      const points = [[x, y, z]];
      for (const d of order) points.push(points[points.length - 1].map((v, i) => v + (i === d)));
      if (isCube || points.every(([a, b, c]) => a >= b && b >= c)) parts.push(points.map(p => found.get(key(p))));
    }
    return { size: number, parts };
  };
  const tetrahedra = () => filled ??= Uint32Array.from(cells.flatMap(cell => {
    const { size, parts } = lattice(cell), list = [];
    for (let c = 0; c < cell.nodes.length; c += size) for (const part of parts) for (const i of part) list.push(cell.nodes[c + i]);
    return list;
  }));
  const section = (points, values) => {
    const list = tetrahedra(), places = [], numbers = [], height = n => cut[0] * points[0][n] + cut[1] * points[1][n] + cut[2] * points[2][n] - cut[3];
    const put = (a, b) => {
      const [p, q] = [height(a), height(b)], s = p / (p - q);
      for (const x of points) places.push(x[a] + s * (x[b] - x[a]));
      numbers.push(values[a] + s * (values[b] - values[a]));
    };
    for (let i = 0; i < list.length; i += 4) {
      const inside = [], outside = [];
      for (let k = 0; k < 4; k++) (height(list[i + k]) > 0 ? outside : inside).push(list[i + k]);
      if (!inside.length || !outside.length) continue;
      if (inside.length !== 2) {
        const [one, rest] = inside.length === 1 ? [inside[0], outside] : [outside[0], inside];
        for (const n of rest) put(one, n);
      } else {
        const [[a, b], [c, d]] = [inside, outside];
        for (const [m, n] of [[a, c], [a, d], [b, d], [a, c], [b, d], [b, c]]) put(m, n);
      }
    }
    load("section", Float32Array.from(places), Float32Array.from(numbers));
  };

  // The view.
  let turn, fit, zoom, shift, frame = 0, quantity = data.quantities[0], cut = [0, 0, 0, 1], queued = false, W = 1, H = 1, ratio = 1;
  const [low, high] = data.box, size = low.map((x, d) => high[d] - x);
  const on = name => find(name)?.checked;
  const mirrors = () => data.mirrors.filter((_, k) => root.querySelectorAll(".mirror")[k].checked);
  // Signs and origin of each image: the bodies, and their mirror images.
  const images = () => mirrors().reduce((list, [axis, x]) => list.flatMap(({ image, origin }) => {
    const [other, foot] = [[...image], [...origin]];
    other[axis] = -1; foot[axis] = x;
    return [{ image, origin: foot }, { image: other, origin: foot }];
  }), [{ image: [1, 1, 1], origin: [0, 0, 0] }]);
  const frameBox = () => {
    const ends = [[...low], [...high]];
    for (const [axis, x] of mirrors()) { ends[0][axis] = Math.min(low[axis], 2 * x - high[axis]); ends[1][axis] = Math.max(high[axis], 2 * x - low[axis]); }
    return ends;
  };
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const middle = () => { const [a, b] = frameBox(); return a.map((x, d) => (x + b[d]) / 2); };
  const reach = Math.hypot(...size) || 1, PAD = 34;
  // Pixels per unit of length at zoom 1: the box fills the picture in the first view, or in the chosen one.
  const fitted = () => {
    const [a, b] = frameBox(), wide = [0, 1].map(k => a.reduce((s, x, d) => s + Math.abs(fit[k][d]) * (b[d] - x), 0));
    return Math.min((W - 2 * PAD) / (wide[0] || 1e-12), (H - 2 * PAD) / (wide[1] || 1e-12));
  };
  const home = (view = data.view) => { fit = view; turn = view.map(axis => [...axis]); zoom = 1; shift = [0, 0]; };
  home();
  const resize = () => {
    const [a, b] = frameBox(), aspect = (b[1] - a[1]) / (b[0] - a[0]), isFull = document.fullscreenElement === root;
    W = Math.max(160, canvas.parentElement.clientWidth);
    const tall = Math.max(300, 0.58 * window.innerHeight);
    // Flat bodies are in the middle of the height that the colour bar needs.
    const bar = Math.max(130, ...[...root.querySelectorAll(".bar")].map(each => each.clientHeight));
    H = isFull ? Math.max(200, canvas.parentElement.clientHeight) : isSolid ? Math.min(tall, 0.75 * W) : Math.max(bar, Math.min(tall, aspect * (W - 2 * PAD) + 2 * PAD));
    ratio = Math.min(3, window.devicePixelRatio || 1);
    for (const each of [canvas, over]) { each.width = W * ratio; each.height = H * ratio; each.style.height = H + "px"; }
    // The new size has cleared both: drawn at once, they do not flicker.
    if (shown.length) render();
  };
  const scale = () => zoom * fitted();
  const projected = (p, { image, origin } = { image: [1, 1, 1], origin: [0, 0, 0] }) => {
    const m = middle(), q = p.map((x, d) => image[d] * (x - origin[d]) + origin[d] - m[d]), s = scale();
    return [W / 2 + (dot(turn[0], q) + shift[0]) * s, H / 2 - (dot(turn[1], q) + shift[1]) * s];
  };

  const g = over.getContext("2d"), LONGEST = 44;
  const style = name => getComputedStyle(document.body).getPropertyValue(name).trim();
  const arrow = (from, along, ink, paper) => {
    const length = Math.hypot(...along);
    if (length < 2) return;
    const [dx, dy] = along.map(x => x / length), head = Math.min(6, 0.6 * length), [ex, ey] = [from[0] + along[0], from[1] + along[1]];
    g.beginPath();
    g.moveTo(...from); g.lineTo(ex - dx * head, ey - dy * head);
    g.moveTo(ex, ey);
    g.lineTo(ex - dx * head - dy * head * 0.42, ey - dy * head + dx * head * 0.42);
    g.lineTo(ex - dx * head + dy * head * 0.42, ey - dy * head - dx * head * 0.42);
    g.closePath();
    g.lineWidth = 2.8; g.strokeStyle = paper; g.stroke();
    g.lineWidth = 1.1; g.strokeStyle = g.fillStyle = ink; g.stroke(); g.fill();
  };
  // A rigid outline with hatching on its inner side; a triangle moves with a plane, which looks the same
  // wherever it is.
  const wall = (list, [x, y, sin, cos], image, isMarked, ink) => {
    const point = (a, b) => projected([x + cos * a - sin * b, y + sin * a + cos * b, 0], image);
    g.lineWidth = 1.6; g.strokeStyle = g.fillStyle = ink; g.beginPath();
    let rest = 0, last = null;
    for (let i = 0; i < list.length; i += 4) {
      const p = point(list[i], list[i + 1]), q = point(list[i] - list[i + 2], list[i + 1] - list[i + 3]);
      const l = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1, n = [(q[0] - p[0]) / l, (q[1] - p[1]) / l];
      if (last) {
        g.moveTo(...last); g.lineTo(...p);
        const dx = p[0] - last[0], dy = p[1] - last[1], long = Math.hypot(dx, dy);
        for (; rest < long && long < 1e5; rest += 7) {
          const a = last[0] + dx * rest / long, b = last[1] + dy * rest / long;
          g.moveTo(a, b); g.lineTo(a + 5 * (n[0] - n[1]), b + 5 * (n[1] + n[0]));
        }
        rest = Math.max(0, rest - long);
      }
      last = p;
      if (isMarked && 2 * i === list.length - 4) {
        const foot = [p[0] + 13 * n[0], p[1] + 13 * n[1]];
        g.fill(new Path2D(`M${p}L${foot[0] - 6 * n[1]} ${foot[1] + 6 * n[0]}L${foot[0] + 6 * n[1]} ${foot[1] - 6 * n[0]}z`));
      }
    }
    g.stroke();
  };
  const SIDES = ["#d55e00", "#0072b2"];
  const above = () => {
    const ink = style("--ink"), paper = style("--paper");
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, W, H);
    for (const image of images()) {
      if (!isSolid) {
        const trace = line => line.forEach((v, i) => g[i ? "lineTo" : "moveTo"](...projected([position[3 * v], position[3 * v + 1], 0], image)));
        for (let side = 0; side < 3; side++) {
          g.beginPath();
          for (const part of boundary) if (part.side & side || !side) trace(part.line);
          if (side && !on(".sides")) continue;
          g.lineWidth = side ? 3 : 1.1; g.strokeStyle = side ? SIDES[side - 1] : ink; g.lineJoin = "round"; g.stroke();
        }
        data.rigid.walls.forEach((list, j) => wall(list, data.rigid.poses[frame][j], image, data.rigid.marked[j], ink));
      }
      const f = frames[frame].forces;
      if (!on(".arrows")) continue;
      // Arrows closer than a few pixels would be a black band.
      for (let i = 0, last = null; i < f.length; i += 2 * D) {
        const [p, force] = [0, D].map(by => [0, 1, 2].map(d => d < D ? f[i + by + d] : 0)), from = projected(p, image);
        if (last && Math.hypot(from[0] - last[0], from[1] - last[1]) < 7) continue;
        const along = [0, 1].map(k => (k ? -1 : 1) * dot(turn[k], force.map((x, d) => x * image.image[d])) * LONGEST / data.largest);
        arrow(from, along, ink, paper);
        last = from;
      }
    }
    if (!isSolid) return;
    g.strokeStyle = g.fillStyle = ink; g.lineWidth = 1.2;
    g.font = "italic 13px Helvetica, Arial, sans-serif"; g.textAlign = "center"; g.textBaseline = "middle";
    ["x", "y", "z"].forEach((name, d) => {
      g.beginPath(); g.moveTo(40, H - 40); g.lineTo(40 + 24 * turn[0][d], H - 40 - 24 * turn[1][d]); g.stroke();
      g.fillText(name, 40 + 32 * turn[0][d], H - 40 - 32 * turn[1][d]);
    });
  };
  const tone = color => [1, 3, 5].map(k => parseInt(color.slice(k, k + 2), 16) / 255);
  const render = () => {
    queued = false;
    if (!sizes.skin) return;
    const s = scale(), m = middle(), isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1);
    gl.uniformMatrix3fv(at.turn, false, [0, 1, 2].flatMap(column => turn.map(row => row[column])));
    gl.uniform3fv(at.middle, m); gl.uniform1f(at.reach, 2 * reach); gl.uniform4fv(at.cut, cut);
    gl.uniform4f(at.view, shift[0], shift[1], 2 * s / W, 2 * s / H);
    gl.uniform2f(at.span, quantity.low, quantity.high);
    const lines = (list, ink, before) => {
      gl.uniform1i(at.kind, 1); gl.uniform3fv(at.ink, ink); gl.uniform1f(at.before, before);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, list.buffer);
      gl.drawElements(gl.LINES, list.count, gl.UNSIGNED_INT, 0);
    };
    for (const { image, origin } of images()) {
      const flips = image[0] * image[1] * image[2];
      gl.frontFace(flips < 0 ? gl.CW : gl.CCW);
      gl.uniform3fv(at.image, image); gl.uniform3fv(at.origin, origin);
      gl.uniform1f(at.sign, quantity.odd.reduce((sign, odd, d) => odd ? sign * image[d] : sign, 1));
      bind("skin");
      gl.uniform1i(at.kind, 0); gl.uniform1f(at.before, 0);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lists.triangles.buffer);
      gl.drawElements(gl.TRIANGLES, lists.triangles.count, gl.UNSIGNED_INT, 0);
      if (on(".mesh")) lines(lists.edges, [0.2, 0.2, 0.2], isSolid ? 0.002 : 0.5);
      if (isSolid && on(".sides")) marked.forEach((_, k) => lines(lists.marked[k], tone(SIDES[k]), 0.003));
      if (cut[3] !== 1 && sizes.section) {
        bind("section");
        gl.uniform1i(at.kind, 2); gl.uniform1f(at.before, 0);
        gl.drawArrays(gl.TRIANGLES, 0, sizes.section);
      }
    }
    gl.uniform3fv(at.image, [1, 1, 1]); gl.uniform3fv(at.origin, [0, 0, 0]);
    if (isSolid && sizes.rigid) {
      bind("rigid");
      gl.uniform1i(at.kind, 1); gl.uniform3fv(at.ink, isDark ? [0.5, 0.5, 0.5] : [0.65, 0.65, 0.65]); gl.uniform1f(at.before, 0);
      gl.drawArrays(gl.LINES, 0, sizes.rigid);
    }
    above();
  };
  const redraw = () => { if (!queued) { queued = true; requestAnimationFrame(render); } };
  const fill = k => {
    frame = k;
    const moved = Array.from({ length: D }, (_, d) => channel(k, d)), values = combined(k, quantity);
    const points = places.map((list, d) => d < D ? list.map((x, i) => x + moved[d][i]) : list);
    for (const { degree, nodes, first } of facets) grids[degree - 1].weights.forEach((weights, i) => {
      const v = first + i;
      let [x, y, z, w] = [0, 0, 0, 0];
      for (let j = 0; j < weights.length; j++) {
        const n = nodes[j], share = weights[j];
        x += share * points[0][n]; y += share * points[1][n]; z += share * points[2][n]; w += share * values[n];
      }
      position[3 * v] = x; position[3 * v + 1] = y; position[3 * v + 2] = z; value[v] = w;
    });
    load("skin", position, value);
    if (cut[3] !== 1 && cells.length) section(points, values);
    if (isSolid) {
      const lines = data.rigid.lines.flatMap((list, j) => list.map((_, i) => {
        const [a, b, c, shift] = data.rigid.moves[k][j][i % 3], first = i - i % 3;
        return a * list[first] + b * list[first + 1] + c * list[first + 2] + shift;
      }));
      load("rigid", Float32Array.from(lines), new Float32Array(lines.length / 3));
    }
    render();
  };
  const paint = () => {
    const texels = Uint8Array.from(quantity.colors.flatMap(c => [...tone(c).map(x => 255 * x), 255]));
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, quantity.colors.length, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, texels);
    gl.uniform1i(at.count, quantity.colors.length);
  };

  // Turned by angles about the axes of the page; rows stay orthonormal.
  const rotate = (i, j, angle) => {
    const [a, b] = [turn[i], turn[j]];
    turn[i] = a.map((x, d) => x * Math.cos(angle) + b[d] * Math.sin(angle));
    turn[j] = b.map((x, d) => x * Math.cos(angle) - a[d] * Math.sin(angle));
    const one = v => v.map(x => x / Math.hypot(...v)), off = (v, w) => v.map((x, d) => x - dot(v, w) * w[d]);
    turn[0] = one(turn[0]); turn[1] = one(off(turn[1], turn[0])); turn[2] = one(off(off(turn[2], turn[0]), turn[1]));
    redraw();
  };
  const move = (x, y) => { shift[0] += x / scale(); shift[1] -= y / scale(); redraw(); };
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
    } else if (event.shiftKey || event.buttons & 6 || !isSolid) move(dx, dy);
    else if (event.altKey) rotate(0, 1, dx * 0.01);
    else { rotate(0, 2, -dx * 0.01); rotate(1, 2, -dy * 0.01); }
    fingers.set(event.pointerId, to);
  });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, event => fingers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("wheel", event => {
    if (document.activeElement !== canvas) return;
    closer(Math.exp(-0.0015 * event.deltaY)); event.preventDefault();
  }, { passive: false });
  canvas.addEventListener("keydown", event => {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const wide = { "+": 1.2, "=": 1.2, "-": 1 / 1.2, "−": 1 / 1.2 }[event.key];
    if (arrows && (event.shiftKey || !isSolid)) move(20 * arrows[0], 20 * arrows[1]);
    else if (arrows) { rotate(0, 2, 0.1 * arrows[0]); rotate(1, 2, -0.1 * arrows[1]); }
    else if (wide) closer(wide);
    else if (event.key === "0") { home(); redraw(); }
    else return;
    event.preventDefault(); event.stopPropagation();
  });
  find(".quantity").addEventListener("change", event => {
    quantity = data.quantities[event.target.value];
    root.querySelectorAll(".bar").forEach((bar, k) => { bar.hidden = k !== +event.target.value; });
    paint(); fill(frame);
  });
  const axis = name => ["xyz".indexOf(name.slice(-1)), name.length > 1 ? -1 : 1];
  const cutting = () => {
    const plane = find(".cut").value, depth = find(".depth");
    depth.disabled = !plane;
    cut = [0, 0, 0, 1];
    if (plane) {
      const [d, sign] = axis(plane);
      cut[d] = sign; cut[3] = sign * (low[d] + (0.002 + 0.996 * depth.value) * size[d]);
      if (cut[3] === 1) cut[3] += 1e-6;
    }
    fill(frame);
  };
  find(".cut")?.addEventListener("change", cutting);
  find(".depth")?.addEventListener("input", cutting);
  // Seen along an axis, with z up, or y where that is the axis.
  find(".from")?.addEventListener("change", event => {
    home();
    if (event.target.value) {
      const [d, sign] = axis(event.target.value), unit = k => [0, 1, 2].map(i => +(i === k)), up = d === 2 ? 1 : 2;
      const eye = unit(d).map(x => sign * x), [a, b] = [unit(up), eye];
      home([[a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], a, b]);
    }
    redraw();
  });
  root.querySelectorAll(".mesh, .sides, .arrows").forEach(tick => tick.addEventListener("change", redraw));
  root.querySelectorAll(".mirror").forEach(tick => tick.addEventListener("change", resize));
  find(".home").addEventListener("click", () => { home(); if (find(".from")) find(".from").value = ""; redraw(); });
  find(".full").addEventListener("click", () => document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  canvas.addEventListener("webglcontextlost", leave, { once: true });
  root.hidden = false;
  resize();
  new ResizeObserver(resize).observe(canvas.parentElement);
  paint();
  // A node takes two vectors: its place and its force.
  const isForce = i => i % (2 * D) >= D;
  const force = f => f.forces.reduce((sum, x, i) => isForce(i) ? sum + Math.abs(x) : sum, 0);
  player(root, frames, data.unit, fill, force, data.first);
};
