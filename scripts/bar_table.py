#!/usr/bin/env python3
"""Reference values for `cases/bar/`: the bar on a rigid wall by the alpha family.

Single impact (no gravity) and bouncing under gravity of a bar of 100 linear cells (L = 10, E = 900,
rho = 1, h0 = 5) with one constraint. Each step is first solved without contact. If the lower end is
then below the wall, the step is solved again with the end on the wall. The script uses only the
published formulas and dense numpy matrices; it shares no code with Carom.

    python3 scripts/bar_table.py

prints one line per scheme, mass, time level of the contact force and persistency.
"""
import itertools
import numpy as np

# With H0 = 5 the bar would touch exactly at a grid time, where round-off decides. It starts
# slightly higher and touches just after that time.
L, E, RHO, N, H0 = 10.0, 900.0, 1.0, 100, 5.0 + 1e-9
DX, C0 = L / N, 30.0


def newmark(r):
    gamma = (3 - r) / (2 * (1 + r))
    return 0.0, 0.0, gamma, (gamma + 0.5) ** 2 / 4


def chung_hulbert(r):
    am, af = (2 * r - 1) / (r + 1), r / (r + 1)
    return am, af, 0.5 - am + af, (1 - am + af) ** 2 / 4


def hht(af):
    return 0.0, af, 0.5 + af, (1 + af) ** 2 / 4


SCHEMES = {
    "trapezoidal": (0.0, 0.0, 0.5, 0.25),
    "Hu": (0.0, 0.0, 1.5, 1.0),
    "CH .6": chung_hulbert(0.6),
    "CH .1": chung_hulbert(0.1),
    "HHT .6": hht(0.25),
}


def matrices(lumped):
    k, m = np.zeros((N + 1, N + 1)), np.zeros((N + 1, N + 1))
    for e in range(N):
        k[e : e + 2, e : e + 2] += E / DX * np.array([[1, -1], [-1, 1]])
        m[e : e + 2, e : e + 2] += RHO * DX * (np.eye(2) / 2 if lumped else np.array([[2, 1], [1, 2]]) / 6)
    return k, m


def run(scheme, lumped, level, project, gravity, end, v0=0.0):
    """Times, contact force at t_{s+1}, height of the lower end, energy, velocity of the centre.

    The energy is zero for the undeformed bar standing on the wall.
    """
    am, af, gamma, beta = SCHEMES[scheme]
    k, m = matrices(lumped)
    ones = np.ones(N + 1)
    weight = -gravity * (m @ ones)
    h = DX / C0
    b1 = 1 / (beta * h * h)
    lhs = (1 - am) * b1 * m + (1 - af) * k
    open_inverse = np.linalg.inv(lhs)
    e0 = np.zeros(N + 1)
    e0[0] = 1.0
    mass_inverse = np.linalg.inv(m)
    share, old_share = ((1 - af), af) if level == "alpha_f" else (1.0, 0.0)
    u, v = np.zeros(N + 1), np.full(N + 1, v0)
    a = -gravity * ones
    force, closed = 0.0, False
    rows = []
    steps = round(end / h)
    for s in range(steps + 1):
        if s > 0:
            # a1 = b1 (d - h v - (1/2 - beta) h^2 a)
            known = am * (m @ a) + (1 - af) * (k @ u - weight) + af * (k @ u - weight) - old_share * force * e0
            known -= (1 - am) * (m @ (b1 * (h * v + (0.5 - beta) * h * h * a)))
            d = -open_inverse @ known
            new = 0.0
            if H0 + u[0] + d[0] < 0.0:
                # d0 = -(H0 + u0): one additional multiplier
                response = open_inverse @ e0
                p = (-(H0 + u[0]) - d[0]) / response[0]
                d = d + p * response
                new = p / share
            touched = new > 0.0
            a1 = b1 * (d - h * v - (0.5 - beta) * h * h * a)
            v = v + h * ((1 - gamma) * a + gamma * a1)
            a, u = a1, u + d
            if project and touched and not closed:
                impulse = -v[0] / (mass_inverse[0, 0])
                v = v + mass_inverse[:, 0] * impulse
                free = mass_inverse @ (weight - k @ u)
                new = -free[0] / mass_inverse[0, 0]
                a = free + mass_inverse[:, 0] * new
            force, closed = new, touched
        energy = 0.5 * v @ m @ v + 0.5 * u @ k @ u + gravity * ones @ m @ (u + H0 * ones)
        rows.append((s * h, force, H0 + u[0], energy, (ones @ m @ v) / (RHO * L)))
    return np.array(rows).T


def bounce(t):
    """Exact height of the lower end in the bouncing case."""
    tw, tf, g, period = L / C0, 1.0, 10.0, 16 * L / C0
    t = t % period
    if t > period / 2:
        t = period - t
    if t <= 1.0:
        return H0 - g * t * t / 2
    t2 = 1.0 + 2 * tw
    if t <= t2:
        return 0.0
    s = t - t2
    x = (C0 * s / L) % 2
    return H0 - g * (s - tf) ** 2 / 2 - g * L * L / C0**2 * x * (2 - x)


def figures(name, lumped, level, project):
    t, p, _, energy, v = run(name, lumped, level, project, 0.0, 2.0, -10.0)
    inside = (t > 0.52 + 1e-9) & (t < 1.147 - 1e-9)
    first = [p.max() / 300, np.sqrt(np.mean((p[inside] / 300 - 1) ** 2)), energy[-1] / energy[0], v[-1] / 10]
    t, p, y, energy, _ = run(name, lumped, level, project, 10.0, 16.0)
    period = 16 * L / C0
    last = (t >= 2 * period - 1e-9) & (t <= 3 * period + 1e-9)
    error = np.sqrt(np.mean([(a - bounce(b)) ** 2 for a, b in zip(y[last], t[last])])) / H0
    return first + [error, energy[-1] / energy[0]]


if __name__ == "__main__":
    print(f"{'scheme':12} {'mass':11} {'force':8} {'begin':8}  peak    rms     E/E0    v_cm    (b) err (b) E")
    for name, lumped, level, project in itertools.product(SCHEMES, (False, True), ("alpha_f", "end"), (False, True)):
        row = figures(name, lumped, level, project)
        mass, begin = "lumped" if lumped else "consistent", "project" if project else "none"
        print(f"{name:12} {mass:11} {level:8} {begin:8}", " ".join(f"{x:7.4f}" for x in row))
