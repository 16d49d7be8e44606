"""Shared by the jobs of all peers: data of cases/perf/disc-*.toml, corners of the triangles, timing
and output."""

import json
import math
import resource

DT, RHO, LAMBDA, MU = 1.875e-3, 0.25, 200.0, 15.0
SPEED, GAP, RADIUS = 3.0, 0.05, 1.0
WINDOW = 15e-3


def point(rings, k, s):
    """A point on ring k of the disc, s in units of its 6k edges; a ring is a circle."""
    angle = 2 * math.pi * s / (6 * k) if k else 0.0
    return (RADIUS * k / rings * math.sin(angle), GAP + RADIUS - RADIUS * k / rings * math.cos(angle))


def disc(rings):
    """Triangles of concentric rings, as in Carom, counterclockwise.

    A corner is (ring, position on it); the last position of a ring coincides with the first.
    """
    for k in range(1, rings + 1):
        for sixth in range(6):
            for j in range(k):
                a, b = (k, sixth * k + j), (k, sixth * k + j + 1)
                yield a, b, (k - 1, sixth * (k - 1) + j)
                if j < k - 1:
                    yield b, (k - 1, sixth * (k - 1) + j + 1), (k - 1, sixth * (k - 1) + j)


def block(across, down):
    """Triangles of the block, counterclockwise: corners as (column, row)."""
    for i in range(across):
        for j in range(down):
            yield (i, j), (i + 1, j), (i + 1, j + 1)
            yield (i, j), (i + 1, j + 1), (i, j + 1)


def place(across, down, i, j):
    return (-2 + 4 * i / across, -1 + j / down)


def usage():
    """CPU seconds and peak memory in KiB of this process so far."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime, used.ru_maxrss


def peak_mean_force(mass, velocity):
    """Largest mean over 15 ms of the vertical force on the disc.

    `velocity` contains the velocity at the start and after every step.
    """
    window = round(WINDOW / DT)
    return max((mass * (velocity[n + window] - velocity[n]) / (window * DT) for n in range(len(velocity) - window)), default=None)


def print_result(code, dofs, begin, iterations, mass, velocity):
    """Prints one JSON object.

    `begin` is usage() before the first step; `mass` and `velocity` are those of peak_mean_force.
    """
    (start, _), (end, memory) = begin, usage()
    steps = len(velocity) - 1
    print(json.dumps({
        "code": code, "dofs": dofs, "set_up": start, "cpu_per_step": (end - start) / steps, "memory_kib": memory,
        "newton": iterations / steps, "peak_mean_force": peak_mean_force(mass, velocity), "rebound": velocity[-1],
    }))
