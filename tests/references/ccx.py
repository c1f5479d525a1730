"""Statics by CalculiX: reads a tet mesh of gmsh 2.2, writes a deck, runs ccx, reads displacements.

Nodes are numbered from 0 here, from 1 in decks. Tets of ten nodes have them in the order of
CalculiX (and VTK): the corners, then the edges 01 12 02 03 13 23.
"""
import os
import re
import subprocess

EDGES = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
FROM_GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # gmsh has the last two edges the other way round


def read_mesh(path):
    """Coordinates of the nodes, and the tets of four or ten nodes."""
    with open(path) as file:
        lines = file.read().split("\n")
    at = lines.index("$Nodes") + 1
    rows = [line.split() for line in lines[at + 1:at + 1 + int(lines[at])]]
    number = {row[0]: k for k, row in enumerate(rows)}
    x = [tuple(map(float, row[1:4])) for row in rows]
    at = lines.index("$Elements") + 1
    tets = []
    for line in lines[at + 1:at + 1 + int(lines[at])]:
        row = line.split()
        if row[1] in ("4", "11"):
            nodes = [number[n] for n in row[3 + int(row[2]):]]
            tets.append([nodes[k] for k in FROM_GMSH] if row[1] == "11" else nodes)
    return x, tets


def raised(x, tets):
    """The same mesh with nodes on the middles of its edges, unless it has nodes on edges."""
    if len(tets[0]) == 10:
        return x, tets
    x, middle, out = list(x), {}, []
    for tet in tets:
        nodes = list(tet)
        for i, j in EDGES:
            edge = tuple(sorted((tet[i], tet[j])))
            if edge not in middle:
                middle[edge] = len(x)
                x.append(tuple(0.5 * (a + b) for a, b in zip(x[edge[0]], x[edge[1]])))
            nodes.append(middle[edge])
        out.append(nodes)
    return x, out


def lowered(x, tets):
    """The same mesh without nodes on edges."""
    used = sorted({n for tet in tets for n in tet[:4]})
    number = {n: k for k, n in enumerate(used)}
    return [x[n] for n in used], [[number[n] for n in tet[:4]] for tet in tets]


def nearest(x, point):
    return min(range(len(x)), key=lambda n: sum((a - b) ** 2 for a, b in zip(x[n], point)))


def deck(x, tets, case):
    """Large displacements of a linear elastic material: Green's strain, St. Venant-Kirchhoff.
    Newton's iteration goes on until residual and correction are 1e-9 of what they were."""
    axis, at = case["clamped"]
    lines = ["*NODE, NSET=ALL"]
    lines += ["%d, %.13E, %.13E, %.13E" % (n + 1, *p) for n, p in enumerate(x)]
    lines += ["*ELEMENT, TYPE=C3D%d, ELSET=BODY" % len(tets[0])]
    lines += [", ".join(str(n) for n in [k + 1] + [n + 1 for n in tet])
              for k, tet in enumerate(tets)]
    lines += ["*BOUNDARY"]
    lines += ["%d, 1, 3" % (n + 1) for n, p in enumerate(x) if abs(p[axis] - at) < 1e-6]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", "%.13E, %.13E" % (case["E"], case["nu"]),
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M",
              "*STEP, NLGEOM, INC=1000", "*STATIC", "0.25, 1., 1e-6, 0.25",
              "*CONTROLS, PARAMETERS=FIELD", "1e-9, 1e-9, 0.01, , 0.02, 1e-5, 1e-3, 1e-8",
              "*CLOAD"]
    for point in case["points"]:
        n = nearest(x, point) + 1
        lines += ["%d, %d, %.13E" % (n, c + 1, f) for c, f in enumerate(case["force"]) if f]
    lines += ["*NODE PRINT, NSET=ALL", "U", "*END STEP", ""]
    return "\n".join(lines)


def solve(folder, name, x, tets, case):
    """The displacement of every node, as ccx prints it: seven digits."""
    os.makedirs(folder, exist_ok=True)
    base = os.path.join(folder, name)
    with open(base + ".inp", "w") as file:
        file.write(deck(x, tets, case))
    with open(base + ".log", "w") as log:
        subprocess.run(["ccx", "-i", name], cwd=folder, stdout=log, check=True,
                       env=dict(os.environ, OMP_NUM_THREADS="1"))
    with open(base + ".dat") as file:
        text = file.read()
    blocks = re.split(r" displacements .* and time +(\S+)", text)
    if float(blocks[-2]) != 1:
        raise SystemExit(base + ".log: ccx has not reached the full load")
    u = {}
    for line in blocks[-1].split("\n"):
        row = line.split()
        if len(row) == 4:
            u[int(row[0]) - 1] = tuple(map(float, row[1:]))
    return [u[n] for n in range(len(x))]
