(() => {
  const data = JSON.parse(document.getElementById("animation-data").textContent);
  const root = document.getElementById("animation");
  const canvas = root.querySelector("canvas");
  const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
  const [left, right, low, high] = data.box;
  const unpack = (text, from, to) => Float32Array.from(new Int16Array(bytes(text)),
    i => i === -32768 ? NaN : from + (to - from) * (i + 32767) / 65534);
  const X = unpack(data.x, left, right), Y = unpack(data.y, low, high), frames = data.frames;
  const quantities = data.quantities.map(q => ({ ...q, values: unpack(q.values, ...q.range), width: (q.high - q.low) / q.colors.length }));
  let shown = quantities[0], frame = 0;
  const band = s => Math.min(shown.colors.length - 1, Math.max(0, Math.floor((s - shown.low) / shown.width)));

  // Cells, and the shape functions of each degree at the points of a subdivision.
  const numbers = new Uint32Array(bytes(data.cells));
  const cells = [], edges = new Map();
  let next = 0;
  for (const c of data.degrees) {
    const d = +c, nodes = numbers.subarray(next, next += (d + 1) * (d + 2) / 2);
    cells.push([d, nodes]);
    for (let e = 0; e < 3; e++) {
      const a = nodes[e], b = nodes[(e + 1) % 3], key = Math.min(a, b) + "," + Math.max(a, b);
      const walk = [a, ...nodes.subarray(3 + e * (d - 1), 3 + (e + 1) * (d - 1)), b];
      edges.set(key, edges.has(key) ? null : walk);
    }
  }
  const outline = [...edges.values()].filter(Boolean);
  const shape = (degree, a, b, c) => {
    const l = [a, b, c], pairs = [[a, b], [b, c], [c, a]];
    if (degree === 1) return l;
    if (degree === 2) return [...l.map(x => x * (2 * x - 1)), ...pairs.map(([x, y]) => 4 * x * y)];
    return [...l.map(x => x * (3 * x - 1) * (3 * x - 2) / 2),
      ...pairs.flatMap(([x, y]) => [4.5 * x * y * (3 * x - 1), 4.5 * x * y * (3 * y - 1)]), 27 * a * b * c];
  };
  const fine = cells.length > 1500 ? [0, 1, 2, 2] : [0, 1, 4, 5];
  const grids = [1, 2, 3].map(d => {
    const m = fine[d], points = [], triangles = [], at = (i, j) => j * (m + 1) - j * (j - 1) / 2 + i;
    for (let j = 0; j <= m; j++) for (let i = 0; i <= m - j; i++) {
      points.push(shape(d, 1 - (i + j) / m, i / m, j / m));
      if (i + j < m) triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
      if (i + j < m - 1) triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    return { points, triangles };
  });

  // Pressure along the side: number of the node, arc length, pressure; neighbours are joined.
  const profiles = [...root.querySelectorAll("g.profile")].map(g => {
    const [x0, x1, s0, s1, y0, y1, p0, p1] = g.dataset.axis.split(" ").map(Number);
    return list => {
      let line = "", dots = "";
      for (let i = 0; i < list.length; i += 3) {
        const at = (x0 + (x1 - x0) * (list[i + 1] - s0) / (s1 - s0)).toFixed(1) + " " +
          (y0 + (y1 - y0) * (Math.min(list[i + 2], p1) - p0) / (p1 - p0)).toFixed(1);
        line += (i && list[i] === list[i - 3] + 1 ? "L" : "M") + at;
        dots += `M${at}h0`;
      }
      g.children[0].setAttribute("d", line);
      g.children[1].setAttribute("d", dots);
    };
  });

  // The picture leaves a margin for arrows around the bodies.
  const aspect = (high - low) / (right - left);
  const LONGEST = 44;
  const W = data.flat || aspect < 0.5 ? 900 : Math.min(380, Math.max(220, 440 / aspect)), pad = data.largest > 0 ? LONGEST + 2 : 18;
  root.classList.toggle("wide", W > 400);
  const scale = (W - 2 * pad) / (right - left), H = Math.max(data.flat ? 110 : 0, (high - low) * scale + 2 * pad);
  const ratio = Math.max(2, window.devicePixelRatio || 1);
  canvas.width = W * ratio; canvas.height = H * ratio;
  canvas.style.width = W + "px"; canvas.style.aspectRatio = W + " / " + H;
  const g = canvas.getContext("2d"), THIN = 5;
  const px = x => pad + (x - left) * scale, py = y => H / 2 - (y - (low + high) / 2) * scale;

  const clip = (polygon, level, sign) => {
    const out = [];
    polygon.forEach((p, i) => {
      const q = polygon[(i + 1) % polygon.length], inside = sign * (p[2] - level) >= 0;
      if (inside) out.push(p);
      if (inside !== sign * (q[2] - level) >= 0) {
        const t = (level - p[2]) / (q[2] - p[2]);
        out.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), level]);
      }
    });
    return out;
  };
  const arrow = (x, y, fx, fy) => {
    const size = Math.hypot(fx, fy), length = LONGEST * size / data.largest, dx = fx / size, dy = -fy / size;
    if (length < 2) return;
    const head = Math.min(6, 0.6 * length), ex = x + dx * length, ey = y + dy * length;
    g.beginPath();
    g.moveTo(x, y); g.lineTo(ex - dx * head, ey - dy * head);
    g.moveTo(ex, ey);
    g.lineTo(ex - dx * head - dy * head * 0.42, ey - dy * head + dx * head * 0.42);
    g.lineTo(ex - dx * head + dy * head * 0.42, ey - dy * head - dx * head * 0.42);
    g.closePath();
    g.lineWidth = 2.8; g.strokeStyle = "#fff"; g.stroke();
    g.lineWidth = 1.1; g.strokeStyle = g.fillStyle = "#000"; g.stroke(); g.fill();
  };
  // The colour of a body that is thinner than its outline is drawn as a line.
  const thin = (() => {
    let area = 0, around = 0;
    for (const [, [a, b, c]] of cells) area += Math.abs((X[b] - X[a]) * (Y[c] - Y[a]) - (X[c] - X[a]) * (Y[b] - Y[a])) / 2;
    for (const walk of outline) around += Math.hypot(X[walk[0]] - X[walk[walk.length - 1]], Y[walk[0]] - Y[walk[walk.length - 1]]);
    return 2 * area * scale < THIN * around;
  })();
  const draw = k => {
    frame = k;
    const base = k * data.points, S = shown.values, paths = shown.colors.map(() => new Path2D());
    const fill = (b, polygon) => {
      polygon.forEach((p, i) => i ? paths[b].lineTo(p[0], p[1]) : paths[b].moveTo(p[0], p[1]));
      paths[b].closePath();
    };
    for (const [degree, nodes] of cells) {
      const grid = grids[degree - 1];
      const points = grid.points.map(n => {
        let x = 0, y = 0, s = 0;
        for (let i = 0; i < n.length; i++) {
          const j = base + nodes[i];
          x += n[i] * X[j]; y += n[i] * Y[j]; s += n[i] * S[j];
        }
        return [px(x), py(y), s];
      });
      for (const t of grid.triangles) {
        const corners = t.map(i => points[i]), of = corners.map(p => band(p[2]));
        if (of.some(Number.isNaN)) continue;
        const first = Math.min(...of), last = Math.max(...of);
        for (let b = first; b <= last; b++) {
          let polygon = corners;
          if (b > first) polygon = clip(polygon, shown.low + b * shown.width, 1);
          if (b < last) polygon = clip(polygon, shown.low + (b + 1) * shown.width, -1);
          if (polygon.length > 2) fill(b, polygon);
        }
      }
    }
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.fillStyle = "#fff"; g.fillRect(0, 0, W, H);
    g.lineJoin = "round";
    const trace = () => {
      g.beginPath();
      for (const walk of outline) {
        const n = walk.length, at = i => [px(X[base + walk[i]]), py(Y[base + walk[i]])];
        const p = Array.from({ length: n }, (_, i) => at(i)), mix = w => [0, 1].map(d => w.reduce((s, v, i) => s + v * p[i][d], 0));
        g.moveTo(...p[0]);
        if (n === 2) g.lineTo(...p[1]);
        else if (n === 3) g.quadraticCurveTo(...mix([-0.5, 2, -0.5]), ...p[2]);
        else g.bezierCurveTo(...mix([-5 / 6, 3, -1.5, 1 / 3]), ...mix([1 / 3, -1.5, 3, -5 / 6]), ...p[3]);
      }
    };
    trace();
    if (thin) { g.strokeStyle = "#777"; g.lineWidth = 5.2; g.stroke(); }
    paths.forEach((path, b) => {
      g.fillStyle = g.strokeStyle = shown.colors[b];
      g.fill(path); g.lineWidth = thin ? 3.5 : 0.6; g.stroke(path);
    });
    if (!thin) { trace(); g.strokeStyle = "#000"; g.lineWidth = 1.1; g.stroke(); }
    for (const [p, n] of data.flat ? frames[k].planes : data.planes) {
      const l = Math.hypot(...n), t = [n[1] / l, n[0] / l], c = [px(p[0]), py(p[1])], r = data.flat ? 46 : W;
      g.lineWidth = 1.6; g.strokeStyle = "#222"; g.beginPath();
      g.moveTo(c[0] - r * t[0], c[1] - r * t[1]); g.lineTo(c[0] + r * t[0], c[1] + r * t[1]);
      for (let s = -r; s <= r; s += 7) {
        const x = c[0] + s * t[0], y = c[1] + s * t[1];
        g.moveTo(x, y); g.lineTo(x - 6 * n[0] / l - 6 * t[0], y + 6 * n[1] / l - 6 * t[1]);
      }
      g.stroke();
    }
    data.walls.forEach((w, j) => {
      const [x, y, sin, cos] = frames[k].poses[j];
      g.lineWidth = 1.6; g.strokeStyle = "#222"; g.beginPath();
      let rest = 0, last = null;
      for (let i = 0; i < w.length; i += 4) {
        const p = [px(x + cos * w[i] - sin * w[i + 1]), py(y + sin * w[i] + cos * w[i + 1])];
        const n = [cos * w[i + 2] - sin * w[i + 3], sin * w[i + 2] + cos * w[i + 3]];
        if (last) {
          g.moveTo(...last); g.lineTo(...p);
          const dx = p[0] - last[0], dy = p[1] - last[1], l = Math.hypot(dx, dy);
          for (; rest < l; rest += 7) {
            const a = last[0] + dx * rest / l, b = last[1] + dy * rest / l;
            g.moveTo(a, b); g.lineTo(a - 5 * n[0] - 5 * n[1], b + 5 * n[1] - 5 * n[0]);
          }
          rest -= l;
        }
        last = p;
        // A plane looks the same wherever it is: a triangle moves with it.
        if (data.marked[j] && 2 * i === w.length - 4) {
          const q = [p[0] - 13 * n[0], p[1] + 13 * n[1]];
          g.fillStyle = "#222"; g.fill(new Path2D(`M${p}L${q[0] + 6 * n[1]} ${q[1] + 6 * n[0]}L${q[0] - 6 * n[1]} ${q[1] - 6 * n[0]}z`));
        }
      }
      g.stroke();
    });
    const f = frames[k].forces;
    // Arrows closer than a few pixels would be a black band.
    for (let i = 0, last = null; i < f.length; i += 4) {
      const x = px(f[i]), y = py(f[i + 1]);
      if (last && Math.hypot(x - last[0], y - last[1]) < 7) continue;
      arrow(x, y, f[i + 2], f[i + 3]);
      last = [x, y];
    }
    profiles.forEach((show, i) => show(frames[k].pressure[i]));
  };

  // Start at the frame with the largest contact force, or at the end.
  const force = f => f.forces.reduce((s, v, i) => i % 4 > 1 ? s + Math.abs(v) : s, 0);
  const most = frames.reduce((a, b) => force(b) > force(a) ? b : a);
  const first = force(most) > 0 ? most : frames[frames.length - 1];
  coloured(root, k => { shown = quantities[k]; draw(frame); });
  player(root, frames, data.unit, draw, first.time);
})();
