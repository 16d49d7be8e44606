"use strict";
// What the animations in the plane and in space share: play and pause, the slider, keys, and a cursor
// in every time history of the page. `draw` draws a frame.
const player = (root, frames, unit, draw, first) => {
  const [button, slider, shown, speed] = ["button", "input", "output", "select"].map(s => root.querySelector(s));
  const axes = [...document.querySelectorAll("svg g.time")].map(axis => {
    const [x0, x1, t0, t1, top, bottom] = axis.dataset.axis.split(" ").map(Number);
    const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
    for (const [key, value] of [["stroke", "#c0267e"], ["stroke-width", "1.2"], ["class", "cursor"]]) line.setAttribute(key, value);
    axis.append(line);
    const svg = axis.ownerSVGElement;
    svg.addEventListener("click", event => {
      const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      if (p.x >= x0 && p.x <= x1) { pause(); show(t0 + (t1 - t0) * (p.x - x0) / (x1 - x0)); }
    });
    svg.style.cursor = "crosshair";
    return t => {
      const x = (x0 + (x1 - x0) * (t - t0) / (t1 - t0)).toFixed(2);
      line.setAttribute("d", `M${x} ${top}V${bottom}`);
    };
  });

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
    axes.forEach(move => move(frames[k].time));
    shown.textContent = `t = ${frames[k].time.toPrecision(4)} ${unit} · step ${frames[k].step} · ${frames[k].file}`;
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
  root.hidden = false;
  show(first);
};
