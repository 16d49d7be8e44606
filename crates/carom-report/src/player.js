"use strict";
// What the animations in the plane and in space share: the choice of what is coloured, with its colour
// bar; `changed` is called with its number.
const coloured = (root, changed) => {
  const list = root.querySelector(".quantity");
  list?.addEventListener("change", () => {
    root.querySelectorAll(".bar").forEach((bar, k) => { bar.hidden = k !== +list.value; });
    changed(+list.value);
  });
};

// Play and pause, the slider, keys, and a cursor in every time history of the page. `draw` draws a
// frame.
const player = (root, frames, unit, draw, first) => {
  const [button, slider, shown, speed] = ["button", "input", "output", "select"].map(s => root.querySelector(s));
  // All histories show the same interval of time, at first the whole one; a drag across one enlarges it.
  let shownFrom = null, shownTo = null;
  const axes = [...document.querySelectorAll("svg g.time")].map(axis => {
    const [x0, x1, t0, t1, exponent, offset] = axis.dataset.axis.split(" ").map(Number);
    const spans = axis.dataset.spans.split(" ").map(Number);
    const svg = axis.ownerSVGElement, ticks = svg.querySelector("g.ticks"), original = ticks?.innerHTML;
    // A map over time has a cursor and takes clicks, but is not enlarged.
    const range = () => shownFrom === null || !ticks ? [t0, t1] : [shownFrom, shownTo];
    // On the colours of a map only black with a white casing can be seen everywhere.
    const lines = (ticks ? [["#c0267e", 1.2]] : [["#fff", 4], ["#000", 1.6]]).map(([color, width]) => {
      const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
      for (const [key, value] of [["stroke", color], ["stroke-width", width], ["class", "cursor"]]) line.setAttribute(key, value);
      axis.append(line);
      return line;
    });
    const at = event => {
      const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      const [from, to] = range();
      return p.x >= x0 - 4 && p.x <= x1 + 4 ? from + (to - from) * (p.x - x0) / (x1 - x0) : null;
    };
    let begun = null;
    svg.addEventListener("pointerdown", event => { begun = event.button === 0 ? [at(event), event.clientX] : null; });
    svg.addEventListener("pointerup", event => {
      if (!begun || begun[0] === null) return;
      const [t, x] = begun, other = at(event);
      begun = null;
      if (ticks && Math.abs(event.clientX - x) > 8 && other !== null) zoom(Math.max(t0, Math.min(t, other)), Math.min(t1, Math.max(t, other)));
      else { pause(); show(t); }
    });
    svg.addEventListener("dblclick", () => zoom(null, null));
    svg.style.cursor = "crosshair";
    svg.style.touchAction = "pan-y";
    svg.style.userSelect = "none";
    const place = t => { const [from, to] = range(); return x0 + (x1 - x0) * (t - from) / (to - from); };
    return {
      move: t => {
        const x = place(t);
        const parts = spans.map((y, i) => i % 2 ? `V${y}` : `M${x.toFixed(2)} ${y}`);
        lines.forEach(line => line.setAttribute("d", x < x0 - 1 || x > x1 + 1 ? "" : parts.join("")));
      },
      rescale: () => {
        if (!ticks) return;
        const [from, to] = range(), width = (x1 - x0) / (t1 - t0);
        svg.querySelectorAll("svg.window").forEach(w => {
          const [, y, , height] = w.getAttribute("viewBox").split(" ");
          w.setAttribute("viewBox", `${x0 + (from - t0) * width} ${y} ${(to - from) * width} ${height}`);
        });
        if (shownFrom === null) { ticks.innerHTML = original; return; }
        const raw = (to - from) * 78 / (x1 - x0), power = 10 ** Math.floor(Math.log10(raw));
        const step = [1, 2, 5, 10].map(f => f * power).find(s => s >= 0.999 * raw);
        const decimals = Math.min(12, Math.max(0, -Math.floor(Math.log10(step / 10 ** exponent * 1.0001))));
        const bottoms = ticks.dataset.bottoms.split(" ").map(Number), parts = [];
        for (let i = Math.ceil(from / step - 1e-9); i <= to / step + 1e-9; i++) {
          const x = place(i * step).toFixed(1), text = ((i * step - offset) / 10 ** exponent).toFixed(decimals).replace("-", "−");
          parts.push(`<path d="${bottoms.map(y => `M${x} ${y}v5`).join("")}" stroke="#222" stroke-width="0.8"/>`);
          parts.push(`<text x="${x}" y="${bottoms[bottoms.length - 1] + 19}" text-anchor="middle">${text}</text>`);
        }
        ticks.innerHTML = parts.join("");
      },
    };
  });
  const zoom = (from, to) => {
    if (from !== null && to - from < 1e-9 * (Math.abs(from) + Math.abs(to))) return;
    [shownFrom, shownTo] = [from, to];
    axes.forEach(axis => { axis.rescale(); axis.move(frames[frame].time); });
  };

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
    axes.forEach(axis => axis.move(frames[k].time));
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
  button.addEventListener("click", () => playing === null ? play() : pause());
  slider.addEventListener("input", () => { pause(); show(start + slider.value * (end - start)); });
  root.tabIndex = 0;
  root.addEventListener("keydown", event => {
    if (event.target.tagName === "SELECT" || (event.target.type === "range" && event.target !== slider)) return;
    const by = { ArrowLeft: -1, ArrowRight: 1, ",": -1, ".": 1 }[event.key];
    if (by) { pause(); show((frames[frame + by] || frames[frame]).time); event.preventDefault(); }
    if (event.key === " " && event.target !== button) { playing === null ? play() : pause(); event.preventDefault(); }
  });
  document.addEventListener("keydown", event => { if (event.key === "Escape") zoom(null, null); });
  root.hidden = false;
  show(first);
};
