#!/usr/bin/python3
"""Makes the mesh of the liver: a bent sphere, meshed by gmsh, its nodes moved to better the tets.

    python3 models/liver/mesh.py liver.msh

needs gmsh (Debian, 4.8.4; another version will give another mesh). A point of the surface
is known by that of the unit sphere it came from, (a, b, c): a from back to front (x), b from right
to left (y), c from below upwards (z)."""
import itertools
import math
import os
import random
import subprocess
import sys
import tempfile

TETS = 327
EDGE = 0.0414      # m, asked of gmsh; gives nearly as many
RINGS = 48         # of the surface handed to gmsh
ROUNDS = 150       # of moving nodes
TIP = 0.97         # largest b of a node: the tip is blunt
GROUPS = {     # parts of the surface, by the (a, b, c) of a triangle's middle
    "fixed": lambda a, b, c: a < -0.45 and b < 0.0 and c > -0.1,
    "pushed": lambda a, b, c: b > 0.35 and c > 0.35,
}


def shape(a, b, c):
    """The point of the liver from one of the unit sphere [m]."""
    t = min(max((b + 0.6) / 1.6, 0.0), 1.0)
    left = t * t * (3 - 2 * t)  # 0 in the right lobe, 1 at the tip of the left one
    thick = 1 - 0.62 * left
    front = max(a, 0.0) ** 2
    notch = math.exp(-(((b - 0.25) / 0.22) ** 2))  # between the lobes
    x = 0.108 * (1 - 0.35 * left) * a - 0.03 * notch * front
    z = 0.13 * thick * max(c, 0.0) + 0.065 * thick * min(c, 0.0)  # flattened below
    z += 0.018 * thick * (1 - a * a) * (1 - b * b) * min(c, 0.0) ** 2  # and hollowed
    z += 0.025 * left - 0.045 * front * (1 - left)  # the left lobe rides up, the front edge droops
    return x, 0.15 * b, z


def sphere(b, angle):
    r = math.sqrt(max(1 - b * b, 0.0))
    return r * math.cos(angle), b, r * math.sin(angle)


def parameters(point):
    """The b and the angle of the surface point nearest to this one among those of its y."""
    b = min(max(point[1] / 0.15, -TIP), TIP)
    turn = [2 * math.pi * k / 720 for k in range(720)]
    return b, min(turn, key=lambda angle: math.dist(shape(*sphere(b, angle)), point))


def write_surface(path):
    """The surface in fine triangles (STL)."""
    def point(i, j):
        u, v = math.pi * i / RINGS, math.pi * j / RINGS
        return shape(math.sin(u) * math.cos(v), math.cos(u), math.sin(u) * math.sin(v))

    with open(path, "w", encoding="ascii") as f:
        f.write("solid liver\n")
        for i in range(RINGS):
            for j in range(2 * RINGS):
                p, q, r, s = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
                for triangle in [(p, q, r)] * (i < RINGS - 1) + [(p, r, s)] * (i > 0):
                    f.write("facet normal 0 0 0\nouter loop\n")
                    f.writelines("vertex %.9g %.9g %.9g\n" % x for x in triangle)
                    f.write("endloop\nendfacet\n")
        f.write("endsolid\n")


def gmsh():
    """Nodes and tets, with edges of about EDGE."""
    with tempfile.TemporaryDirectory() as folder:
        write_surface(os.path.join(folder, "liver.stl"))
        with open(os.path.join(folder, "liver.geo"), "w", encoding="ascii") as f:
            f.write(f"""Merge "liver.stl";
ClassifySurfaces{{Pi, 1, 1, Pi}};
CreateGeometry;
Surface Loop(1) = Surface{{:}};
Volume(1) = {{1}};
Physical Volume(1) = {{1}};
Mesh.MeshSizeMin = {EDGE};
Mesh.MeshSizeMax = {EDGE};
Mesh.MeshSizeExtendFromBoundary = 0;
""")
        subprocess.run(["gmsh", "-3", "-algo", "meshadapt", "-algo", "hxt", "-nt", "1",
                        "-format", "msh22", "-o", "liver.msh", "liver.geo"],
                       check=True, cwd=folder, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "liver.msh"), encoding="ascii") as f:
            lines = iter(f.read().splitlines())
    nodes, tets = [], []
    for line in lines:
        if line == "$Nodes":
            nodes = [tuple(map(float, next(lines).split()[1:])) for _ in range(int(next(lines)))]
        if line == "$Elements":
            rows = [list(map(int, next(lines).split())) for _ in range(int(next(lines)))]
            tets = [tuple(i - 1 for i in row[-4:]) for row in rows if row[1] == 4]
    return nodes, tets


def boundary(tets):
    """The faces of one tet only."""
    count = {}
    for a, b, c, d in tets:
        for face in (b, d, c), (a, c, d), (a, d, b), (a, b, c):
            count.setdefault(tuple(sorted(face)), []).append(face)
    return [faces[0] for faces in count.values() if len(faces) == 1]


def minus(p, q):
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def cross(p, q):
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def size(nodes, tet):
    """Six times the volume."""
    a, b, c = (minus(nodes[i], nodes[tet[0]]) for i in tet[1:])
    return sum(p * q for p, q in zip(a, cross(b, c)))


def upright(nodes, tet):
    """The tet with its nodes in the order that gives a positive volume."""
    a, b, c, d = tet
    return (a, b, c, d) if size(nodes, tet) > 0 else (b, a, c, d)


def quality(x):
    """The least sine of the six dihedral angles of a tet; negative where it is turned over."""
    volume = size(x, range(4))
    area = [math.hypot(*cross(minus(x[j], x[i]), minus(x[k], x[i])))
            for i, j, k in ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))]
    if min(area) == 0:
        return -1.0
    return min(volume * math.dist(x[i], x[j]) / (area[k] * area[l])
               for i, j, k, l in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2),
                                  (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)))


def flips(nodes, tets):
    """Every exchange of two tets on a face for three on an edge, or the reverse, with the least
    quality after it: (quality, tets to remove, tets to add)."""
    at = {}
    for t, tet in enumerate(tets):
        for part in itertools.chain(itertools.combinations(tet, 3), itertools.combinations(tet, 2)):
            at.setdefault(frozenset(part), []).append(t)
    for part, old in at.items():
        others = set().union(*(tets[t] for t in old)) - part
        if (len(part), len(old), len(others)) not in ((3, 2, 2), (2, 3, 3)):
            continue
        ring, poles = (part, others) if len(part) == 3 else (others, part)
        if len(part) == 3:
            new = [poles | set(edge) for edge in itertools.combinations(ring, 2)]
        else:
            new = [ring | {pole} for pole in poles]
        new = [upright(nodes, sorted(tet)) for tet in new]
        volume = sum(size(nodes, tets[t]) for t in old) - sum(size(nodes, tet) for tet in new)
        if abs(volume) < 1e-12:  # the new fill what the old filled
            yield min(quality([nodes[i] for i in tet]) for tet in new), old, new


def exactly(nodes, tets, count):
    """So many tets, by the best flips one after the other."""
    while len(tets) != count:
        wanted = 2 if len(tets) > count else 3
        _, old, new = max(flip for flip in flips(nodes, tets) if len(flip[2]) == wanted)
        tets = [tet for t, tet in enumerate(tets) if t not in old] + new
    return tets


def improve(nodes, tets, on_surface):
    """Moves nodes at random, on the surface or within, and keeps what betters the worst tet there."""
    random.seed(1)
    where = {i: parameters(nodes[i]) for i in on_surface}
    for i, at in where.items():
        nodes[i] = shape(*sphere(*at))
    around = [[t for t, tet in enumerate(tets) if i in tet] for i in range(len(nodes))]
    value = [quality([nodes[i] for i in tet]) for tet in tets]
    for step in (0.35 * (1 - k / ROUNDS) + 0.02 for k in range(ROUNDS)):
        for t in sorted(range(len(tets)), key=value.__getitem__)[:len(tets) // 4]:
            for i in tets[t]:
                old, at = nodes[i], where.get(i)
                if at:
                    at = (min(max(at[0] + 0.15 * step * random.gauss(0, 1), -TIP), TIP),
                          at[1] + 0.3 * step * random.gauss(0, 1))
                    nodes[i] = shape(*sphere(*at))
                else:
                    nodes[i] = tuple(x + 0.02 * step * random.gauss(0, 1) for x in old)
                new = [quality([nodes[j] for j in tets[k]]) for k in around[i]]
                if min(new) > min(value[k] for k in around[i]):
                    for k, q in zip(around[i], new):
                        value[k] = q
                    if at:
                        where[i] = at
                else:
                    nodes[i] = old
    return where


def write_mesh(path, nodes, tets, faces, where):
    """gmsh 2.2; the groups as physical surfaces 1, 2, ..., all tets as the one after them."""
    tagged = []
    for face in faces:
        middle = [sum(x) / 3 for x in zip(*(sphere(*where[i]) for i in face))]
        tagged += [(k, face) for k, name in enumerate(GROUPS, 1) if GROUPS[name](*middle)]
    names = [(2, name) for name in GROUPS] + [(3, "liver")]
    with open(path, "w", encoding="ascii") as f:
        f.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(names))
        f.writelines('%d %d "%s"\n' % (dim, k, name) for k, (dim, name) in enumerate(names, 1))
        f.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(nodes))
        f.writelines("%d %.6f %.6f %.6f\n" % (i, *x) for i, x in enumerate(nodes, 1))
        f.write("$EndNodes\n$Elements\n%d\n" % (len(tagged) + len(tets)))
        rows = [(2, k, face) for k, face in tagged] + [(4, len(names), tet) for tet in tets]
        for n, (kind, k, element) in enumerate(rows, 1):
            f.write(f"{n} {kind} 2 {k} {k} " + " ".join(str(i + 1) for i in element) + "\n")
        f.write("$EndElements\n")


def main(path):
    nodes, tets = gmsh()
    tets = exactly(nodes, tets, TETS)
    faces = boundary(tets)
    where = improve(nodes, tets, sorted({i for face in faces for i in face}))
    write_mesh(path, nodes, tets, faces, where)
    print(f"{path}: {len(nodes)} nodes, {len(tets)} tets")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
