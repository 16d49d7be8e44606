#!/usr/bin/env python3
"""Checks report pages in headless Chromium.

    python3 scripts/check_page.py runs/impact/report.html [more pages] [--scenes DIR] [--store]
                                  [--screenshots DIR]

Opens each page, plays its animation and drags its slider; a scene in space is also turned, moved,
zoomed, cut and coloured, by mouse, touch and keys. With --scenes, the scene as opened is compared
with the stored picture DIR/NAME.json, if there is one; --store writes it. Fails on any console message, missing part or
external request, and on text that is cut off, covered or hard to read at either of two widths and in
either colour scheme (`page_layout.py`); of a picture, NAME.svg, this alone. Needs only `chromium` (apt-get install chromium). With
--screenshots, it writes for every page NAME.png (as opened), NAME-playing.png (after the animation was
played), NAME-WIDTH-SCHEME.png (of tall pages in pieces -2, -3, …) and NAME.pdf (printed), where NAME is
the name of its folder.
"""

import argparse
import base64
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from page_layout import layout

OUTSIDE = re.compile(r"""(?:src|href)\s*=\s*["']?(?:https?:)?//|url\((?!#)|@import|\bfetch\(|XMLHttpRequest""")


class Browser:
    """Chromium, controlled by the DevTools protocol over a pair of pipes.

    Messages end with a zero byte.
    """

    def __init__(self, profile):
        program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
        if program is None:
            sys.exit("check_page.py needs chromium")
        theirs, self.to = os.pipe()
        self.of, ours = os.pipe()
        command = [
            program, "--headless", "--hide-scrollbars", f"--user-data-dir={profile}", "--no-first-run",
            # WebGL without a graphics card; the page itself is drawn without it, which is ten times
            # faster.
            "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
            "--disable-gpu-rasterization",
            "--remote-debugging-pipe", "--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1000,1400",
        ]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            command.append("--no-sandbox")
        # Chromium reads from descriptor 3 and writes to 4.
        shell = ["sh", "-c", f'exec "$@" 3<&{theirs} 4>&{ours}', "sh", *command]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        self.process = subprocess.Popen(shell, pass_fds=(theirs, ours), **quiet)
        os.close(theirs)
        os.close(ours)
        self.number, self.buffer, self.session, self.said = 0, b"", None, []

    def __call__(self, method, **parameters):
        """Sends a command and returns its result."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session and not method.startswith(("Target", "Browser")):
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.next()
            if answer.get("id") == self.number:
                if "error" in answer:
                    sys.exit(f"check_page.py: {method}: {answer['error']}")
                return answer["result"]

    def next(self):
        """The next message; console messages and exceptions are collected."""
        while b"\0" not in self.buffer:
            part = os.read(self.of, 1 << 20)
            if not part:
                sys.exit("check_page.py: the browser has exited")
            self.buffer += part
        line, self.buffer = self.buffer.split(b"\0", 1)
        message = json.loads(line)
        if message.get("method") in ("Runtime.consoleAPICalled", "Runtime.exceptionThrown", "Log.entryAdded"):
            self.said.append(json.dumps(message["params"])[:300])
        return message

    def open(self, page):
        self.session, self.said = None, []
        target = self("Target.createTarget", url="about:blank")["targetId"]
        self.session = self("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Runtime", "Log", "Page"):
            self(f"{domain}.enable")
        self("Page.navigate", url=page.resolve().as_uri())
        while self.next().get("method") != "Page.loadEventFired":
            pass

    def value(self, expression):
        answer = self("Runtime.evaluate", expression=expression, returnByValue=True)
        return answer["result"].get("value")

    def until(self, expression, seconds=20):
        """Whether an expression becomes true within the given time."""
        end = time.monotonic() + seconds
        while not (true := self.value(expression)) and time.monotonic() < end:
            time.sleep(0.05)
        return bool(true)

    def place(self, selector):
        """Left, top, width and height of an element, scrolled into view."""
        found = f"document.querySelector({json.dumps(selector)})"
        self.value(f"{found}.scrollIntoView({{ block: 'center' }})")
        return self.value(f"(r => [r.x, r.y, r.width, r.height])({found}.getBoundingClientRect())")

    def mouse(self, kind, x, y):
        buttons = 0 if kind == "mouseReleased" else 1
        self("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1)

    def click(self, selector, across=0.5):
        x, y, width, height = self.place(selector)
        self.mouse("mousePressed", x + across * width, y + height / 2)
        self.mouse("mouseReleased", x + across * width, y + height / 2)

    def close(self):
        self.session = None
        self("Browser.close")
        self.process.wait(timeout=20)


# The state of the animation: its caption, a checksum of its picture, and the cursor positions.
SHOWN = """JSON.stringify((root => [
    root.querySelector("output").textContent,
    (c => {
        const copy = new OffscreenCanvas(c.width, c.height).getContext("2d", { willReadFrequently: true });
        copy.drawImage(c, 0, 0);
        return copy.getImageData(0, 0, c.width, c.height).data.reduce((s, v) => (s * 31 + v) | 0, 0);
    })(root.querySelector("canvas")),
    [...document.querySelectorAll("path.cursor")].map(line => line.getAttribute("d")).join(),
])(document.getElementById("animation")))"""
TIME = "parseFloat(document.querySelector('#animation output').textContent.match(/t = ([-+.e0-9]+)/)[1])"
# How many time histories do not have their line at the instant shown.
LOST = f"""(t => [...document.querySelectorAll("g.time")].filter(axis => {{
    const [x0, x1, t0, t1] = axis.dataset.axis.split(" ").map(Number), x = x0 + (x1 - x0) * (t - t0) / (t1 - t0);
    const line = axis.querySelector("path.cursor")?.getAttribute("d");
    return line === undefined || (x > x0 && x < x1 && !(Math.abs(parseFloat(line.slice(1)) - x) < 1.5));
}}).length)({TIME})"""
FORWARD = "document.querySelector('#animation .play').textContent"


def pick(browser, selector, value):
    """Chooses from a list of the animation."""
    browser.value(f"""(e => {{ e.value = {json.dumps(value)}; e.dispatchEvent(new Event("change")); }})(
        document.querySelector("#animation {selector}"))""")


def animation(browser):
    """Plays the animation, drags its slider and clicks a history; returns the errors found."""
    wrong = []
    if browser.value("document.getElementById('animation').hidden"):
        return ["the script of the animation did not finish"]
    if not browser.value("!!document.querySelector('path.cursor')"):
        return ["no time history shows the cursor of the animation"]

    def found(when):
        if lost := browser.value(LOST):
            wrong.append(f"{when}, {lost} time histories do not show the instant of the animation")

    found("as opened")
    opened = browser.value("document.querySelector('#animation .time').value")

    def shown():
        return json.loads(browser.value(SHOWN))

    def differs(before, after, what):
        for name, a, b in zip(("caption", "picture", "cursor"), before, after):
            if a == b:
                wrong.append(f"{what} does not change the {name}")

    at_first = shown()
    browser.click("#animation .play")
    started = browser.value(TIME)
    if browser.value(FORWARD) == "▶" or not browser.until(f"{TIME} !== {started}"):
        wrong.append("the play button does not start the animation")
    browser.click("#animation .play")
    differs(at_first, played := shown(), "playing")
    if browser.value(FORWARD) != "▶" or shown() != played:
        wrong.append("the pause button does not stop the animation")

    x, y, width, height = browser.place("#animation .time")
    thumb = browser.value("document.querySelector('#animation .time').value")
    grip = 8 + float(thumb) * (width - 16)
    target = 0.2 if float(thumb) > 0.5 else 0.8
    browser.mouse("mousePressed", x + grip, y + height / 2)
    for part in (0.3, 0.6, 1.0):
        browser.mouse("mouseMoved", x + grip + part * (target * width - grip), y + height / 2)
    browser.mouse("mouseReleased", x + target * width, y + height / 2)
    differs(played, dragged := shown(), "dragging the slider")
    reached = float(browser.value("document.querySelector('#animation .time').value"))
    if abs(reached - target) > 0.1:
        wrong.append(f"the slider was dragged to {target} but is at {reached}")

    browser.value("document.querySelector('g.time').ownerSVGElement.id = 'history'")
    browser.click("#history", 0.5)
    differs(dragged, shown(), "a click on a time history")
    found("after a click")
    # Every other one takes clicks too.
    for k in range(browser.value("document.querySelectorAll('g.time').length")):
        # Of two pictures of one history, one for each width of the window, one is hidden.
        if not browser.value(f"document.querySelectorAll('g.time')[{k}].ownerSVGElement.checkVisibility()"):
            continue
        # The last frame, away from the middle of any history.
        browser.value("""(slider => { slider.value = 1; slider.dispatchEvent(new Event("input")); })(
            document.querySelector("#animation .time"))""")
        browser.value(f"document.querySelectorAll('g.time')[{k}].ownerSVGElement.id = 'history-{k}'")
        before = shown()
        browser.click(f"#history-{k}", 0.5)
        if shown()[2] == before[2]:
            wrong.append(f"a click on time history {k + 1} goes to no other instant")
    browser.value("document.querySelector('g.time').ownerSVGElement.id = 'history'")

    # Other colours, with their colour bar; those of a scene are tried with it.
    if not browser.value("!!document.querySelector('#animation .cut')"):
        # At the instant of the opened page: bodies may have no stress before.
        browser.value(f"""(slider => {{ slider.value = {opened}; slider.dispatchEvent(new Event("input")); }})(
            document.querySelector("#animation .time"))""")
        before = shown()
        pick(browser, ".quantity", "1")
        if shown()[1] == before[1]:
            wrong.append("the choice of colours does not change the picture")
        if not browser.value("[...document.querySelectorAll('#animation .bar')].every((bar, k) => bar.hidden == (k != 1))"):
            wrong.append("the colour bar is not that of the chosen colours")

    # A drag across a history enlarges it; a double click, or Esc wherever the focus is, shows all
    # of it again.
    ticks = "document.querySelector('#history g.ticks').textContent"
    levels = "[...document.querySelectorAll('#history .grid')].map(g => g.textContent).join()"
    whole, heights = browser.value(ticks), browser.value(levels)
    x, y, width, height = browser.place("#history")
    browser.mouse("mouseMoved", x + 0.5 * width, y + 0.3 * height)
    if not browser.value("(tips => !tips.hidden && /\\d/.test(tips.textContent))(document.querySelector('.values'))"):
        wrong.append("no values are shown under the cursor in a time history")

    def escape():
        browser.value("document.activeElement.blur()")
        browser("Input.dispatchKeyEvent", type="keyDown", key="Escape")

    double = "document.querySelector('#history').dispatchEvent(new MouseEvent('dblclick', { bubbles: true }))"
    for name, back in (("a double click", lambda: browser.value(double)), ("Esc", escape)):
        x, y, width, height = browser.place("#history")
        browser.mouse("mousePressed", x + 0.4 * width, y + height / 2)
        browser.mouse("mouseMoved", x + 0.5 * width, y + height / 2)
        browser.mouse("mouseReleased", x + 0.6 * width, y + height / 2)
        if browser.value(ticks) == whole:
            wrong.append("a drag across a time history does not enlarge it")
        if browser.value(levels) == heights:
            wrong.append("a drag across a time history does not rescale its vertical axes")
        back()
        if browser.value(ticks) != whole or browser.value(levels) != heights:
            wrong.append(f"{name} does not show the whole time again")
    return wrong


# The picture of a scene: the percentage of it that differs from the background, and mean colours of
# squares of 25 pixels. Lines of one and the same scene are not drawn with the same pixels twice.
SCENE = """JSON.stringify((c => {
    const copy = new OffscreenCanvas(c.width, c.height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(c, 0, 0);
    const data = copy.getImageData(0, 0, c.width, c.height).data, across = Math.ceil(c.width / 25);
    const squares = new Array(3 * across * Math.ceil(c.height / 25)).fill(0);
    let drawn = 0;
    for (let y = 0, i = 0; y < c.height; y++) for (let x = 0; x < c.width; x++, i += 4) {
        drawn += data[i + 3] > 5;
        const at = 3 * (Math.floor(y / 25) * across + Math.floor(x / 25)), paper = 255 - data[i + 3];
        for (let k = 0; k < 3; k++) squares[at + k] += (data[i + k] * data[i + 3] / 255 + paper) / 625;
    }
    return [400 * drawn / data.length, squares];
})(document.querySelector("#animation canvas")))"""
# Levels of 256 by which the mean colour of a square differs between pictures.
SAME = 20


def apart(before, after):
    """Largest difference of two pictures of a scene."""
    return max(abs(a - b) for a, b in zip(before[1], after[1]))


def differs(found, stored, store):
    """How a picture of a scene differs from the stored one."""
    if store:
        stored.write_text(json.dumps([round(level) for level in found[1]]), encoding="utf-8")
    if not stored or not stored.is_file():
        return []
    levels = json.loads(stored.read_text(encoding="utf-8"))
    if len(levels) != len(found[1]):
        return [f"the scene has another size than that of {stored}"]
    by = apart((0, levels), found)
    return [f"the scene is not that of {stored}: a square differs by {by:.0f} levels"] if by >= SAME else []


def scene(browser, stored=None, store=False):
    """Turns, moves, zooms, cuts and colours a scene; returns the errors found."""
    wrong = []
    picture = "#animation canvas"

    def shown():
        # The picture is drawn in the next frame of the browser.
        drawn = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
        browser("Runtime.evaluate", expression=drawn, awaitPromise=True)
        return json.loads(browser.value(SCENE))

    x, y, width, height = browser.place(picture)
    middle = (x + width / 2, y + height / 2)

    def drag(by, button="left"):
        buttons = {"left": 1, "right": 2}[button]
        for kind, part in [("mousePressed", 0), ("mouseMoved", 0.5), ("mouseMoved", 1), ("mouseReleased", 1)]:
            browser("Input.dispatchMouseEvent", type=kind, x=middle[0] + part * by[0], y=middle[1] + part * by[1],
                    button=button, buttons=0 if kind == "mouseReleased" else buttons, clickCount=1)

    def touch(kind, *points):
        browser("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)])

    def key(name):
        browser.value(f"document.querySelector('{picture}').focus()")
        for kind in ("keyDown", "keyUp"):
            browser("Input.dispatchKeyEvent", type=kind, key=name)

    def swipe():
        touch("touchStart", middle)
        touch("touchMove", (middle[0] + 40, middle[1] + 25))
        touch("touchEnd")

    def spread():
        near, far = [[(middle[0] + s * d, middle[1]) for s in (-1, 1)] for d in (30, 90)]
        touch("touchStart", *near)
        touch("touchMove", *far)
        touch("touchEnd")

    def wheel():
        browser("Input.dispatchMouseEvent", type="mouseWheel", x=middle[0], y=middle[1], deltaX=0, deltaY=-400)

    first = shown()
    if not 3 < first[0] < 97:
        wrong.append(f"the scene draws {first[0]:.1f} % of its picture")
    wrong += differs(first, stored, store)
    steps = [
        ("dragging", lambda: drag((60, 30))),
        ("dragging with the right button", lambda: drag((50, 20), "right")),
        ("the wheel", wheel),
        ("a finger", swipe),
        ("two fingers", spread),
        *[(f"the key {name}", lambda name=name: key(name)) for name in ("ArrowLeft", "ArrowUp", "+", "-", ".")],
        *[(f"the colours of {k}", lambda k=k: pick(browser, ".quantity", k)) for k in "1020"],
        *[(f"a cut at {axis}", lambda axis=axis: pick(browser, ".cut", axis)) for axis in ("x", "−y", "z", "")],
    ]
    for name, step in steps:
        # Each from the same view: after several, the bodies may be out of sight.
        browser.value("document.querySelector('#animation .home').click()")
        before = shown()
        step()
        after = shown()
        if apart(before, after) < SAME and name == "the wheel":
            # Its events come late.
            time.sleep(0.5)
            after = shown()
        if apart(before, after) < SAME:
            wrong.append(f"{name} does not change the scene")
    key(",")
    browser.click("#animation .home")
    if (by := apart(first, shown())) >= SAME:
        wrong.append(f"after a reset the scene is not that of the beginning: a square differs by {by:.0f} levels")
    return wrong


def check(browser, page, options):
    """The errors of a page, as sentences."""
    screenshots, stored = options.screenshots, options.scenes and options.scenes / f"{page.resolve().parent.name}.json"
    if page.suffix == ".svg":
        # As in a page, whose window it does not exceed.
        with tempfile.TemporaryDirectory() as folder:
            framed = Path(folder) / "page.html"
            style = "<style>body { margin: 0 } svg { max-width: 100%; height: auto }</style>"
            framed.write_text(f"<!doctype html>{style}{page.read_text(encoding='utf-8')}", encoding="utf-8")
            browser.open(framed)
            return layout(browser, picture, screenshots and screenshots / page.stem) + browser.said
    browser.open(page)
    text = page.read_text(encoding="utf-8")
    wrong = []
    if not browser.value("document.querySelector('h1')?.textContent"):
        wrong.append("the page has no heading: it was not rendered")
    if outside := OUTSIDE.search(text):
        wrong.append(f"an external request: {outside.group()}")
    to = None
    if screenshots:
        to = screenshots / page.resolve().parent.name
        picture(browser, f"{to}.png")
        print_data = browser("Page.printToPDF", printBackground=True)["data"]
        Path(f"{to}.pdf").write_bytes(base64.b64decode(print_data))
    if 'id="animation"' in text:
        solid = browser.value("!!document.querySelector('#animation .cut')")
        # A scene is unpacked after the page was loaded.
        if browser.until("document.querySelector('#animation output').textContent !== ''") and solid:
            wrong += scene(browser, stored, options.store)
        wrong += animation(browser)
        if to:
            picture(browser, f"{to}-playing.png")
    wrong += layout(browser, picture, to)
    most = 8_000_000
    if page.stat().st_size > most:
        wrong.append(f"{page.stat().st_size} bytes are more than {most / 1e6:.0f} MB")
    return wrong + browser.said


# Chromium repeats what is above 8192 pixels in a picture that is taller.
TALLEST = 2000


def picture(browser, path):
    """A screenshot of the whole page; of a tall one in pieces PATH, PATH-2, PATH-3, …"""
    browser.value("window.scrollTo(0, 0)")
    size = browser("Page.getLayoutMetrics")["cssContentSize"]
    for piece, top in enumerate(range(0, math.ceil(size["height"]), TALLEST), start=1):
        clip = {"x": 0, "y": top, "width": size["width"], "height": min(TALLEST, size["height"] - top), "scale": 1}
        shot = browser("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
        name = path if piece == 1 else path.replace(".png", f"-{piece}.png")
        Path(name).write_bytes(base64.b64decode(shot))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--screenshots", type=Path)
    parser.add_argument("--scenes", type=Path)
    parser.add_argument("--store", action="store_true")
    arguments = parser.parse_args()
    failed = False
    if arguments.screenshots:
        arguments.screenshots.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(profile)
        try:
            for page in arguments.pages:
                wrong = check(browser, page, arguments)
                failed |= bool(wrong)
                played = "; played and dragged" if 'id="animation"' in page.read_text(encoding="utf-8") else ""
                print(f"{page}: {page.stat().st_size / 1e6:.2f} MB, {'; '.join(wrong) or 'no console message' + played}")
            browser.close()
        finally:
            browser.process.kill()
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
