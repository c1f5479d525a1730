#!/usr/bin/env python3
"""The meshes of the beams: boxes of cells of six tets each, bent into shape.

    models/benchmarks/meshes.py [FINENESS]     writes csm.msh, bend.msh, cook.msh here; default: 1

FINENESS multiplies the numbers of cells. Ten-node tets have all their nodes on the shape, those on
edges too; four-node tets can be given them by mesh.order: 2, on the middles of straight edges.
"""
import itertools
import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)]  # gmsh's order of the nodes on them


def tets_of(cells):
    """Corners of tets as points of a lattice of whole numbers, each cell the mirror image of its
    neighbours."""
    for cell in itertools.product(*map(range, cells)):
        for path in itertools.permutations(range(3)):
            corners, at = [], [c + c % 2 for c in cell]  # even indices, where mirror images meet
            corners.append(tuple(at))
            for axis in path:
                at[axis] += -1 if cell[axis] % 2 else 1
                corners.append(tuple(at))
            swaps = sum(a > b for a, b in itertools.combinations(path, 2)) + sum(cell)
            if swaps % 2:
                corners[1], corners[2] = corners[2], corners[1]
            yield corners


def write(name, order, cells, shape):
    """The cells' lattice on [0, 1]^3 under `shape`."""
    count = [order * c + 1 for c in cells]
    number = {p: k + 1 for k, p in enumerate(itertools.product(*map(range, count)))}
    with open(os.path.join(HERE, name + ".msh"), "w") as out:
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes", len(number), sep="\n", file=out)
        for p, k in number.items():
            x = shape(*(i / (n - 1) for i, n in zip(p, count)))
            print(k, *("%.9g" % (c + 0.0) for c in x), file=out)
        print("$EndNodes\n$Elements", 6 * math.prod(cells), sep="\n", file=out)
        for k, corners in enumerate(tets_of(cells)):
            nodes = [tuple(order * c for c in p) for p in corners]
            if order == 2:
                nodes += [tuple(a + b for a, b in zip(corners[i], corners[j])) for i, j in EDGES]
            print(k + 1, 11 if order == 2 else 4, "2 0 1", *(number[n] for n in nodes), file=out)
        print("$EndElements", file=out)


def csm(s, t, w):
    """A strip of 0.35 x 0.02 m behind a cylinder of radius 0.05 m about (0.2, 0.2)."""
    y = 0.19 + 0.02 * t
    left = 0.2 + math.sqrt(0.05 ** 2 - (y - 0.2) ** 2)
    return left + s * (0.6 - left), y, 0.01 * w


def bend(s, t, w):
    """An eighth of a circle of radius 100, of a section of 1 x 1, that begins along y."""
    radius, angle = 100.5 - t, s * math.pi / 4
    return 100 - radius * math.cos(angle), radius * math.sin(angle), 0.5 - w


def cook(s, t, w):
    """A trapezoid, 48 wide, 44 high at its wall and 16 at its end, which stands higher."""
    return 48 * s, 44 * s + t * (44 - 28 * s), 24 * w


def main():
    f = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    write("csm", 1, (80 * f, 2 * f, f), csm)
    write("bend", 2, (24 * f, 2 * f, f), bend)
    write("cook", 1, (2 * f, 2 * f, f), cook)


main()
