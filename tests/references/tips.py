#!/usr/bin/env python3
"""Equilibria by CalculiX, to compare with: writes tests/models/calculix_tips.h.

    tests/references/tips.py [FOLDER]     decks and output of ccx stay in FOLDER (default: ccx)

Needs ccx (Debian: calculix-ccx; the table is by its version 2.20). Each body is clamped at the nodes
of a plane and pulled by one force at each of some points, under which it turns and bends far. It is
solved with four-node tets (C3D4) and with ten-node tets (C3D10, four points), whose mid nodes are
the middles of straight edges or, with the arch, gmsh's.
"""
import os
import sys

import ccx

HERE = os.path.dirname(os.path.abspath(__file__))
# The points are nodes at corners; the last one is where the displacement is read, too.
CASES = [
    {"mesh": "beam", "E": 1e7, "nu": 0.3, "clamped": (0, 0), "force": (0, 20, -30),
     "points": [(1, 0, 0), (1, 0.1, 0), (1, 0, 0.15), (1, 0.1, 0.15)]},
    {"mesh": "plate", "E": 2e7, "nu": 0.25, "clamped": (0, 0), "force": (-9, 6, 80),
     "points": [(0.6, 0, 0), (0.6, 0.4, 0.05)]},
    {"mesh": "block", "E": 1e5, "nu": 0.4, "clamped": (2, 0), "force": (40, -20, 30),
     "points": [(0, 0, 0.5), (0.2, 0, 0.5), (0, 0.3, 0.5), (0.2, 0.3, 0.5)]},
    {"mesh": "arch", "E": 1e6, "nu": 0.35, "clamped": (1, 0), "force": (-9, 15, 4),
     "points": [(0, 0.06, 0), (0, 0.1, 0), (0, 0.06, 0.08), (0, 0.1, 0.08)]},
]


def row(case, order, u):
    points = ", ".join("{%g, %g, %g}" % p for p in case["points"])
    return ('    {"%s", %d, %g, %g, %d, %g, {%g, %g, %g}, %d, {%s},\n'
            "     {%.6e, %.6e, %.6e}},\n"
            % (case["mesh"], order, case["E"], case["nu"], *case["clamped"], *case["force"],
               len(case["points"]), points, *u))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "ccx"
    with open(os.path.join(HERE, "../models/calculix_tips.h"), "w") as out:
        out.write("/* Made by references/tips.py: rows of the table of test_references.c. */\n"
                  "/* clang-format off */\n")
        for case in CASES:
            mesh = ccx.read_mesh(os.path.join(HERE, case["mesh"] + ".msh"))
            for order, make in (1, ccx.lowered), (2, ccx.raised):
                x, tets = make(*mesh)
                u = ccx.solve(folder, "%s-%d" % (case["mesh"], order), x, tets, case)
                tip = u[ccx.nearest(x, case["points"][-1])]
                out.write(row(case, order, tip))
                print(case["mesh"], order, len(x), len(tets), tip)


main()
