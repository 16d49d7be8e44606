"use strict";
// Time histories: values under the cursor, a zoom in time that rescales y, and the line of the animation.
const charts = (() => {
  const element = document.getElementById("charts-data"), stored = element ? JSON.parse(element.textContent) : {};
  const tips = document.createElement("div");
  tips.className = "values";
  tips.hidden = true;
  document.body.append(tips);
  let shown = null, now = null, pick = () => {};
  const round = x => !Number.isFinite(x) ? "–" : (x !== 0 && (Math.abs(x) >= 1e6 || Math.abs(x) < 1e-4) ? x.toExponential(3) : String(+x.toPrecision(5))).replace(/-/g, "−");
  const make = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  };
  // Round values between two ends, about so many, with their labels in units of 10^exponent.
  const ticks = (from, to, count, exponent, offset) => {
    const raw = (to - from) / count, power = 10 ** Math.floor(Math.log10(raw));
    const steps = [10, 5, 2, 1].map(f => f * power), fit = s => Math.floor(to / s + 1e-9) - Math.ceil(from / s - 1e-9) + 1;
    const step = steps.reduce((best, s) => s >= 0.999 * raw || fit(best) < 2 ? s : best);
    const decimals = Math.min(12, Math.max(0, -Math.floor(Math.log10(step / 10 ** exponent * 1.0001)))), list = [];
    // Not where steps are lost in round-off.
    if (!(step > 1e-12 * Math.max(Math.abs(from), Math.abs(to)))) return list;
    for (let i = Math.ceil(from / step - 1e-9); i <= to / step + 1e-9 && list.length < 60; i++) {
      const shown = (i * step - offset) / 10 ** exponent, text = Math.abs(shown).toFixed(decimals);
      list.push([i * step, (shown < 0 && +text !== 0 ? "−" : "") + text]);
    }
    return list;
  };
  // The row of a list of ascending times nearest to one.
  const nearest = (x, t) => {
    let [a, b] = [0, x.length - 1];
    while (b - a > 1) { const m = a + b >> 1; if (x[m] <= t) a = m; else b = m; }
    return Math.abs(x[a] - t) <= Math.abs(x[b] - t) ? a : b;
  };
  const all = [...document.querySelectorAll("svg g.time")].map(axis => {
    const [x0, x1, t0, t1, exponent, offset] = axis.dataset.axis.split(" ").map(Number);
    const spans = axis.dataset.spans.split(" ").map(Number), svg = axis.ownerSVGElement, data = stored[axis.dataset.chart];
    const numbers = g => g.dataset.axis.split(" ").map(Number);
    const panels = [...svg.querySelectorAll("g.panel")].map((g, k) => ({ g, axis: numbers(g), lists: data?.panels[k], original: g.querySelector(".grid").innerHTML }));
    const below = svg.querySelector("g.ticks"), labels = below?.innerHTML;
    const originals = new Map([...svg.querySelectorAll(".curve, .track, .shade")].map(e => [e, [...e.attributes].map(a => [a.name, a.value])]));
    const range = () => shown && data ? shown : [t0, t1];
    const place = t => { const [from, to] = range(); return x0 + (x1 - x0) * (t - from) / (to - from); };
    // On the colours of a map only black with a white casing can be seen everywhere.
    const cursor = (kind, styles) => styles.map(([stroke, width]) => make("path", { stroke, "stroke-width": width, class: kind, fill: "none" }, axis));
    const line = cursor("cursor", data ? [["#c0267e", 1.2]] : [["#fff", 4], ["#000", 1.6]]), cross = cursor("cross", [["#777", 1]]);
    const draw = (lines, t) => {
      const x = t === null ? NaN : place(t), parts = spans.map((y, i) => i % 2 ? `V${y}` : `M${x.toFixed(2)} ${y}`);
      lines.forEach(each => each.setAttribute("d", x >= x0 - 1 && x <= x1 + 1 ? parts.join("") : ""));
    };
    const at = event => {
      const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse()), [from, to] = range();
      return p.x >= x0 - 4 && p.x <= x1 + 4 ? Math.min(to, Math.max(from, from + (to - from) * (p.x - x0) / (x1 - x0))) : null;
    };
    const values = (event, t) => {
      draw(cross, t);
      tips.hidden = t === null || !data;
      if (tips.hidden) return;
      const lines = [[null, data.x_label, round(t)]];
      for (const { lists } of panels) for (const { label, unit, color, x, y } of lists) {
        const k = x ? nearest(x, t) : nearest(data.x, t);
        if (!x) lines[0][2] = round(data.x[k]);
        lines.push([color, label, `${round(y[k])} ${unit}`]);
      }
      tips.replaceChildren(...lines.map(([color, label, text]) => {
        const row = document.createElement("div"), [mark, name, number] = ["i", "span", "b"].map(tag => row.appendChild(document.createElement(tag)));
        if (color) mark.style.background = color;
        name.innerHTML = label;
        number.innerHTML = text;
        return row;
      }));
      const room = document.documentElement.clientWidth - tips.offsetWidth - 8, beside = event.clientX + 16;
      tips.style.left = `${Math.max(4, beside < room ? beside : event.clientX - tips.offsetWidth - 16)}px`;
      tips.style.top = `${Math.max(4, Math.min(event.clientY + 14, window.innerHeight - tips.offsetHeight - 8))}px`;
    };
    // The curve within the interval, cut off at its ends.
    const path = (x, y, toY) => {
      const [from, to] = range(), parts = [], between = (i, t) => y[i - 1] + (y[i] - y[i - 1]) * (t - x[i - 1]) / (x[i] - x[i - 1]);
      let pen = "M";
      const put = (t, v) => {
        if (!Number.isFinite(v)) { pen = "M"; return; }
        parts.push(`${pen}${place(t).toFixed(1)} ${toY(v).toFixed(1)}`);
        pen = "L";
      };
      for (let i = 0; i < x.length; i++) {
        if (i && x[i - 1] < from && x[i] > from) put(from, between(i, from));
        if (x[i] >= from && x[i] <= to) put(x[i], y[i]);
        if (i && x[i - 1] < to && x[i] > to) { put(to, between(i, to)); break; }
      }
      return parts.join("");
    };
    const rescale = () => {
      if (!data) return;
      if (!shown) {
        panels.forEach(({ g, original }) => { g.querySelector(".grid").innerHTML = original; });
        originals.forEach((attributes, element) => attributes.forEach(([name, value]) => element.setAttribute(name, value)));
        below.innerHTML = labels;
        return;
      }
      const [from, to] = range();
      for (const { g, axis: [top, bottom, low, high, power, less], lists } of panels) {
        let [least, most] = [Infinity, -Infinity];
        for (const { x = data.x, y } of lists) x.forEach((t, i) => {
          if (t >= from && t <= to && Number.isFinite(y[i])) { least = Math.min(least, y[i]); most = Math.max(most, y[i]); }
        });
        if (!(most > least)) [least, most] = least <= most ? [least - 0.05 * (high - low), least + 0.05 * (high - low)] : [low, high];
        const air = 0.05 * (most - least), toY = v => bottom - (bottom - top) * (v - least + air) / (most - least + 2 * air);
        const curves = [...g.querySelectorAll(".curve")];
        lists.forEach(({ x = data.x, y, dots }, k) => {
          const within = dots ? x.map((t, i) => t >= from && t <= to ? `M${place(t).toFixed(1)} ${toY(y[i]).toFixed(1)}h0` : "").join("") : path(x, y, toY);
          curves.filter(curve => +curve.dataset.series === k).forEach(curve => curve.setAttribute("d", within));
        });
        const grid = g.querySelector(".grid");
        grid.replaceChildren();
        for (const [v, text] of ticks(least - air, most + air, Math.max(2, (bottom - top) / 42), power, less)) {
          make("path", { d: `M${x0} ${toY(v).toFixed(1)}H${x1}`, stroke: v === 0 ? "#999" : "#d8d8d8", "stroke-width": 0.6 }, grid);
          const label = make("text", { x: x0 - 8, y: toY(v) + 4.3, "text-anchor": "end" }, grid);
          label.textContent = text;
          if (text.length > 7) label.setAttribute("textLength", 44);
        }
      }
      svg.querySelectorAll(".shade").forEach(shade => {
        const [a, b] = shade.dataset.span.split(" ").map(t => Math.min(x1, Math.max(x0, place(+t))));
        shade.setAttribute("x", a); shade.setAttribute("width", b - a);
      });
      svg.querySelectorAll(".track").forEach((track, k) => {
        const inside = data.tracks[k].filter(t => t >= from && t <= to);
        track.setAttribute("d", inside.map(t => `M${place(t).toFixed(1)} ${track.dataset.top}v9`).join(""));
      });
      const bottoms = below.dataset.bottoms.split(" ").map(Number);
      below.replaceChildren();
      for (const [t, text] of ticks(from, to, (x1 - x0) / 78, exponent, offset)) {
        const x = place(t).toFixed(1);
        make("path", { d: bottoms.map(y => `M${x} ${y}v5`).join(""), stroke: "#222", "stroke-width": 0.8 }, below);
        make("text", { x, y: bottoms[bottoms.length - 1] + 19, "text-anchor": "middle" }, below).textContent = text;
      }
    };
    let begun = null;
    svg.addEventListener("pointerdown", event => { begun = event.button === 0 ? [at(event), event.clientX] : null; });
    svg.addEventListener("pointermove", event => values(event, at(event)));
    svg.addEventListener("pointerleave", event => values(event, null));
    svg.addEventListener("pointerup", event => {
      if (!begun || begun[0] === null) return;
      const [t, x] = begun, other = at(event);
      begun = null;
      if (data && Math.abs(event.clientX - x) > 8 && other !== null) zoom(Math.min(t, other), Math.max(t, other));
      else pick(t);
    });
    svg.addEventListener("dblclick", () => zoom(null));
    Object.assign(svg.style, { cursor: "crosshair", touchAction: "pan-y", userSelect: "none" });
    return { move: () => draw(line, now), rescale };
  });
  const zoom = (from, to) => {
    if (from !== null && to - from < 1e-9 * (Math.abs(from) + Math.abs(to))) return;
    shown = from === null ? null : [from, to];
    all.forEach(each => { each.rescale(); each.move(); });
  };
  document.addEventListener("keydown", event => { if (event.key === "Escape") zoom(null); });
  return { move: t => { now = t; all.forEach(each => each.move()); }, picked: call => { pick = call; } };
})();

// Play and pause, the slider and keys. `draw` draws a frame; `force` is the size of its contact forces.
const player = (root, frames, unit, draw, force, first) => {
  const [button, slider, shown, speed] = [".play", ".time", "output", ".speed"].map(s => root.querySelector(s));
  const start = frames[0].time, end = frames[frames.length - 1].time;
  let frame = -1, now = start, playing = null;
  const show = t => {
    now = Math.min(end, Math.max(start, t));
    let k = 0;
    frames.forEach((f, i) => { if (Math.abs(f.time - now) <= Math.abs(frames[k].time - now)) k = i; });
    if (playing === null) now = frames[k].time;
    slider.value = (now - start) / (end - start);
    if (k === frame) return;
    frame = k;
    draw(k);
    charts.move(frames[k].time);
    shown.textContent = `t = ${+frames[k].time.toPrecision(6)} ${unit} · step ${frames[k].step} · ${frames[k].file}`;
  };
  const pause = () => { cancelAnimationFrame(playing); playing = null; button.textContent = "▶"; };
  const play = () => {
    if (now >= end) now = start;
    button.textContent = "❚❚";
    let last = performance.now();
    // At speed 1 the whole run takes eight seconds.
    const tick = at => {
      playing = requestAnimationFrame(tick);
      show(now + (at - last) / 8000 * (end - start) * speed.value);
      last = at;
      if (now >= end) pause();
    };
    playing = requestAnimationFrame(tick);
  };
  charts.picked(t => { pause(); show(t); });
  button.addEventListener("click", () => playing === null ? play() : pause());
  slider.addEventListener("input", () => { pause(); show(start + slider.value * (end - start)); });
  root.tabIndex = 0;
  root.addEventListener("keydown", event => {
    if (event.target.tagName === "SELECT" || (event.target.type === "range" && event.target !== slider)) return;
    const by = { ArrowLeft: -1, ArrowRight: 1, ",": -1, ".": 1 }[event.key];
    if (by) { pause(); show((frames[frame + by] || frames[frame]).time); event.preventDefault(); }
    if (event.key === " " && event.target !== button) { playing === null ? play() : pause(); event.preventDefault(); }
  });
  // The first frame with the largest contact forces, but for round-off, or else with the largest stress.
  const most = frames.reduce((a, b) => force(b) > 1.001 * force(a) ? b : a);
  show(force(most) > 0 ? most.time : first ?? end);
};
