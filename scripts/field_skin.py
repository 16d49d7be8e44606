"""Skins of bodies in space for field_check_space.py: the boundary of curved cells, what it surrounds, and
distances to it (Python 3, numpy).

A skin is the set of faces of cells that belong to one cell. A face is the polynomial of degree p
through its nodes, sampled at the points with coordinates k/6 and along sharp edges at k/24, and
divided at the former into flat triangles; a flat face of three nodes is one triangle. Cells and their
nodes are in the order of VTK.
"""

import numpy as np

from field_judge import CORNER, SELF_LIMIT

PARTS, ALONG = 6, 24
# A fixed rotation: rays along its rows are along no edge of a mesh that was made by hand.
RAYS = np.linalg.qr(np.array([[0.9, 0.31, 0.17], [-0.23, 0.8, 0.41], [0.37, -0.19, 1.0]]))[0]

TET = {1: 4, 2: 10}
HEX = {1: 8, 2: 27}
TET_EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
TET_FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
HEX_CORNERS = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
HEX_EDGES = [(0, 1), (1, 2), (3, 2), (0, 3), (4, 5), (5, 6), (7, 6), (4, 7), (0, 4), (1, 5), (2, 6), (3, 7)]
HEX_FACES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]


class Cell:
    """A kind of cell, by its number of nodes: where its nodes are, its faces, powers of its polynomials."""

    def __init__(self, count):
        self.tet = count in TET.values()
        self.p = {4: 1, 10: 2, 8: 1, 27: 2}[count]
        corners = np.vstack([np.zeros(3), np.eye(3)]) if self.tet else HEX_CORNERS.astype(float)
        edges, faces = (TET_EDGES, TET_FACES) if self.tet else (HEX_EDGES, HEX_FACES)
        nodes, middle = list(corners), {}
        if self.p == 2:
            for a, b in edges:
                middle[frozenset((a, b))] = len(nodes)
                nodes.append((corners[a] + corners[b]) / 2)
            for face in [] if self.tet else faces:
                middle[frozenset(face)] = len(nodes)
                nodes.append(corners[list(face)].mean(0))
            nodes += [] if self.tet else [np.full(3, 0.5)]
        self.nodes, self.faces = np.array(nodes), []
        for face in faces:
            n = len(face)
            sides = [middle[frozenset((face[i], face[(i + 1) % n]))] for i in range(n)] if self.p == 2 else []
            self.faces.append([*face, *sides, *([middle[frozenset(face)]] if self.p == 2 and n == 4 else [])])
        k = range(self.p + 1)
        self.powers = [(a, b, c) for a in k for b in k for c in k if not self.tet or a + b + c <= self.p]
        self.inverse = np.linalg.inv(monomials(self.nodes, self.powers))

    def values(self, at):
        return monomials(at, self.powers) @ self.inverse

    def slopes(self, at):
        """(3, points, nodes)."""
        return np.array([monomials(at, self.powers, i) @ self.inverse for i in range(3)])

    def lattice(self, n):
        points = np.array([(a, b, c) for a in range(n + 1) for b in range(n + 1) for c in range(n + 1)]) / n
        return points[points.sum(1) <= 1 + 1e-12] if self.tet else points

    def quadrature(self, n=5):
        """Gauss points and weights, collapsed for tetrahedra."""
        x, w = np.polynomial.legendre.leggauss(n)
        x, w = (x + 1) / 2, w / 2
        a, b, c = (g.ravel() for g in np.meshgrid(x, x, x, indexing="ij"))
        weight = np.einsum("i,j,k->ijk", w, w, w).ravel()
        if not self.tet:
            return np.column_stack([a, b, c]), weight
        return np.column_stack([a, b * (1 - a), c * (1 - a) * (1 - b)]), weight * (1 - a) ** 2 * (1 - b)


def monomials(at, powers, by=None):
    """Products of powers of the coordinates, or their derivatives by one."""
    columns = []
    for power in powers:
        column = np.ones(len(at))
        for i, k in enumerate(power):
            x = at[:, i]
            column = column * (x**k if i != by else k * x ** max(k - 1, 0))
        columns.append(column)
    return np.array(columns).T


class Face:
    """A kind of face: its samples, its triangles, and its tangents at the corners."""

    def __init__(self, count, p):
        self.corners = 4 if count in (4, 9) else 3
        self.p, quad = p, self.corners == 4
        corner = np.array([(0, 0), (1, 0), (1, 1), (0, 1)] if quad else [(0, 0), (1, 0), (0, 1)], float)
        nodes = list(corner)
        if p == 2:
            nodes += [(corner[i] + corner[(i + 1) % len(corner)]) / 2 for i in range(len(corner))]
            nodes += [np.full(2, 0.5)] if quad else []
        k = range(p + 1)
        powers = [(a, b) for a in k for b in k if quad or a + b <= p]
        inverse = np.linalg.inv(monomials(np.array(nodes), powers))
        self.values = lambda at: monomials(at, powers) @ inverse
        self.slopes = lambda at: np.array([monomials(at, powers, i) @ inverse for i in (0, 1)])
        lattice = lambda n: [(i, j) for i in range(n + 1) for j in range(n + 1) if quad or i + j <= n]
        self.samples = self.values(np.array(lattice(PARTS)) / PARTS)
        # Bilinear and curved faces are divided, flat triangles are not.
        n = PARTS if quad or p > 1 else 1
        points = lattice(n)
        number = {point: i for i, point in enumerate(points)}
        triangles = []
        for i, j in points:
            if (i + 1, j) in number and (i, j + 1) in number:
                triangles.append((number[i, j], number[i + 1, j], number[i, j + 1]))
                if (i + 1, j + 1) in number:
                    triangles.append((number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]))
        self.triangles = self.values(np.array(points) / n)[np.array(triangles)]
        middle = corner.mean(0)
        self.below = np.array([middle, *(0.5 * (c + middle) for c in corner)])
        self.at_corners = self.slopes(corner)
        s = np.linspace(0, 1, ALONG + 1)[:, None]
        ends = zip(corner, np.roll(corner, -1, axis=0))
        self.along = np.array([self.values(a + s * (b - a)) for a, b in ends])


class Skin:
    """One body: its boundary and, after `at`, the samples of one instant."""

    def __init__(self, cells, reference):
        self.cells, self.nodes_of_body = cells, np.unique(cells)
        self.cell = Cell(cells.shape[1])
        self.p = self.cell.p
        found = {}
        for face in self.cell.faces:
            n = 4 if len(face) in (4, 9) else 3
            for nodes in cells[:, face]:
                key = frozenset(nodes[:n].tolist())
                if key in found:
                    found[key] = None
                else:
                    found[key] = nodes
        self.faces = np.array([nodes for nodes in found.values() if nodes is not None])
        self.face = Face(self.faces.shape[1], self.p)
        self.nodes, first = np.unique(self.faces, return_index=True)
        self.node_facet = first // self.faces.shape[1]
        self.slopes = self.cell.slopes(self.cell.lattice(6 if self.cell.tet else 4))
        corners = reference[self.faces[:, : self.face.corners]]
        self.h = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(1)
        self.sag = self.turning(reference) / (4 * self.p**2)
        self.at(reference)
        at, weight = self.cell.quadrature()
        self.values = self.cell.values(at)
        jacobian = np.einsum("dqn,cni->cqdi", self.cell.slopes(at), reference[cells])
        self.weight = np.linalg.det(jacobian) * weight
        t = self.triangles.reshape(-1, 3, 3)
        area = np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum() / 2
        self.thick = 6 * self.weight.sum() / max(area, 1e-300)

    def at(self, position):
        self.position = position
        x = position[self.faces]
        self.samples = np.einsum("kn,fni->fki", self.face.samples, x)
        self.triangles = np.einsum("tkn,fni->ftki", self.face.triangles, x)
        self.edges = np.einsum("ekn,eni->eki", self.face.along[self.sharp[:, 1]], x[self.sharp[:, 0]])
        points = self.triangles.reshape(-1, 3)
        self.low, self.high = points.min(0), points.max(0)
        self.center = position[self.nodes_of_body].mean(0)
        self.extent = float(np.linalg.norm(self.high - self.low))
        flat = self.triangles.reshape(len(x), -1, 3)
        self.middle = 0.5 * (flat.min(1) + flat.max(1))
        self.radius = np.linalg.norm(flat - self.middle[:, None], axis=2).max(1)
        self.turned = {}

    def inverted(self):
        """Whether the map of a cell has a determinant that is not positive."""
        jacobian = np.einsum("dqn,cni->cqdi", self.slopes, self.position[self.cells])
        return bool((np.linalg.det(jacobian) <= 0).any())

    def turning(self, x):
        """Largest angle between normals at two corners of a face, with the kink to the next one; finds sharp edges."""
        t = np.einsum("dqn,fni->dfqi", self.face.at_corners, x[self.faces])
        n = np.cross(t[0], t[1])
        n /= np.maximum(np.linalg.norm(n, axis=2, keepdims=True), 1e-300)
        angle = lambda a, b: np.arccos(np.clip((a * b).sum(-1), -1, 1))
        own, kink, edges = np.zeros(len(n)), np.zeros(len(n)), {}
        corners = self.face.corners
        for i in range(corners):
            j = (i + 1) % corners
            own = np.maximum(own, angle(n[:, i], n[:, j]))
            for f, (a, b) in enumerate(self.faces[:, [i, j]].tolist()):
                edges.setdefault(frozenset((a, b)), []).append((f, i, {a: n[f, i], b: n[f, j]}))
        sharp = []
        for ends, pair in edges.items():
            (f, i, one), (g, _, other) = pair[0], pair[-1]
            found = max(angle(one[a], other[a]) for a in ends)
            if found > CORNER:
                sharp.append((f, i))
            else:
                kink[f], kink[g] = max(kink[f], found), max(kink[g], found)
        self.sharp = np.array(sharp, int).reshape(-1, 2)
        return float((own + kink).max())

    def points_near(self, low, high):
        """Sampled points of the faces and sharp edges whose boxes meet a box, and their h."""
        points, own = [], []
        for samples, h in ((self.samples, self.h), (self.edges, self.h[self.sharp[:, 0]])):
            hit = ((samples.min(1) <= high) & (samples.max(1) >= low)).all(1)
            points.append(samples[hit].reshape(-1, 3))
            own.append(np.repeat(h[hit], samples.shape[1]))
        return np.concatenate(points), np.concatenate(own)

    def winding(self, points, ray=0):
        """How often the skin surrounds points: triangles left through less triangles entered along a ray."""
        if ray not in self.turned:
            basis = np.roll(RAYS, ray, axis=0)
            t = self.triangles @ basis.T
            flat = t.reshape(len(t), -1, 3)
            self.turned[ray] = basis, t, flat.min(1), flat.max(1)
        basis, t, low, high = self.turned[ray]
        x = points @ basis.T
        result = np.zeros(len(x), int)
        if not len(x):
            return result
        all_low, all_high = x.min(0), x.max(0)
        useful = (low[:, :2] <= all_high[:2]).all(1) & (high[:, :2] >= all_low[:2]).all(1) & (high[:, 2] >= all_low[2])
        for f in np.flatnonzero(useful):
            mine = np.flatnonzero(((x[:, :2] >= low[f, :2]) & (x[:, :2] <= high[f, :2])).all(1) & (x[:, 2] <= high[f, 2]))
            if len(mine):
                result[mine] += crossings(x[mine], t[f])
        return result

    def inside(self, points):
        """Which points are inside, along two rays."""
        result = np.zeros(len(points), bool)
        near = np.flatnonzero(((points > self.low) & (points < self.high)).all(1))
        for ray in (0, 1):
            near = near[self.winding(points[near], ray) > 0]
        result[near] = True
        return result

    def distance(self, points):
        """Distance of points to the skin, and the face there."""
        best, face = np.full(len(points), np.inf), np.zeros(len(points), int)
        if not len(points):
            return best, face
        away = np.linalg.norm(points[:, None] - self.middle[None], axis=2)
        bound = (away + self.radius).min(1)
        for f in np.flatnonzero((away - self.radius <= bound[:, None]).any(0)):
            mine = np.flatnonzero(away[:, f] - self.radius[f] <= np.minimum(bound, best))
            if len(mine):
                found = to_triangles(points[mine], self.triangles[f])
                closer = found < best[mine]
                best[mine[closer]], face[mine[closer]] = found[closer], f
        return best, face

    def meets(self, start, end):
        """How often the segment from start to end crosses the skin."""
        along = end - start
        length = np.linalg.norm(along)
        if length == 0:
            return 0
        side = np.cross(along, np.eye(3)[np.abs(along).argmin()])
        side /= np.linalg.norm(side)
        basis = np.array([side, np.cross(along / length, side), along / length])
        t = self.triangles.reshape(-1, 3, 3) @ basis.T
        x = (start @ basis.T)[None]
        return int(abs_crossings(x, t)[0] - abs_crossings(x + [[0, 0, length]], t)[0])

    def below(self):
        """Points a tenth of h below the faces."""
        at = self.face.values(self.face.below)
        x = self.position[self.faces]
        t = np.einsum("dqn,fni->dfqi", self.face.slopes(self.face.below), x)
        n = np.cross(t[0], t[1])
        n /= np.maximum(np.linalg.norm(n, axis=2, keepdims=True), 1e-300)
        h = np.minimum(self.h, self.thick)[:, None, None]
        return (np.einsum("qn,fni->fqi", at, x) - SELF_LIMIT * h * n).reshape(-1, 3)

    def moments(self, position, velocity, density, lumped):
        """Momentum, angular momentum about the centre of mass, Σ m|v| and Σ m|x||v|."""
        if lumped:  # HRZ: the diagonal of the consistent matrix, scaled to the mass of the cell
            diagonal = np.einsum("cq,qn->cn", self.weight, self.values**2)
            diagonal *= (self.weight.sum(1) / diagonal.sum(1))[:, None]
            m, at = density * diagonal, self.cells
            x, v = position[at], velocity[at]
        else:
            m = density * self.weight
            x, v = (np.einsum("qn,cni->cqi", self.values, f[self.cells]) for f in (position, velocity))
        return m.ravel(), x.reshape(-1, 3), v.reshape(-1, 3)


def signed(x, t):
    """(points, triangles): whether the upward ray from x meets a triangle, as +1 (leaving) or −1."""
    d = t[None] - x[:, None, None]
    u, v, w = d[:, :, 0], d[:, :, 1], d[:, :, 2]
    cross = lambda a, b: a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    a, b, c = cross(v, w), cross(w, u), cross(u, v)
    inward = (a > 0) & (b > 0) & (c > 0)
    outward = (a < 0) & (b < 0) & (c < 0)
    total = a + b + c
    height = (a * u[..., 2] + b * v[..., 2] + c * w[..., 2]) / np.where(total == 0, 1, total)
    return (inward.astype(int) - outward.astype(int)) * (height > 0)


def crossings(x, t):
    return signed(x, t).sum(1)


def abs_crossings(x, t):
    return np.abs(signed(x, t)).sum(1)


def to_triangles(x, t):
    """Least distance of each point to triangles (Ericson, Real-Time Collision Detection, 5.1.5): to the plane
    where the foot is inside, else to the edges."""
    a, b, c = t[None, :, 0], t[None, :, 1], t[None, :, 2]
    best = np.full((len(x), t.shape[0]), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        along, r = q - p, x[:, None] - p
        s = np.clip((r * along).sum(2) / np.maximum((along**2).sum(2), 1e-300), 0, 1)
        best = np.minimum(best, ((r - s[..., None] * along) ** 2).sum(2))
    n = np.cross(b - a, c - a)
    square = np.maximum((n**2).sum(2), 1e-300)
    r = x[:, None] - a
    weight = lambda u, v: (np.cross(u, v) * n).sum(2)
    first, second = weight(r, c - a), weight(b - a, r)
    foot = (first >= 0) & (second >= 0) & (first + second <= square)
    best = np.where(foot, np.minimum(best, (r * n).sum(2) ** 2 / square), best)
    return np.sqrt(best.min(1))
