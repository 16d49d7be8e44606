#!/usr/bin/env python3
"""Renumbers a .msh file.

    carom mesh CASE.toml --out MESH.msh; scripts/renumber.py MESH.msh OTHER.msh

Nodes and cells are shuffled, each triangle starts at another corner, and every third one is
clockwise. Reads the files written by `carom mesh` (4.1, text). cases/invariance/renumbered.msh was
made from cases/invariance/strike.toml with element T10 for both bodies.
"""

import random
import sys

# Node order of Gmsh's types 2, 9, 21 (triangles of order 1 to 3): starting at the next corner, and
# with reversed orientation.
NEXT = {2: [1, 2, 0], 9: [1, 2, 0, 4, 5, 3], 21: [1, 2, 0, 5, 6, 7, 8, 3, 4, 9]}
TURNED = {2: [0, 2, 1], 9: [0, 2, 1, 5, 4, 3], 21: [0, 2, 1, 8, 7, 6, 5, 4, 3, 9]}
# Reversed lines, types 1, 8, 26.
REVERSED = {1: [1, 0], 8: [1, 0, 2], 26: [1, 0, 3, 2]}


def main():
    source, target = sys.argv[1:]
    lines = open(source, encoding="utf-8").read().splitlines()
    chance = random.Random(1)
    nodes, elements = lines.index("$Nodes"), lines.index("$Elements")
    out, tags = lines[: nodes + 2], {}

    # Blocks: entity and count, then tags, then positions.
    blocks, at = [], nodes + 2
    while lines[at] != "$EndNodes":
        count = int(lines[at].split()[3])
        blocks.append((lines[at], lines[at + 1 : at + 1 + count], lines[at + 1 + count : at + 1 + 2 * count]))
        at += 1 + 2 * count
    every = [int(tag) for _, own, _ in blocks for tag in own]
    shuffled = chance.sample(every, len(every))
    tags.update(zip(every, shuffled))
    for head, own, positions in blocks:
        order = chance.sample(range(len(own)), len(own))
        out += [head, *(str(tags[int(own[i])]) for i in order), *(positions[i] for i in order)]
    out += ["$EndNodes", "$Elements", lines[elements + 1]]

    # Blocks: entity, type and count, then cells: tag and nodes.
    at = elements + 2
    while lines[at] != "$EndElements":
        kind, count = map(int, lines[at].split()[2:])
        cells = [list(map(int, line.split())) for line in lines[at + 1 : at + 1 + count]]
        out.append(lines[at])
        for k, (tag, *cell) in enumerate(chance.sample(cells, count)):
            if kind in REVERSED:
                cell = [cell[i] for i in REVERSED[kind]] if k % 2 else cell
            else:
                for _ in range(chance.randrange(3)):
                    cell = [cell[i] for i in NEXT[kind]]
                cell = [cell[i] for i in TURNED[kind]] if k % 3 == 0 else cell
            out.append(" ".join(map(str, [tag, *(tags[node] for node in cell)])))
        at += 1 + count
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join([*out, "$EndElements"]) + "\n")


if __name__ == "__main__":
    main()
