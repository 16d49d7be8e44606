"""Layout of a page, by the browser's own rectangles: `check_page.py` calls `layout`.

At every width and in both colour schemes: figures lie inside the window and do not scroll, text of a
figure lies inside the figure and is not too small, labels of a figure do not overlap, nothing makes
the page wider than the window, the first column of a table that scrolls stays, and text stands out
from its background by a contrast of at least 3 (WCAG 2.2, § 1.4.11; 4.5 for the text of the page, § 1.4.3).
"""

WIDTHS = (1300, 480)
SCHEMES = ("light", "dark")

# Boxes of letters are smaller than the browser's boxes of lines: a fifth of the height at the top
# and at the bottom is empty.
PROBLEMS = r"""(() => {
  const SMALLEST = 9;
  const found = [], say = text => { if (found.length < 40) found.push(text); };
  const short = e => JSON.stringify(e.textContent.trim().replace(/\s+/g, " ").slice(0, 40));
  const name = svg => {
    const title = svg.querySelector("title");
    return title ? title.textContent : "a figure";
  };
  const luminance = color => {
    const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number);
    const linear = [r, g, b].map(v => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return a === 0 ? null : 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  };
  const contrast = (a, b) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
  const shown = e => e.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true });
  const behind = element => {
    for (let e = element; e; e = e.parentElement) {
      const level = luminance(getComputedStyle(e).backgroundColor);
      if (level !== null) return level;
    }
    return 1;
  };

  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth + 1) {
    const wide = [...document.querySelectorAll("body *")].filter(e => {
      for (let p = e; p; p = p.parentElement) if (/auto|scroll|hidden/.test(getComputedStyle(p).overflowX)) return false;
      return shown(e) && e.getBoundingClientRect().right > root.clientWidth + 1;
    });
    const e = wide[wide.length - 1];
    say(`the page is ${root.scrollWidth} pixels wide in a window of ${root.clientWidth}: ` +
      (e ? `<${e.tagName.toLowerCase()}> ${short(e)}` : "?"));
  }
  const scrolls = e => e.scrollWidth > e.clientWidth + 1 && /auto|scroll/.test(getComputedStyle(e).overflowX);
  for (const e of document.querySelectorAll("table, .scroll, .drawing, .stage")) {
    if (!shown(e) || !scrolls(e)) continue;
    const row = e.querySelector("tbody tr, tr");
    const stays = row && [...row.children].some(cell => getComputedStyle(cell).position === "sticky");
    if (!stays) say(`<${e.tagName.toLowerCase()} class="${e.className}"> ${short(e)} scrolls, and nothing in it stays`);
  }
  for (const svg of document.querySelectorAll("svg")) {
    if (!shown(svg)) continue;
    const box = svg.getBoundingClientRect(), scale = box.width / (svg.viewBox.baseVal.width || box.width);
    if (!box.width) continue;
    if (!svg.ownerSVGElement && box.right > root.clientWidth + 1 && !svg.closest("table")) {
      say(`“${name(svg)}” ends ${(box.right - root.clientWidth).toFixed()} pixels to the right of the window`);
    }
    const ground = svg.querySelector("rect");
    const level = ground ? luminance(getComputedStyle(ground).fill) : behind(svg);
    const texts = [...svg.querySelectorAll("text")].filter(t => t.textContent.trim() && shown(t)).map(t => {
      const r = t.getBoundingClientRect(), turned = /rotate\(-90/.test(t.getAttribute("transform") || "");
      const cut = turned ? [0.2 * r.width, 0] : [0, 0.2 * r.height];
      return { t, left: r.left + cut[0], right: r.right - cut[0], top: r.top + cut[1], bottom: r.bottom - cut[1] };
    });
    for (const { t, left, right, top, bottom } of texts) {
      const over = Math.max(box.left - left, right - box.right, box.top - top, bottom - box.bottom);
      if (over > 0.5) say(`“${name(svg)}”: ${short(t)} leaves the figure by ${over.toFixed(1)} pixels`);
      const size = scale * parseFloat(getComputedStyle(t).fontSize);
      if (size < SMALLEST) say(`“${name(svg)}”: ${short(t)} has letters of ${size.toFixed(1)} pixels`);
      const own = luminance(getComputedStyle(t).fill);
      const halo = t.getAttribute("paint-order") ? luminance(getComputedStyle(t).stroke) : level;
      if (own !== null && contrast(own, halo) < 3) {
        say(`“${name(svg)}”: ${short(t)} has a contrast of ${contrast(own, halo).toFixed(1)}`);
      }
    }
    for (const axis of svg.querySelectorAll("g.ticks, g.grid")) {
      const labels = [...axis.querySelectorAll("text")];
      if (labels.length < 2) say(`“${name(svg)}”: an axis has ${labels.length} labels`);
      for (const t of labels) {
        const r = t.getBoundingClientRect();
        if (r.left < box.left + 1 || r.right > box.right - 1) say(`“${name(svg)}”: the label ${short(t)} of a tick is cut off`);
      }
    }
    texts.forEach((a, i) => texts.slice(i + 1).forEach(b => {
      const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (x > scale && y > scale) say(`“${name(svg)}”: ${short(a.t)} and ${short(b.t)} overlap`);
    }));
  }
  for (const e of document.querySelectorAll("h1, h2, h3, p, td, th, dt, dd, li, summary, figcaption, .status, a, code, pre, label, output")) {
    if (!e.textContent.trim() || !shown(e)) continue;
    const own = luminance(getComputedStyle(e).color), by = contrast(own, behind(e));
    if (by < 4.5) say(`<${e.tagName.toLowerCase()}> ${short(e)} has a contrast of ${by.toFixed(1)}`);
  }
  return JSON.stringify(found);
})()"""


def layout(browser, picture, to):
    """Opens what is folded, and looks at the page at every width and in both schemes; with `to`, a
    screenshot of each. Returns the errors found."""
    import json

    wrong = []
    for width in WIDTHS:
        browser("Emulation.setDeviceMetricsOverride", width=width, height=1400, deviceScaleFactor=1, mobile=False)
        for scheme in SCHEMES:
            browser("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            if to:
                picture(browser, f"{to}-{width}-{scheme}.png")
            browser.value("document.querySelectorAll('details').forEach(d => { d.dataset.was = d.open; d.open = true; })")
            found = json.loads(browser.value(PROBLEMS) or '["the layout could not be read"]')
            browser.value("document.querySelectorAll('details').forEach(d => { d.open = d.dataset.was === 'true'; })")
            wrong += [f"{width} pixels, {scheme}: {problem}" for problem in found]
    browser("Emulation.clearDeviceMetricsOverride")
    browser("Emulation.setEmulatedMedia", features=[])
    return wrong
