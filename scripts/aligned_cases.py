"""Aligned contact cases for ladder.py --aligned: nodes meet corners, edges, axes of symmetry and flats
exactly. `all_cases()` are Setups with a number k = 1, 2, …: a case file as TOML, and what must hold.

Nothing is random, so that a number keeps its case on every machine, as long as families are only added
at the end of FAMILIES.
"""

from copy import deepcopy
from math import sqrt

from aligned_images import images
from aligned_plane import (
    bars, bars_in_line, combs, corners, flights, halves, halves_of_blocks, patches, pedestals, piers, press_fits,
    press_flat, relaxed_rings, rigid_corners, rough_slides, schemes, slides, stacks, table_edges, wheels,
)
from aligned_setup import PLANE, SPACE
from aligned_space import (
    eighths, pads, quarters, space_bars, space_corners, space_edges, space_pedestals, space_press_fits,
    space_rough_slides, space_slides, space_stacks,
)

FAMILIES = {
    "pedestal": pedestals, "piers": piers, "table-edge": table_edges, "half-disc": halves, "half-block": halves_of_blocks, "corner": corners, "slide": slides,
    "rough-slide": rough_slides, "bars-1d": bars_in_line, "bars": bars, "stack": stacks, "wheel": wheels, "press-fit": press_fits,
    "press-flat": lambda: press_flat(PLANE, 2), "patch": lambda: patches(PLANE, 2), "comb": combs, "rigid-corner": rigid_corners, "flight": flights, "rings": relaxed_rings,
    "schemes": schemes, "pad-3d": pads, "pedestal-3d": space_pedestals, "table-edge-3d": space_edges, "slide-3d": space_slides, "rough-slide-3d": space_rough_slides,
    "corner-3d": space_corners, "quarter-3d": quarters, "eighth-3d": eighths, "stack-3d": space_stacks, "bars-3d": space_bars, "press-fit-3d": space_press_fits,
    "press-flat-3d": lambda: press_flat(SPACE, 3), "patch-3d": lambda: patches(SPACE, 3), "image": images,
}  # fmt: skip


def all_cases():
    """All set-ups in the order of their numbers."""
    cases = []
    for name, family in FAMILIES.items():
        for setup in family():
            cases.append(setup)
            for s in (setup, setup.twin):
                if s:
                    s.family, s.number = name, len(cases)
    return deepcopy(cases)


def chosen(count):
    """`count` set-ups, or all, from every family in proportion and at equal distances, at least one of each;
    in an order of which every beginning is such a choice, too."""
    cases = all_cases()
    result, golden = [], (sqrt(5) - 1) / 2
    for name in FAMILIES:
        mine = [c for c in cases if c.family == name]
        n = len(mine) if count is None else min(len(mine), max(1, round(count * len(mine) / len(cases))))
        # Every beginning of a golden sequence is spread out.
        fractions = [j * golden % 1 for j in range(len(mine))]
        ranks = [sorted(fractions).index(f) for f in fractions]
        result += [((j + 0.5) / len(mine), mine[k]) for j, k in enumerate(ranks[:n])]
    return [setup for _, setup in sorted(result, key=lambda pair: pair[0])]
