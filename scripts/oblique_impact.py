#!/usr/bin/env python3
"""Tangential over normal impulse of an elastic ball that strikes a plane or an equal ball obliquely, in the theory of N.
Maw, J. R. Barber and J. N. Fawcett (Wear 38 (1976) 101-114): Hertz's contact, tangential tractions that do not
affect the normal ones, Coulomb's law.

    python3 scripts/oblique_impact.py [poisson]

By the method of dimensionality reduction (V. L. Popov, M. Hess, 2015), which is exact for it: the contact is a bed of
springs of the stiffness E* dx and G* dx under the profile x^2/R, each of which sticks or slips by itself, with G*/E* =
k = 2 (1 - nu)/(2 - nu). Units: E* = R = m = 1, v_n = 1 for the pair; tangentially the mass is 2/7 m, that of the surface
of a ball. By incidence psi = k v_t/(mu v_n), prints J_T/(mu J_N) and psi after the impact. Nothing sticks for psi >= 7 k - 1.
"""

import sys

BED, STEPS = 1000, 2000


def impact(psi, k):
    deepest = (15 / 16) ** 0.4
    dx = 1.001 * deepest**0.5 / BED
    sag = [((i + 0.5) * dx) ** 2 for i in range(BED)]
    stretch = [0.0] * BED
    step = 3 * deepest / STEPS
    # Tangential lengths, velocities and forces are divided by mu/k, mu/k and mu.
    depth, normal, tangential = 0.0, 0.0, 0.0
    approach, slip = 1.0, psi
    impulses = [0.0, 0.0]
    while True:
        approach -= step / 2 * normal
        slip -= step / 2 * 3.5 * k * tangential
        depth += step * approach
        before = normal, tangential
        normal = tangential = 0.0
        for i, start in enumerate(sag):
            press = depth - start
            if press <= 0:
                stretch[i] = 0.0
                continue
            stretch[i] = min(max(stretch[i] + step * slip, -press), press)
            normal += 2 * dx * press
            tangential += 2 * dx * stretch[i]
        approach -= step / 2 * normal
        slip -= step / 2 * 3.5 * k * tangential
        impulses[0] += step / 2 * (before[0] + normal)
        impulses[1] += step / 2 * (before[1] + tangential)
        if depth <= 0:
            return impulses[1] / impulses[0], slip


def main():
    nu = float(sys.argv[1]) if len(sys.argv) > 1 else 0.3
    k = 2 * (1 - nu) / (2 - nu)
    for psi in (0.5, 1.0, 2.0, 3.0, 4.0, 7 * k - 1, 6.0):
        ratio, after = impact(psi, k)
        print(f"psi = {psi:.4g}: J_T/(mu J_N) = {ratio:.4f}, psi after {after:.4f}")


if __name__ == "__main__":
    main()
