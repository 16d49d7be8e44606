#!/usr/bin/env python3
"""Reference values of the verification, computed from published formulas without any code of Carom.

    scripts/reference_values.py bar|oblique|plastic|ring|static|waves  (needs: pip install numpy scipy)

bar        cases/bar: an elastic bar strikes a rigid wall, by schemes of the alpha family
oblique    cases/space/spheres-rub.toml: tangential impulse of an oblique impact with friction
plastic    cases/plastic: a bar beyond its largest force, shells and rings that yield
ring       cases/self/crushed.toml: the pressure at which a thin ring touches itself
static     cases/static: homogeneous states, elastica, Lamé's ring, inflation of a neo-Hookean ring
waves      cases/mortar/rings-collide.toml: the pressure between two rings that meet all over
"""

import itertools
import sys

import numpy as np
from scipy.integrate import quad, solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


class Bar:
    """A bar of linear cells above a rigid wall, with one constraint at its lower end.

    Each step is first solved without contact. If the lower end is then below the wall, the step is
    solved again with the end on the wall.
    """

    LENGTH = 10.0
    YOUNG = 900.0
    DENSITY = 1.0
    WAVE_SPEED = 30.0
    CELLS = 100
    SIZE = LENGTH / CELLS
    # From 5 the bar would touch exactly at a grid time, where round-off decides. It starts slightly
    # higher and touches just after that time.
    START = 5.0 + 1e-9
    STEP = SIZE / WAVE_SPEED

    @staticmethod
    def chung_hulbert(rho):
        alpha_m = (2 * rho - 1) / (rho + 1)
        alpha_f = rho / (rho + 1)
        return alpha_m, alpha_f, 0.5 - alpha_m + alpha_f, (1 - alpha_m + alpha_f) ** 2 / 4

    @staticmethod
    def hht(alpha_f):
        return 0.0, alpha_f, 0.5 + alpha_f, (1 + alpha_f) ** 2 / 4

    @classmethod
    def schemes(cls):
        """Alpha_m, alpha_f, gamma and beta by the name of a scheme."""
        return {
            "trapezoidal": (0.0, 0.0, 0.5, 0.25),
            "Hu": (0.0, 0.0, 1.5, 1.0),
            "CH .6": cls.chung_hulbert(0.6),
            "CH .1": cls.chung_hulbert(0.1),
            "HHT .6": cls.hht(0.25),
        }

    def __init__(self, scheme, lumped, level, project):
        """`level`: time level of the contact force; `project`: whether velocity and acceleration are
        projected where contact begins."""
        self.parameters = self.schemes()[scheme]
        self.level = level
        self.project = project
        self.stiffness = np.zeros((self.CELLS + 1, self.CELLS + 1))
        self.mass = np.zeros((self.CELLS + 1, self.CELLS + 1))
        consistent = np.array([[2, 1], [1, 2]]) / 6
        for e in range(self.CELLS):
            ends = slice(e, e + 2)
            self.stiffness[ends, ends] += self.YOUNG / self.SIZE * np.array([[1, -1], [-1, 1]])
            self.mass[ends, ends] += self.DENSITY * self.SIZE * (np.eye(2) / 2 if lumped else consistent)

    def run(self, gravity, end, v0=0.0):
        """Times, contact force at t_{s+1}, height of the lower end, energy, velocity of the centre.

        The energy is zero for the undeformed bar standing on the wall.
        """
        am, af, gamma, beta = self.parameters
        k = self.stiffness
        m = self.mass
        h = self.STEP
        ones = np.ones(self.CELLS + 1)
        lower = np.zeros(self.CELLS + 1)
        lower[0] = 1.0
        weight = -gravity * (m @ ones)
        b1 = 1 / (beta * h * h)
        open_inverse = np.linalg.inv((1 - am) * b1 * m + (1 - af) * k)
        mass_inverse = np.linalg.inv(m)
        share, old_share = ((1 - af), af) if self.level == "alpha_f" else (1.0, 0.0)
        u = np.zeros(self.CELLS + 1)
        v = np.full(self.CELLS + 1, v0)
        a = -gravity * ones
        force = 0.0
        closed = False
        rows = []
        for s in range(round(end / h) + 1):
            if s > 0:
                # a1 = b1 (d - h v - (1/2 - beta) h^2 a)
                known = am * (m @ a) + (1 - af) * (k @ u - weight) + af * (k @ u - weight) - old_share * force * lower
                known -= (1 - am) * (m @ (b1 * (h * v + (0.5 - beta) * h * h * a)))
                d = -open_inverse @ known
                new = 0.0
                if self.START + u[0] + d[0] < 0.0:
                    # d0 = -(START + u0): one additional multiplier
                    response = open_inverse @ lower
                    p = (-(self.START + u[0]) - d[0]) / response[0]
                    d = d + p * response
                    new = p / share
                touched = new > 0.0
                a1 = b1 * (d - h * v - (0.5 - beta) * h * h * a)
                v = v + h * ((1 - gamma) * a + gamma * a1)
                a = a1
                u = u + d
                if self.project and touched and not closed:
                    v = v + mass_inverse[:, 0] * (-v[0] / mass_inverse[0, 0])
                    free = mass_inverse @ (weight - k @ u)
                    new = -free[0] / mass_inverse[0, 0]
                    a = free + mass_inverse[:, 0] * new
                force = new
                closed = touched
            energy = 0.5 * v @ m @ v + 0.5 * u @ k @ u + gravity * ones @ m @ (u + self.START * ones)
            rows.append((s * h, force, self.START + u[0], energy, (ones @ m @ v) / (self.DENSITY * self.LENGTH)))
        return np.array(rows).T

    def bounce(self, t):
        """Exact height of the lower end in the bouncing case, of which the first fall takes 1."""
        transit = self.LENGTH / self.WAVE_SPEED
        gravity = 10.0
        period = 16 * transit
        t = t % period
        if t > period / 2:
            t = period - t
        if t <= 1.0:
            return self.START - gravity * t * t / 2
        after = t - (1.0 + 2 * transit)
        if after <= 0.0:
            return 0.0
        x = (self.WAVE_SPEED * after / self.LENGTH) % 2
        return self.START - gravity * (after - 1.0) ** 2 / 2 - gravity * transit**2 * x * (2 - x)

    def figures(self):
        """Of a single impact: peak and roughness of the force, the ratios of energy and velocity; of
        bouncing under gravity: the error of the third bounce and the ratio of energy."""
        t, p, _, energy, v = self.run(0.0, 2.0, -10.0)
        inside = (t > 0.52 + 1e-9) & (t < 1.147 - 1e-9)
        first = [p.max() / 300, np.sqrt(np.mean((p[inside] / 300 - 1) ** 2)), energy[-1] / energy[0], v[-1] / 10]
        t, p, y, energy, _ = self.run(10.0, 16.0)
        period = 16 * self.LENGTH / self.WAVE_SPEED
        last = (t >= 2 * period - 1e-9) & (t <= 3 * period + 1e-9)
        error = np.sqrt(np.mean([(a - self.bounce(b)) ** 2 for a, b in zip(y[last], t[last])])) / self.START
        return [*first, error, energy[-1] / energy[0]]


def bar():
    print(f"{'scheme':12} {'mass':11} {'force':8} {'begin':8}  peak    rms     E/E0    v_cm    (b) err (b) E")
    for name, lumped, level, project in itertools.product(Bar.schemes(), (False, True), ("alpha_f", "end"), (False, True)):
        row = Bar(name, lumped, level, project).figures()
        mass = "lumped" if lumped else "consistent"
        begin = "project" if project else "none"
        print(f"{name:12} {mass:11} {level:8} {begin:8}", " ".join(f"{x:7.4f}" for x in row))


def oblique_impact(psi, k):
    """J_T/(mu J_N) and the incidence after the impact, for the incidence psi = k v_t/(mu v_n)."""
    springs = 1000
    steps = 2000
    deepest = (15 / 16) ** 0.4
    dx = 1.001 * deepest**0.5 / springs
    sag = ((np.arange(springs) + 0.5) * dx) ** 2
    stretch = np.zeros(springs)
    step = 3 * deepest / steps
    # Tangential lengths, velocities and forces are divided by mu/k, mu/k and mu.
    depth = normal = tangential = 0.0
    approach = 1.0
    slip = psi
    normal_impulse = tangential_impulse = 0.0
    while True:
        approach -= step / 2 * normal
        slip -= step / 2 * 3.5 * k * tangential
        depth += step * approach
        normal_impulse += step / 2 * normal
        tangential_impulse += step / 2 * tangential
        press = np.maximum(depth - sag, 0.0)
        stretch = np.clip(stretch + step * slip, -press, press)
        normal = 2 * dx * press.sum()
        tangential = 2 * dx * stretch.sum()
        approach -= step / 2 * normal
        slip -= step / 2 * 3.5 * k * tangential
        normal_impulse += step / 2 * normal
        tangential_impulse += step / 2 * tangential
        if depth <= 0:
            return tangential_impulse / normal_impulse, slip


def oblique(poisson=0.3):
    """An elastic ball that strikes a plane or an equal ball obliquely, in the theory of N. Maw, J. R.
    Barber and J. N. Fawcett (Wear 38 (1976) 101-114): Hertz's contact, tangential tractions that do not
    affect the normal ones, Coulomb's law.

    By the method of dimensionality reduction (V. L. Popov, M. Hess, 2015), which is exact for it: the
    contact is a bed of springs of the stiffness E* dx and G* dx under the profile x^2/R, each of which
    sticks or slips by itself, with G*/E* = k = 2 (1 - nu)/(2 - nu). Units: E* = R = m = 1, v_n = 1 for the
    pair; tangentially the mass is 2/7 m, that of the surface of a ball. Nothing sticks for psi >= 7 k - 1.
    """
    k = 2 * (1 - poisson) / (2 - poisson)
    for psi in (0.5, 1.0, 2.0, 3.0, 4.0, 7 * k - 1, 6.0):
        ratio, after = oblique_impact(psi, k)
        print(f"psi = {psi:.4g}: J_T/(mu J_N) = {ratio:.4f}, psi after {after:.4f}")


def touching(thickness, ovality):
    """The pressure P at which the centre lines of a ring are `thickness` apart."""
    # The angle of the place is s - pi/2 to first order.
    natural = lambda s: 1 - 3 * ovality * np.cos(2 * s)

    def right(s, u, p):
        # The fourth component is k - k_0.
        _, _, a, bend, n, q = u
        k = bend + natural(s)
        return np.vstack([np.cos(a), np.sin(a), k, -q, q * k, -p[0] - n * k])

    s = np.linspace(0, np.pi / 2, 200)
    u = np.vstack([1.05 * np.sin(s), -0.95 * np.cos(s), s, -0.15 * np.cos(2 * s), 0 * s - 3, 0 * s])
    p = np.array([3.0])
    for gap in np.linspace(1.9, thickness, 60):

        def ends(a, b, p):
            return np.array([a[0], a[2], a[5], a[1] + gap / 2, b[1], b[2] - np.pi / 2, b[5]])

        found = solve_bvp(right, ends, s, u, p=p, tol=1e-10, max_nodes=50000)
        assert found.success, found.message
        s = found.x
        u = found.y
        p = found.p
    return p[0]


def ring():
    """A closed inextensible line of length 2 pi R with bending stiffness E I, under the pressure p that
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
    for thickness, ovality in ((1e-9, 0.0), (0.02, 0.0), (0.02, 0.001)):
        print(f"t/R = {thickness:g}, ovality {ovality:g}: P = {touching(thickness, ovality):.7g}")


# The compressible neo-Hookean law P = mu (F - F^-T) + Lambda ln J F^-T of cases/static.
LAMBDA = 200.0
MU = 100.0


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


def elastica(load):
    """Deflection/L and shortening/L of a cantilever with a dead end force, by elliptic integrals, for
    the load A = P L^2/(E I)."""

    def amplitude(sine):
        m = (1 + sine) / 2
        return m, np.arcsin(1 / np.sqrt(2 * m))

    def miss(sine):
        m, start = amplitude(sine)
        return ellipk(m) - ellipkinc(start, m) - np.sqrt(load)

    sine = brentq(miss, 1e-9, 1 - 1e-12, xtol=1e-15)
    m, start = amplitude(sine)
    down = 1 - 2 / np.sqrt(load) * (ellipe(m) - ellipeinc(start, m))
    print(f"elastica, A = {load}: deflection/L {down:.8f}, shortening/L {1 - np.sqrt(2 * sine / load):.8f}")


def lame(young=1.0, poisson=0.3, inner=1.0, outer=2.0, pressure=1e-6):
    """Lamé's ring in plane strain under a pressure inside."""
    a = pressure * inner**2 / (outer**2 - inner**2)
    radial = lambda r: (1 + poisson) / young * a * ((1 - 2 * poisson) * r + outer**2 / r)
    stress = lambda r: (a * (1 - outer**2 / r**2), a * (1 + outer**2 / r**2))
    print(f"Lame: u(inner) {radial(inner):.16g}, u(outer) {radial(outer):.16g}, stresses at 1.5 {stress(1.5)}")


def inflation(pressure, inner=1.0, outer=2.0):
    """A thick neo-Hookean ring under a pressure inside: the equation dP_R/dR + (P_R - P_T)/R = 0 for r(R),
    solved as a boundary value problem."""

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
    guess = np.array([1.1 * radii, np.full_like(radii, 1.0)])
    found = solve_bvp(rates, ends, radii, guess, tol=1e-11, max_nodes=100000)
    assert found.success, found.message
    r, slope = found.sol(1.5)
    across, along = stresses(1.5, r, slope)
    print(
        f"ring, p = {pressure}: u(inner) {found.sol(inner)[0] - inner:.10f}, u(outer) {found.sol(outer)[0] - outer:.10f}, "
        f"at 1.5: Cauchy {across * 1.5 / r:.8f} across, {along / slope:.8f} along"
    )


def static():
    homogeneous()
    for load in (1, 2, 5, 10):
        elastica(load)
    lame()
    inflation(40.0)


def largest_force(young=206.9, poisson=0.29):
    """A bar with yield stress 0.45 + 0.265 (1 − exp(−16.93 α)) + 0.12924 α in logarithmic strains: the
    force per undeformed area, τ exp(−ln λ) with ln λ = α + τ/E, is largest at this α."""

    def strength(alpha):
        return 0.45 + 0.265 * (1 - np.exp(-16.93 * alpha)) + 0.12924 * alpha

    def slope(alpha):
        rise = 0.265 * 16.93 * np.exp(-16.93 * alpha) + 0.12924
        return rise - strength(alpha) * (1 + rise / young)

    alpha = brentq(slope, 0.01, 1.0, xtol=1e-15)
    tau = strength(alpha)
    stretch = np.exp(alpha + tau / young)
    across = np.exp(-alpha / 2 - poisson * tau / young)
    print(f"bar: largest force {tau / stretch:.9f} at α = {alpha:.9f}, λ = {stretch:.9f}, across {across:.9f}")


def yielding_sphere(young=21000.0, poisson=0.3, strength=0.24, inner=1.0, outer=2.0):
    """Perfectly plastic thick sphere under inner pressure, small strains (R. Hill, The Mathematical Theory
    of Plasticity, 1950, §V.2): yields up to c with p = 2Y ln(c/a) + (2Y/3)(1 − c³/b³)."""
    for pressure in (0.20, 0.25, 0.30):

        def excess(c):
            return 2 * strength * (np.log(c / inner) + (1 - (c / outer) ** 3) / 3) - pressure

        c = brentq(excess, inner, outer, xtol=1e-14)
        moved = strength * c**3 * (1 - poisson) / (young * outer**2)
        # σ_φ − σ_r = Y where it yields, σ_r = −p inside.
        hoop = strength - pressure
        # Unloading is elastic: Lamé's hoop stress at the inner surface is p (a³ + b³/2)/(b³ − a³).
        hoop -= pressure * (inner**3 + outer**3 / 2) / (outer**3 - inner**3)
        print(f"sphere, p = {pressure}: c = {c:.7f}, u(outer) = {moved:.9e}, hoop stress left {hoop:.7f}")


def yielding_ring(young=21000.0, poisson=0.3, strength=0.24, inner=1.0, outer=2.0, cells=200):
    """The same of a thick ring in plane strain, by linear cells in radius with radial return: the
    displacement of its outer surface."""
    radii = np.linspace(inner, outer, cells + 1)
    middle = (radii[1:] + radii[:-1]) / 2
    size = np.diff(radii)
    shear = young / (2 * (1 + poisson))
    bulk = young / (3 * (1 - 2 * poisson))
    # ε_r, ε_φ from the displacements of both nodes.
    slopes = np.array([[-1 / size, 1 / size], [0.5 / middle, 0.5 / middle]])
    moduli = np.full((2, 2), bulk - 2 * shear / 3) + 2 * shear * np.eye(2)
    matrix = np.zeros((cells + 1, cells + 1))
    for k in range(cells):
        local = slopes[:, :, k]
        matrix[k : k + 2, k : k + 2] += middle[k] * size[k] * local.T @ moduli @ local
    inverse = np.linalg.inv(matrix)
    u = np.zeros(cells + 1)
    plastic = np.zeros((3, cells))
    for pressure in np.linspace(0.0, 0.18, 361)[1:]:
        for _ in range(20000):
            strain = np.zeros((3, cells))
            for i in range(2):
                strain[i] = slopes[i, 0] * u[:-1] + slopes[i, 1] * u[1:]
            elastic = strain - plastic
            mean = elastic.sum(axis=0) / 3
            deviator = 2 * shear * (elastic - mean)
            mises = np.sqrt(1.5 * (deviator**2).sum(axis=0))
            excess = np.maximum(mises - strength, 0)
            flow = deviator * (1.5 * excess / (3 * shear) / np.maximum(mises, 1e-300))
            stress = deviator - 2 * shear * flow + 3 * bulk * mean
            force = np.zeros(cells + 1)
            for node in range(2):
                force[node : cells + node] += middle * size * (stress[:2] * slopes[:, node]).sum(axis=0)
            force[0] -= pressure * inner
            if np.abs(force).max() < 1e-12:
                break
            u -= 1.5 * inverse @ force
        plastic += flow
    print(f"ring, plane strain, p = 0.18: u(outer) = {u[-1]:.7e}, u(inner) = {u[0]:.7e} with {cells} cells")


def stopping(density=2700.0, strength=1e8):
    """Rings and shells that are thrown outwards and stopped by plastic flow, rigid before: all kinetic energy
    becomes plastic work. Thin ring: r'' = −Y/(ρ r)."""
    start, speed = 0.1, 150.0
    specific = density * speed**2 / 2
    strain = brentq(lambda strain: strength * strain + strength * strain**2 - specific, 0, 1, xtol=1e-15)
    end = start * np.exp(strain)
    print(f"thin ring, H = 2Y: stops at {end:.12f}, dissipates {strength * strain / specific:.9f} of its energy")
    end = start * np.exp(density * speed**2 / (2 * strength))
    # With r = end exp(−s²) and v² = (2Y/ρ) s².
    rate = np.sqrt(2 * strength / density)
    whole = np.sqrt(np.log(end / start))
    time = quad(lambda s: 2 * end * np.exp(-(s**2)) / rate, 0, whole, epsabs=1e-16)[0]
    print(f"thin ring: stops at {end:.9f} after {time:.9e}")
    inner, outer = 0.1, 0.11
    for kind, power, factor in (("sphere", 3, 2.0), ("cylinder", 2, 2 / np.sqrt(3))):
        for speed in (100.0, 150.0, 200.0):
            # v = speed (a/R)^(power − 1); the volume element is R^(power − 1) dR.
            kinetic = quad(
                lambda r: 0.5 * density * (speed * (inner / r) ** (power - 1)) ** 2 * r ** (power - 1), inner, outer
            )[0]

            def left(end):
                def work(r):
                    now = (r**power + end**power - inner**power) ** (1 / power)
                    return strength * factor * np.log(now / r) * r ** (power - 1)

                return kinetic - quad(work, inner, outer)[0]

            print(f"{kind}, {speed:.0f}: inner radius {brentq(left, inner, 0.3, xtol=1e-14):.9f}")


def plastic():
    largest_force()
    yielding_sphere()
    yielding_ring()
    stopping()


def waves(poisson=0.3, inner=1.0, joint=1.5, outer=2.0, speed=0.01, cells=800):
    """Radial waves in plane strain, E = ρ = 1: linear cells with lumped masses, central differences.
    The ring inside the joint starts with the speed, the other one at rest; they stay together."""
    shear = 0.5 / (1 + poisson)
    lame_constant = poisson / (1 + poisson) / (1 - 2 * poisson)
    bulk = lame_constant + 2 * shear
    radii = np.linspace(inner, outer, cells + 1)
    middles = 0.5 * (radii[1:] + radii[:-1])
    size = radii[1] - radii[0]
    mass = np.zeros(cells + 1)
    mass[:-1] += 0.5 * size * middles
    mass[1:] += 0.5 * size * middles
    at_joint = int(np.argmin(abs(radii - joint)))
    u = np.zeros(cells + 1)
    v = np.where(radii < joint, speed, 0.0)
    v[at_joint] = 0.5 * speed
    step = 0.5 * size / np.sqrt(bulk)
    rows = []
    for k in range(int(0.62 / step)):
        stretch = (u[1:] - u[:-1]) / size
        hoop = 0.5 * (u[1:] + u[:-1]) / middles
        radial = middles * (bulk * stretch + lame_constant * hoop)
        around = 0.5 * size * (bulk * hoop + lame_constant * stretch)
        force = np.zeros(cells + 1)
        force[:-1] += radial - around
        force[1:] -= radial + around
        v += step * force / mass
        u += step * v
        beside = radial[at_joint - 1 : at_joint + 1] / middles[at_joint - 1 : at_joint + 1]
        rows.append((k * step, -beside.mean()))
    times, pressures = np.array(rows).T
    plane = 0.5 * np.sqrt(bulk) * speed
    for time in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6):
        mean = pressures[abs(times - time) <= 0.01].mean()
        print(f"rings that collide: p/p₁ = {mean / plane:.4f} at t = {time}")
    print(f"first waves return at t = {2 * (joint - inner) / np.sqrt(bulk):.5f}")


TABLES = {
    "bar": bar,
    "oblique": oblique,
    "plastic": plastic,
    "ring": ring,
    "static": static,
    "waves": waves,
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in TABLES:
        sys.exit(__doc__)
    TABLES[sys.argv[1]]()
