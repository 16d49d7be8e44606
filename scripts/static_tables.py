#!/usr/bin/env python3
"""Exact reference values for cases/static/, computed with scipy, independently of Carom.

    python3 scripts/static_tables.py

Homogeneous states of the compressible neo-Hookean law P = mu (F - F^-T) + Lambda ln J F^-T; the
elastica with an end force by elliptic integrals; Lame's ring; and the inflation of a thick
neo-Hookean ring: the equation dP_R/dR + (P_R - P_T)/R = 0 for r(R), solved as a boundary value
problem.
"""
import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

LAMBDA, MU = 200.0, 100.0


def nominal(stretches):
    """Principal nominal stresses for three principal stretches."""
    log = LAMBDA * np.log(np.prod(stretches))
    return [MU * (s - 1 / s) + log / s for s in stretches]


def homogeneous():
    a = 1.3
    b = brentq(lambda b: nominal((a, b, 1.0))[1], 0.5, 1.2, xtol=1e-15)
    traction = nominal((a, b, 1.0))[0]
    print(f"plane strain, stretch {a}: lateral {b:.16g}, traction {traction:.16g}, Cauchy {traction / b:.16g}")
    c = brentq(lambda c: nominal((a, c, c))[1], 0.5, 1.2, xtol=1e-15)
    traction = nominal((a, c, c))[0]
    print(f"plane stress, stretch {a}: lateral {c:.16g}, traction {traction:.16g}, Cauchy {traction / c**2:.16g}")
    s = brentq(lambda s: nominal((s, s, 1.0))[0] / s + 50.0, 0.5, 1.0, xtol=1e-15)
    print(f"pressure 50, plane strain: displacement of a unit length {s - 1:.16g}")


def elastica():
    """Deflection/L and shortening/L of a cantilever with a dead end force, A = P L^2/(E I)."""
    for load in (1, 2, 5, 10):
        def angles(sine):
            m = (1 + sine) / 2
            return m, np.arcsin(1 / np.sqrt(2 * m))

        def miss(sine):
            m, start = angles(sine)
            return ellipk(m) - ellipkinc(start, m) - np.sqrt(load)

        sine = brentq(miss, 1e-9, 1 - 1e-12, xtol=1e-15)
        m, start = angles(sine)
        down = 1 - 2 / np.sqrt(load) * (ellipe(m) - ellipeinc(start, m))
        print(f"elastica, A = {load}: deflection/L {down:.8f}, shortening/L {1 - np.sqrt(2 * sine / load):.8f}")


def lame(young=1.0, poisson=0.3, inner=1.0, outer=2.0, pressure=1e-6):
    a = pressure * inner**2 / (outer**2 - inner**2)
    radial = lambda r: (1 + poisson) / young * a * ((1 - 2 * poisson) * r + outer**2 / r)
    stress = lambda r: (a * (1 - outer**2 / r**2), a * (1 + outer**2 / r**2))
    print(f"Lame: u(inner) {radial(inner):.16g}, u(outer) {radial(outer):.16g}, stresses at 1.5 {stress(1.5)}")


def ring(pressure, inner=1.0, outer=2.0):
    def stresses(radius, r, slope):
        log = LAMBDA * np.log(slope * r / radius)
        hoop = r / radius
        return MU * (slope - 1 / slope) + log / slope, MU * (hoop - 1 / hoop) + log / hoop

    def rates(radius, y):
        r, slope = y
        across, along = stresses(radius, r, slope)
        hoop_rate = (slope - r / radius) / radius
        # dP_R/dR at constant slope, and dP_R/d(slope).
        fixed = LAMBDA * (radius / r) * hoop_rate / slope
        stiff = MU * (1 + slope**-2) + (LAMBDA - LAMBDA * np.log(slope * r / radius)) / slope**2
        return np.array([slope, (-(across - along) / radius - fixed) / stiff])

    def ends(low, high):
        inside, _ = stresses(inner, *low)
        outside, _ = stresses(outer, *high)
        return np.array([inside * inner / low[0] + pressure, outside])

    radii = np.linspace(inner, outer, 41)
    found = solve_bvp(rates, ends, radii, np.array([1.1 * radii, np.full_like(radii, 1.0)]), tol=1e-11, max_nodes=100000)
    assert found.success, found.message
    at = lambda radius: found.sol(radius)
    across, along = stresses(1.5, *at(1.5))
    r, slope = at(1.5)
    print(
        f"ring, p = {pressure}: u(inner) {at(inner)[0] - inner:.10f}, u(outer) {at(outer)[0] - outer:.10f}, "
        f"at 1.5: Cauchy {across * 1.5 / r:.8f} across, {along / slope:.8f} along"
    )


if __name__ == "__main__":
    homogeneous()
    elastica()
    lame()
    ring(40.0)
