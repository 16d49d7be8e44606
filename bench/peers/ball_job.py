"""Shared by the jobs of the ball in space: data of cases/space/ball.toml, reader of the meshes,
the window of timed steps, and output."""

import json

from job import DT, LAMBDA, MU, RHO, peak_mean_force, usage

SPEED, GAP, RADIUS = 3.0, 0.01, 0.5
# Gmsh's numbers of the cells and facets: corners and midside nodes.
TETRAHEDRA, TRIANGLES = (4, 11), (2, 9)


class Mesh:
    """Nodes, cells of the bodies and facets of the sides of a file of version 2.2."""

    def __init__(self, path):
        with open(path) as file:
            lines = file.read().splitlines()

        def section(name):
            first = lines.index(f"${name}") + 2
            return (line.split() for line in lines[first : first + int(lines[first - 1])])

        names = {(int(dimension), int(tag)): name.strip('"') for dimension, tag, name in section("PhysicalNames")}
        number, self.points = {}, []
        for tag, *point in section("Nodes"):
            number[int(tag)] = len(self.points)
            self.points.append(tuple(map(float, point)))
        self.bodies, self.sides = {}, {}
        for words in section("Elements"):
            _, kind, tags, physical, *rest = map(int, words)
            nodes = [number[tag] for tag in rest[tags - 1 :]]
            if kind in TETRAHEDRA:
                self.bodies.setdefault(names[3, physical], []).append(nodes)
            elif kind in TRIANGLES:
                self.sides.setdefault(names[2, physical], []).append(nodes)
        self.dofs = 3 * len({node for cells in self.bodies.values() for cell in cells for node in cell})

    def nodes(self, *sides):
        return sorted({node for side in sides for facet in self.sides[side] for node in facet})


class Clock:
    """Counts the processor time and the iterations of the steps FIRST to LAST, numbered from 1."""

    def __init__(self, first, last, velocity):
        self.first, self.last = first, last
        self.velocity, self.iterations, self.unconverged = [velocity], [], 0
        self.marks = [usage()[0]]

    def step(self, iterations, converged, velocity):
        self.marks.append(usage()[0])
        self.iterations.append(iterations)
        self.unconverged += not converged
        self.velocity.append(velocity)

    def print_result(self, code, dofs, mass):
        """Prints one JSON object; `mass` is that of the quarter, the force that of the whole ball."""
        first, last = self.first, self.last
        steps = last - first + 1
        force = peak_mean_force(4 * mass, self.velocity)
        print(json.dumps({
            "code": code, "dofs": dofs, "set_up": self.marks[0], "cpu_per_step": (self.marks[last] - self.marks[first - 1]) / steps,
            "newton": sum(self.iterations[first - 1 : last]) / steps, "memory_kib": usage()[1],
            "unconverged": self.unconverged, "peak_mean_force": force, "velocity": self.velocity[-1],
        }), flush=True)
