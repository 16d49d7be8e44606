#!/usr/bin/env python3
"""Pressure at which a thin ring touches itself, for cases/self/crushed.toml, with scipy.

    python3 scripts/ring_table.py

A closed inextensible line of length 2 pi R with bending stiffness E I, under the pressure p that
follows it, in units R = E I = 1 (P = p R^3/E I; J. E. Flaherty, J. B. Keller, S. I. Rubinow, SIAM J.
Appl. Math. 23 (1972)). A quarter of it, from the lowest point to the point at the right:

    x' = cos a,  y' = sin a,  a' = k,  (k - k_0)' = -Q,  N' = Q k,  Q' = -P - N k

with the tangent (cos a, sin a), the force (N, Q) in its axes, and the curvature k_0 without pressure;
x = a = Q = 0 at the start, y = 0, a = pi/2, Q = 0 at the end. The ring touches itself where the lowest
point reaches y = -t/2, with the thickness t. A ring of ovality e, r = 1 + e cos 2b, has
k_0 = 1 + 3 e cos 2b to first order; b is the angle from the x axis.

The outer face is longer than the centre line, but needs no correction of the pressure: its area is
A + L t/2 + pi t^2/4 for any shape of a line of the length L, so that its variation, and the work of
the pressure, is that of A.
"""
import numpy as np
from scipy.integrate import solve_bvp


def touching(thickness, ovality):
    """P at which the centre lines are this far apart."""
    start = np.linspace(0, np.pi / 2, 200)

    def solve(gap, guess):
        # y has k - k_0 as fourth component; the angle of the place is s - pi/2 to first order.
        natural = lambda s: 1 - 3 * ovality * np.cos(2 * s)

        def right(s, u, p):
            _, _, a, bend, n, q = u
            k = bend + natural(s)
            return np.vstack([np.cos(a), np.sin(a), k, -q, q * k, -p[0] - n * k])

        def ends(a, b, p):
            return np.array([a[0], a[2], a[5], a[1] + gap / 2, b[1], b[2] - np.pi / 2, b[5]])

        found = solve_bvp(right, ends, guess.x, guess.y, p=guess.p, tol=1e-10, max_nodes=50000)
        assert found.success, found.message
        return found

    class Guess:
        x, p = start, np.array([3.0])
        y = np.vstack(
            [1.05 * np.sin(start), -0.95 * np.cos(start), start, -0.15 * np.cos(2 * start), 0 * start - 3, 0 * start]
        )

    guess = Guess
    for gap in np.linspace(1.9, thickness, 60):
        guess = solve(gap, guess)
    return guess.p[0]


for thickness, ovality in ((1e-9, 0.0), (0.02, 0.0), (0.02, 0.001)):
    print(f"t/R = {thickness:g}, ovality {ovality:g}: P = {touching(thickness, ovality):.7g}")
