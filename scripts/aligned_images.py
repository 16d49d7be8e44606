"""Images of aligned cases under what does not change the mechanical problem: rotation, mirror, translation,
order of the bodies, units, uniform motion. For aligned_cases.py.
"""

from math import cos, radians, sin, sqrt

import ladder_solids
from aligned_setup import AXES, MAIN, TOUCHES, Setup, between, block, hold


def bases():
    """Set-ups of which the images are compared, as functions of the scheme; turning about no axis of symmetry."""

    def drop(scheme, element="Q4"):
        upper = block("block", element, [-0.5, 0.01], [0.5, 0.26], velocity=[0.0, -0.5])
        lower = block("pedestal", element, [-0.25, -0.25], [0.25, 0.0])
        return Setup("a block on a pedestal", [upper, lower], scheme, 0.09, contacts=[between("skin", upper, lower)], supports=[hold("pedestal.bottom")])

    def slide(scheme, element="Q4"):
        upper = block("block", element, [-0.4, 0.0], [0.1, 0.25], velocity=[0.5, 0.0], gravity=[0.0, -1.0])
        lower = block("table", element, [-1.0, -0.25], [0.0, 0.0])
        return Setup("a block slides over an edge", [upper, lower], scheme, 0.3, contacts=[between("skin", upper, lower)], supports=[hold("table.bottom")])

    def corner(scheme, element="Q4"):
        square = block("block", element, [-0.25, -0.25], [0.25, 0.25], place={"rotate": 45.0, "shift": [0.0, 0.25 * sqrt(2) + 0.01]}, velocity=[0.1, -0.5])
        lower = block("table", element, [-0.75, -0.5], [0.75, 0.0])
        return Setup("a square on its corner", [square, lower], scheme, 0.08, contacts=[between("skin", square, lower)], supports=[hold("table.bottom")])

    def strips(scheme, element="Q9"):
        a = block("block", element, [-0.5, -0.125], [0.0, 0.125], per=16, velocity=[0.2, 0.0])
        b = block("other", element, [0.002, -0.125], [0.502, 0.125], per=16)
        return Setup("strips end on end", [a, b], scheme, 0.06, contacts=[between("skin", a, b)])

    def cuboid(scheme, element="Hex8"):
        upper = block("block", element, [-0.25, -0.25, 0.005], [0.25, 0.25, 0.255], per=8, velocity=[0.0, 0.0, -0.5])
        lower = block("pedestal", element, [-0.125, -0.125, -0.25], [0.125, 0.125, 0.0], per=8)
        return Setup("a cuboid on a pedestal", [upper, lower], scheme, 0.05, contacts=[between("skin", upper, lower)], supports=[hold("pedestal.bottom", dimension=3)])

    def across(scheme, element="Hex8"):
        base = {"element": element, "low": [-0.2] * 3, "high": [0.2] * 3, "cells": [3, 3, 3]}
        upper = block("block", **base, place={"rotate": {"axis": [1.0, 0.0, 0.0], "angle": 45.0}, "shift": [0.0, 0.0, 0.4 / sqrt(2) + 0.005]}, velocity=[0.0, 0.0, -0.5])
        lower = block("base", **base, place={"rotate": {"axis": [0.0, 1.0, 0.0], "angle": 45.0}, "shift": [0.0, 0.0, -0.4 / sqrt(2)]})
        return Setup("edge across an edge", [upper, lower], scheme, 0.05, contacts=[between("skin", upper, lower)], supports=[hold("base.bottom", dimension=3)])

    return [drop, slide, corner, strips, cuboid, across]


def rotation(angle):
    c, s = cos(radians(angle)), sin(radians(angle))
    return lambda x: [c * x[0] - s * x[1], s * x[0] + c * x[1], *x[2:]]


def turned(setup, angle):
    """The same, turned about the z axis: placed, and with turned vectors. All supports hold all directions."""
    turn = rotation(angle)
    for p in setup.parts:
        place = p.keys.get("place", {"shift": [0.0] * setup.dimension})
        if setup.dimension == 2:
            rotate = place.get("rotate", 0.0) + angle
        else:
            inner = place.get("rotate", {"axis": [0.0, 0.0, 1.0], "angle": 0.0})
            columns = ladder_solids.product(ladder_solids.rotation((0, 0, 1), angle), ladder_solids.rotation(inner["axis"], inner["angle"]))
            axis, size = ladder_solids.axis_and_angle(columns)
            rotate = {"axis": list(axis), "angle": size}
        p.keys["place"] = {"rotate": rotate, "shift": turn(place["shift"])}
        for key in ("velocity", "gravity"):
            if key in p.keys:
                p.keys[key] = turn(p.keys[key])
    return setup


def images():
    """Images of a set-up under transformations that do not change the mechanical problem: each must have
    the history of the original."""
    kinds = ["turned by 90", "turned by 37", "mirrored", "far", "order", "units", "small units", "moving"]
    for i in range(56):
        number = i % 7 if i % 7 < 6 else 0
        make, kind = bases()[number], kinds[i // 7]
        scheme = MAIN[(i + i // 7) % 6]
        element = ["Q4", "Q9", "T6"][i % 3] if number < 4 else ["Hex8", "Tet4"][i % 2]
        if kind == "mirrored":
            element = ["Q4", "Q9"][i % 2] if number < 4 else "Hex8"
        if kind == "moving":  # free bodies only
            make, element, number = bases()[3], ["Q4", "Q9", "T6"][i % 3], 3
        original, image = make(scheme, element), make(scheme, element)
        d = image.dimension
        same = {f"block.velocity_{a}": 1.0 for a in AXES[:d]} | {"kinetic": 1.0, "strain": 1.0}
        claim = {"judge": "agree", "columns": same, "limit": 1e-6}
        if kind.startswith("turned"):
            angle = float(kind.split()[-1])
            turned(image, angle)
            claim["turn"] = angle
        elif kind == "mirrored":
            for p in image.parts:
                low, high = p.mesh["min"], p.mesh["max"]
                low[0], high[0] = -high[0], -low[0]
                for key in ("velocity", "gravity"):
                    if key in p.keys:
                        p.keys[key][0] *= -1
                place = p.keys.get("place")
                if place:
                    place["shift"][0] *= -1
                    if d == 2:
                        place["rotate"] *= -1
                    elif place["rotate"]["axis"][0] == 0.0:
                        place["rotate"]["angle"] *= -1
            same["block.velocity_x"] = -1.0
            for c in image.supports:
                c["on"] = [s.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right") for s in c["on"]]
        elif kind == "far":
            for p in image.parts:
                place = p.keys.setdefault("place", {"shift": [0.0] * d})
                place["shift"] = [x + y for x, y in zip(place["shift"], [128.0, -64.0, 32.0])]
        elif kind == "order":
            image.parts.reverse()
        elif kind.endswith("units"):
            length, mass, time = (1e3, 1e6, 1e3) if kind == "units" else (1e-6, 1e-6, 1e-3)
            scale(image, length, mass, time)
            for key in same:
                same[key] *= length / time if "velocity" in key else mass * (length / time) ** 2
        elif kind == "moving":
            for p in image.parts:
                p.keys["velocity"] = [x + y for x, y in zip(p.keys.get("velocity", [0.0] * d), [3.0, 1.0])]
            claim["offset"] = {"block.velocity_x": 3.0, "block.velocity_y": 1.0}
            del same["kinetic"]
        for s in (original, image):
            s.tolerance = 1e-11
            s.claims = [TOUCHES]
        image.what += f", {kind}"
        image.claims.append(claim)
        image.twin = original
        yield image


def scale(setup, length, mass, time):
    """In other units: numbers of lengths, masses and times are multiplied by these factors."""
    times = lambda x, f: [times(y, f) for y in x] if isinstance(x, list) else x * f
    step, n = setup.times()
    for p in setup.parts:
        for key in ("min", "max", "radius", "center", "size"):
            if key in p.mesh:
                p.mesh[key] = times(p.mesh[key], length)
        if "place" in p.keys:
            p.keys["place"]["shift"] = times(p.keys["place"]["shift"], length)
        for key, power in (("velocity", 1), ("gravity", 2)):
            if key in p.keys:
                p.keys[key] = times(p.keys[key], length / time**power)
        d = setup.dimension
        # In the plane the thickness is 1 in both units, so that its mass is one per length.
        volume = length**d
        p.density *= mass / volume
        p.young *= mass / (length ** (d - 2) * time**2)
        p.h *= length
    setup.step, setup.end = step * time, n * step * time
    return setup
