#!/usr/bin/env python3
"""Reference values of cases/plastic/neck.toml, computed without any code of Carom: a round bar that necks.

    scripts/reference_neck.py [RADIAL AXIAL]…       (needs: pip install numpy scipy)

Axisymmetric quadrilaterals of eight nodes with 2 × 2 points, J2 in logarithmic strains, tangents by
differences. Half of a bar 53.334 mm long with a radius of 6.413 mm, 1.8 % less in the middle, and free ends.
Without arguments 3 × 10, 4 × 16 and 6 × 24 cells, in a few minutes.
"""

import itertools
import sys

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import spsolve

SHEAR = 206.9 / (2 * 1.29)
BULK = 206.9 / (3 * (1 - 2 * 0.29))
LENGTH, RADIUS, THINNER = 26.667, 6.413, 0.018
STEPS, ELONGATION = 140, 7.0
# Of F and P: the components that do not vanish.
COMPONENTS = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)]


def strength(alpha):
    return 0.45 + 0.265 * (1 - np.exp(-16.93 * alpha)) + 0.12924 * alpha


def hardening(alpha):
    return 0.265 * 16.93 * np.exp(-16.93 * alpha) + 0.12924


def across(axes, values):
    return np.einsum("nia,na,nja->nij", axes, values, axes)


def response(f, plastic, alpha):
    """P, and C_p⁻¹ and α at the end of a step, at many points."""
    b = f @ plastic @ f.swapaxes(1, 2)
    squares = np.empty((len(f), 3))
    axes = np.zeros((len(f), 3, 3))
    squares[:, :2], axes[:, :2, :2] = np.linalg.eigh(b[:, :2, :2])
    squares[:, 2] = b[:, 2, 2]
    axes[:, 2, 2] = 1
    strain = np.log(squares) / 2
    trace = strain.sum(1)[:, None]
    deviator = strain - trace / 3
    mises = 2 * SHEAR * np.sqrt(1.5 * (deviator**2).sum(1))
    flows = mises > strength(alpha)
    flow = np.zeros(len(f))
    for _ in range(40):
        remainder = mises - 3 * SHEAR * flow - strength(alpha + flow)
        flow = np.where(flows, flow + remainder / (3 * SHEAR + hardening(alpha + flow)), 0)
    left = np.where(flows, 1 - 3 * SHEAR * flow / np.maximum(mises, 1e-300), 1)[:, None]
    inverse = np.linalg.inv(f)
    stress = across(axes, BULK * trace + 2 * SHEAR * left * deviator) @ inverse.swapaxes(1, 2)
    elastic = across(axes, np.exp(2 * (trace / 3 + left * deviator)))
    return stress, inverse @ elastic @ inverse.swapaxes(1, 2), alpha + flow


def moduli(f, plastic, alpha, size=1e-6):
    found = np.empty((len(f), 5, 5))
    for k, (i, j) in enumerate(COMPONENTS):
        ends = []
        for sign in (1, -1):
            moved = f.copy()
            moved[:, i, j] += sign * size
            ends.append(response(moved, plastic, alpha)[0])
        change = (ends[0] - ends[1]) / (2 * size)
        for m, (a, c) in enumerate(COMPONENTS):
            found[:, m, k] = change[:, a, c]
    return found


def shape(x, y):
    """Values and gradients of the shape functions of eight nodes."""
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    values, gradients = [], []
    for p, q in corners:
        values.append((1 + p * x) * (1 + q * y) * (p * x + q * y - 1) / 4)
        gradients.append((p * (1 + q * y) * (2 * p * x + q * y) / 4, q * (1 + p * x) * (p * x + 2 * q * y) / 4))
    for p, q in [(0, -1), (1, 0), (0, 1), (-1, 0)]:
        if p == 0:
            values.append((1 - x * x) * (1 + q * y) / 2)
            gradients.append((-x * (1 + q * y), q * (1 - x * x) / 2))
        else:
            values.append((1 + p * x) * (1 - y * y) / 2)
            gradients.append((p * (1 - y * y) / 2, -y * (1 + p * x)))
    return np.array(values), np.array(gradients)


class Neck:
    def __init__(self, radial, axial):
        self.numbers = {}
        self.places = []
        corners = LENGTH * np.expm1(3 * np.linspace(0, 1, axial + 1)) / np.expm1(3)
        self.heights = np.interp(np.arange(2 * axial + 1) / 2, np.arange(axial + 1), corners)
        self.radial = radial
        around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        cells = [
            [self.node(2 * i + a, 2 * j + b) for a, b in around]
            for j, i in itertools.product(range(axial), range(radial))
        ]
        places = np.array(self.places)[np.array(cells)]
        points = list(itertools.product(np.array([-1, 1]) / np.sqrt(3), repeat=2))
        self.strains = np.zeros((len(cells), 4, 5, 16))
        self.weights = np.empty((len(cells), 4))
        for g, point in enumerate(points):
            values, gradients = shape(*point)
            jacobian = np.einsum("eai,aj->eij", places, gradients)
            slopes = np.einsum("aj,eji->eai", gradients, np.linalg.inv(jacobian))
            radius = places[:, :, 0] @ values
            self.weights[:, g] = np.linalg.det(jacobian) * 2 * np.pi * radius
            for row, (direction, axis) in enumerate([(0, 0), (0, 1), (1, 0), (1, 1)]):
                self.strains[:, g, row, direction::2] = slopes[:, :, axis]
            self.strains[:, g, 4, 0::2] = values / radius[:, None]
        self.dofs = np.stack([2 * np.array(cells), 2 * np.array(cells) + 1], 2).reshape(len(cells), 16)
        self.end = np.array([2 * n + 1 for (_, j), n in self.numbers.items() if j == 2 * axial])
        middle = [2 * n + 1 for (_, j), n in self.numbers.items() if j == 0]
        axis = [2 * n for (i, _), n in self.numbers.items() if i == 0]
        self.free = np.setdiff1d(np.arange(2 * len(self.places)), [*self.end, *middle, *axis])
        self.plastic = np.tile(np.eye(3), (4 * len(cells), 1, 1))
        self.alpha = np.zeros(4 * len(cells))

    def node(self, i, j):
        if (i, j) not in self.numbers:
            self.numbers[i, j] = len(self.places)
            z = self.heights[j]
            self.places.append((RADIUS * (1 - THINNER * (1 - z / LENGTH)) * i / (2 * self.radial), z))
        return self.numbers[i, j]

    def deformation(self, u):
        f = np.tile(np.eye(3), (len(self.alpha), 1, 1))
        gradients = np.einsum("egik,ek->egi", self.strains, u[self.dofs]).reshape(-1, 5)
        for m, (a, c) in enumerate(COMPONENTS):
            f[:, a, c] += gradients[:, m]
        return f

    def force(self, f):
        stress = response(f, self.plastic, self.alpha)[0]
        listed = np.stack([stress[:, a, c] for a, c in COMPONENTS], 1).reshape(-1, 4, 5)
        sums = np.zeros(2 * len(self.places))
        np.add.at(sums, self.dofs, np.einsum("egi,egik,eg->ek", listed, self.strains, self.weights))
        return sums

    def solved(self, u):
        """Newton's method; none if it does not converge in 25 iterations."""
        rows = np.repeat(self.dofs, 16, 1).ravel()
        columns = np.tile(self.dofs, (1, 16)).ravel()
        for _ in range(25):
            f = self.deformation(u)
            if not (np.linalg.det(f) > 0).all():
                return None
            force = self.force(f)
            if np.abs(force[self.free]).max() < 1e-9:
                return u, force
            tangent = moduli(f, self.plastic, self.alpha).reshape(-1, 4, 5, 5)
            parts = np.einsum("egik,egij,egjl,eg->ekl", self.strains, tangent, self.strains, self.weights)
            matrix = scipy.sparse.coo_matrix((parts.ravel(), (rows, columns)), shape=(len(u), len(u))).tocsc()
            u[self.free] -= spsolve(matrix[self.free][:, self.free], force[self.free])
        return None

    def pulled(self):
        """Rows of elongation of the whole bar, force and radius of the neck."""
        u = np.zeros(2 * len(self.places))
        rate = np.zeros_like(u)
        done, step = 0.0, ELONGATION / STEPS
        rows = []
        while done < ELONGATION - 1e-12:
            step = min(step, ELONGATION - done)
            trial = u + rate * step
            trial[self.end] = done + step
            if (found := self.solved(trial)) is None:
                step /= 2
                rate[:] = 0
                continue
            moved, force = found
            rate = (moved - u) / step
            u = moved
            done += step
            _, self.plastic, self.alpha = response(self.deformation(u), self.plastic, self.alpha)
            neck = RADIUS * (1 - THINNER) + u[2 * self.numbers[2 * self.radial, 0]]
            rows.append((2 * done, force[self.end].sum(), neck))
            step = min(1.5 * step, ELONGATION / STEPS)
        return np.array(rows)


def main():
    given = [int(word) for word in sys.argv[1:]] or [3, 10, 4, 16, 6, 24]
    for radial, axial in zip(given[::2], given[1::2], strict=True):
        elongation, force, radius = Neck(radial, axial).pulled().T
        at = force.argmax()
        radii = [f"{np.interp(mm, elongation, radius):.4f} mm at {mm} mm" for mm in (10, 14)]
        print(f"{radial} x {axial}: largest force {force[at]:.4f} kN at {elongation[at]:.2f} mm;", *radii, flush=True)


if __name__ == "__main__":
    main()
