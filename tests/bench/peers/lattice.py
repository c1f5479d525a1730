"""Meshes: lattices of cells bent into shape, as tets or bricks (triangles or quadrangles in the
plane), of first or second order; meshes that corot refines; forces on nodes.

Nodes of an element stand in the order of gmsh, which is that of VTK but for the edges of bricks and
the last two of ten-node tets."""
import itertools

import numpy as np

CORNERS = {2: [(0, 0), (1, 0), (1, 1), (0, 1)],
           3: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
               (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]}
EDGES = {"tri": [(0, 1), (1, 2), (0, 2)],
         "tet": [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)],
         "quad": [(0, 1), (1, 2), (2, 3), (0, 3)],
         "hex": [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7),
                 (4, 5), (4, 7), (5, 6), (6, 7)]}
FACES = {"tri": [(0, 1), (1, 2), (0, 2)],
         "tet": [(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)],
         "quad": [(0, 1), (1, 2), (2, 3), (3, 0)],
         "hex": [(0, 3, 2, 1), (0, 1, 5, 4), (0, 4, 7, 3), (1, 2, 6, 5), (2, 3, 7, 6),
                 (4, 5, 6, 7)]}
SIDE_KIND = {"tet": "tri", "hex": "quad", "tri": "line", "quad": "line"}
GMSH = {("line", 2): 1, ("line", 3): 8, ("tri", 3): 2, ("tri", 6): 9, ("quad", 4): 3,
        ("quad", 9): 10, ("tet", 4): 4, ("tet", 10): 11, ("hex", 8): 5, ("hex", 27): 12}
SIDES = ["s0", "s1", "t0", "t1", "w0", "w1"]


class Mesh:
    """x [n][3], cells [m][nodes], kind; sides: faces by name, as nodes of an element of theirs;
    nodes: sets of nodes by name, those of the sides among them."""

    def __init__(self, kind, x, cells, sides, nodes=None):
        self.kind, self.x, self.cells, self.sides = kind, x, cells, sides
        self.nodes = {name: np.unique(face) for name, face in sides.items()}
        self.nodes.update(nodes or {}, all=np.arange(len(x)))

    def nearest(self, point):
        return int(np.argmin(((self.x - np.asarray(point)) ** 2).sum(axis=1)))


def paths(dim, cells):
    """Corners of tets or triangles in steps of a cell, each cell the mirror image of its
    neighbours: [n][dim + 1][dim]."""
    cell = np.array(list(itertools.product(*map(range, cells))))
    odd = cell % 2
    out = []
    for path in itertools.permutations(range(dim)):
        corner = [cell + odd]
        for axis in path:
            step = np.zeros_like(cell)
            step[:, axis] = 1 - 2 * odd[:, axis]
            corner.append(corner[-1] + step)
        corner = np.stack(corner, axis=1)
        swaps = sum(a > b for a, b in itertools.combinations(path, 2))
        flip = (swaps + odd.sum(axis=1)) % 2 == 1
        corner[flip] = corner[flip][:, [0, 2, 1] + list(range(3, dim + 1))]
        out.append(corner)
    return np.concatenate(out)


def bricks(dim, cells):
    cell = np.array(list(itertools.product(*map(range, cells))))
    return cell[:, None, :] + np.array(CORNERS[dim])[None, :, :]


def with_middles(corner, kind):
    """Corners in half steps, and after them the nodes of second order."""
    parts = [2 * corner]
    parts.append(np.stack([corner[:, a] + corner[:, b] for a, b in EDGES[kind]], axis=1))
    if kind == "hex":
        parts.append(np.stack([corner[:, f].sum(axis=1) // 2 for f in map(list, FACES[kind])],
                              axis=1))
    if kind in ("hex", "quad"):
        parts.append(corner.sum(axis=1, keepdims=True) * 2 // corner.shape[1])
    return np.concatenate(parts, axis=1)


def faces_of(corner, kind, order):
    """The faces of all elements as [n][nodes][dim] of the lattice."""
    for face in FACES[kind]:
        part = corner[:, list(face)]
        if order == 1:
            yield part
        elif SIDE_KIND[kind] == "line":
            yield np.concatenate([2 * part, part.sum(axis=1, keepdims=True)], axis=1)
        else:
            yield with_middles(part, SIDE_KIND[kind])


def ticks(count, order, grade):
    """Where the nodes of an axis are in [0, 1]: corners by `grade`, others halfway between."""
    corner = grade(np.arange(count + 1) / count)
    return np.interp(np.arange(order * count + 1) / order, np.arange(count + 1), corner)


def lattice(cells, shape, order, kind, grades={}):
    """The lattice of [0, 1]^dim under `shape`, which takes and gives arrays of three coordinates,
    closer where `grades` of some axes (0, 1, 2) say so. A plane mesh is that of the side w = 0."""
    dim = len(cells)
    corner = (paths if kind in ("tet", "tri") else bricks)(dim, cells)
    count = [order * c + 1 for c in cells]
    flat = lambda p: np.ravel_multi_index(np.moveaxis(p, -1, 0), count)
    sides = {name: [] for name in SIDES[:2 * dim]}
    for face in faces_of(corner, kind, order):
        for axis, (at, name) in itertools.product(range(dim), ((0, 0), (1, 1))):
            there = (face[:, :, axis] == at * (count[axis] - 1)).all(axis=1)
            sides[SIDES[2 * axis + name]].append(flat(face[there]))
    at = [ticks(c, order, grades.get(axis, lambda v: v)) for axis, c in enumerate(cells)]
    grid = [at[axis][k] for axis, k in enumerate(np.indices(count).reshape(dim, -1))]
    x = np.stack(shape(*grid, *[0 * grid[0]] * (3 - dim)), axis=1)
    cell = flat(corner if order == 1 else with_middles(corner, kind))
    return Mesh(kind, x, cell, {k: np.concatenate(v) for k, v in sides.items()})


def read(path):
    """A tet mesh of gmsh 2.2, its groups of triangles."""
    with open(path) as file:
        lines = file.read().split("\n")
    names = {}
    if "$PhysicalNames" in lines:
        at = lines.index("$PhysicalNames") + 1
        for line in lines[at + 1:at + 1 + int(lines[at])]:
            dim, number, name = line.split()
            names[dim, number] = name.strip('"')
    at = lines.index("$Nodes") + 1
    x = np.array([line.split()[1:] for line in lines[at + 1:at + 1 + int(lines[at])]], float)
    at = lines.index("$Elements") + 1
    cells, sides = [], {}
    for line in lines[at + 1:at + 1 + int(lines[at])]:
        row = line.split()
        nodes = [int(n) - 1 for n in row[3 + int(row[2]):]]
        if row[1] in ("4", "11"):
            cells.append(nodes)
        elif row[1] in ("2", "9"):
            sides.setdefault(names["2", row[3]], []).append(nodes)
    return Mesh("tet", x, np.array(cells), {k: np.array(v) for k, v in sides.items()})


def write(mesh, path):
    """gmsh 2.2; the sides are physical groups 1, 2, ... by their order."""
    dim = 2 if mesh.kind in ("tri", "quad") else 3
    rows = []
    for k, face in enumerate(mesh.sides.values()):
        kind = GMSH[SIDE_KIND[mesh.kind], face.shape[1]]
        rows += [f"{kind} 2 {k + 1} {k + 1} " + " ".join(map(str, f + 1)) for f in face]
    body, kind = len(mesh.sides) + 1, GMSH[mesh.kind, mesh.cells.shape[1]]
    rows += [f"{kind} 2 {body} {body} " + " ".join(map(str, c + 1)) for c in mesh.cells]
    with open(path, "w") as out:
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", body, sep="\n", file=out)
        for k, name in enumerate(mesh.sides):
            print(dim - 1, k + 1, f'"{name}"', file=out)
        print(dim, body, '"body"', file=out)
        print("$EndPhysicalNames\n$Nodes", len(mesh.x), sep="\n", file=out)
        for k, p in enumerate(mesh.x):
            print(k + 1, *("%.16g" % (c + 0.0) for c in p), file=out)
        print("$EndNodes\n$Elements", len(rows), sep="\n", file=out)
        for k, row in enumerate(rows):
            print(k + 1, row, file=out)
        print("$EndElements", file=out)


# --- Forces on nodes ---

def triangle_shapes(n):
    """Shape functions and their two derivatives at points of degree 4, and weights."""
    a, b = 0.445948490915965, 0.091576213509771
    points = [(a, a), (1 - 2 * a, a), (a, 1 - 2 * a), (b, b), (1 - 2 * b, b), (b, 1 - 2 * b)]
    for (r, s), w in zip(points, [0.223381589678011 / 2] * 3 + [0.109951743655322 / 2] * 3):
        l, d = np.array([1 - r - s, r, s]), np.array([[-1, -1], [1, 0], [0, 1]])
        if n == 3:
            yield w, l, d
            continue
        N = list(l * (2 * l - 1)) + [4 * l[i] * l[j] for i, j in EDGES["tri"]]
        D = [(4 * l[i] - 1) * d[i] for i in range(3)]
        D += [4 * (l[i] * d[j] + l[j] * d[i]) for i, j in EDGES["tri"]]
        yield w, np.array(N), np.array(D)


def quadrangle_shapes(n):
    """The same of 4, 8 (serendipity) or 9 nodes, in the order of gmsh."""
    at = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)])
    terms = {4: [(0, 0), (1, 0), (0, 1), (1, 1)],
             8: [(i, j) for i in range(3) for j in range(3) if i + j < 4],
             9: [(i, j) for i in range(3) for j in range(3)]}[n]
    basis = lambda r, s: np.array([r ** i * s ** j for i, j in terms])
    less = lambda i: max(i - 1, 0)
    slope = lambda r, s: np.array([[i * r ** less(i) * s ** j, j * r ** i * s ** less(j)]
                                   for i, j in terms])
    solve = np.linalg.inv(np.array([basis(r, s) for r, s in at[:n].astype(float)])).T
    for (r, v), (s, w) in itertools.product(zip(*np.polynomial.legendre.leggauss(3)), repeat=2):
        yield v * w, solve @ basis(r, s), solve @ slope(r, s)


def traction(mesh, side, vector):
    """The forces on all nodes that a uniform traction on a side comes to."""
    face = mesh.sides[side]
    force, n = np.zeros_like(mesh.x), face.shape[1]
    shapes = triangle_shapes if SIDE_KIND[mesh.kind] == "tri" else quadrangle_shapes
    for weight, N, D in shapes(n):
        a, b = (np.einsum("fni,n->fi", mesh.x[face], D[:, k]) for k in range(2))
        area = np.linalg.norm(np.cross(a, b), axis=1)
        np.add.at(force, face, weight * area[:, None, None] * N[None, :, None] * np.asarray(vector))
    return force


def serendipity(mesh):
    """A mesh of bricks of 27 nodes without those inside faces and cells."""
    used = np.unique(mesh.cells[:, :20])
    number = np.full(len(mesh.x), -1)
    number[used] = np.arange(len(used))
    sides = {k: number[f[:, :8]] for k, f in mesh.sides.items()}
    nodes = {k: number[n][number[n] >= 0] for k, n in mesh.nodes.items() if k not in sides}
    return Mesh("hex", mesh.x[used], number[mesh.cells[:, :20]], sides, nodes)
