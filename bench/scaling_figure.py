"""The figure of `scaling.py`: seconds per step, and memory, over the number of cells."""

import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 460, 360, 62, 20, 34, 50
COLOURS = {"explicit": "#1f4e9c", "implicit, plane": "#c8501e", "implicit, space": "#2d7d46"}
DASHES = ["", "6 4", "2 3", "8 3 2 3"]


class Panel:
    """Curves over the number of cells, both axes logarithmic."""

    def __init__(self, title, offset, sizes, values):
        self.offset = offset
        self.low = [math.floor(math.log10(min(of))) for of in (sizes, values)]
        self.high = [math.ceil(math.log10(max(of))) for of in (sizes, values)]
        self.parts = [text(offset + WIDTH / 2, 20, title, "middle")]
        for power in range(self.low[0], self.high[0] + 1):
            x = self.x(10**power)
            self.line([(x, TOP), (x, HEIGHT - BOTTOM)], "#ddd")
            self.parts.append(text(x, HEIGHT - BOTTOM + 18, ten_to(power), "middle"))
        for power in range(self.low[1], self.high[1] + 1):
            y = self.y(10.0**power)
            self.line([(offset + LEFT, y), (offset + WIDTH - RIGHT, y)], "#ddd")
            self.parts.append(text(offset + LEFT - 8, y + 4, ten_to(power), "end"))
        self.parts.append(text(offset + (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, "cells", "middle"))

    def x(self, value):
        share = (math.log10(value) - self.low[0]) / max(1, self.high[0] - self.low[0])
        return self.offset + LEFT + (WIDTH - LEFT - RIGHT) * share

    def y(self, value):
        share = (math.log10(value) - self.low[1]) / max(1, self.high[1] - self.low[1])
        return HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * share

    def line(self, points, colour, dash="", width=1):
        at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        style = f'stroke="{colour}" stroke-width="{width}" stroke-dasharray="{dash}"'
        self.parts.append(f'<polyline points="{at}" fill="none" {style}/>')

    def curve(self, values, colour, dash):
        points = [(self.x(cells), self.y(value)) for cells, value in values]
        self.line(points, colour, dash, 2)
        self.parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]


def text(x, y, words, anchor, colour="black"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


def ten_to(power):
    return f'10<tspan dy="-5" font-size="9">{str(power).replace("-", "−")}</tspan>'


def figure(rows, floor):
    """The drawing, as SVG; `floor`: nanoseconds per cell of an explicit step."""
    sizes = [row["cells"] for row in rows]
    least = 1e-9 * floor * min(row["cells"] for row in rows if row["job"] == "explicit")
    seconds = Panel("seconds per step", 0, sizes, [row["step"] for row in rows] + [least])
    memory = Panel("peak of memory, MiB", WIDTH, sizes, [row["peak"] for row in rows])
    threads = sorted({row["threads"] for row in rows})
    for job, colour in COLOURS.items():
        for dash, count in zip(DASHES, threads):
            own = [row for row in rows if row["job"] == job and row["threads"] == count]
            if own:
                seconds.curve([(row["cells"], row["step"]) for row in own], colour, dash)
            if own and count == threads[0]:
                memory.curve([(row["cells"], row["peak"]) for row in own], colour, "")
    explicit = sorted(row["cells"] for row in rows if row["job"] == "explicit")
    ends = [explicit[0], explicit[-1]]
    seconds.line([(seconds.x(cells), seconds.y(1e-9 * floor * cells)) for cells in ends], "black", "1 3", 2)
    legend = [(colour, "", job) for job, colour in COLOURS.items() if any(row["job"] == job for row in rows)]
    legend += [("#555", dash, f"{count} thread{'s' if count > 1 else ''}") for dash, count in zip(DASHES, threads)]
    legend += [("black", "1 3", "floor of explicit steps, 1 thread")]
    for k, (colour, dash, label) in enumerate(legend):
        x = LEFT + 132 * k
        seconds.line([(x, HEIGHT + 8), (x + 26, HEIGHT + 8)], colour, dash, 2)
        seconds.parts.append(text(x + 32, HEIGHT + 12, label, "start"))
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {2 * WIDTH} {HEIGHT + 24}"'
        ' font-family="sans-serif" font-size="12">'
    )
    background = f'<rect width="{2 * WIDTH}" height="{HEIGHT + 24}" fill="white"/>'
    return "\n".join([head, background, *seconds.parts, *memory.parts, "</svg>\n"])
