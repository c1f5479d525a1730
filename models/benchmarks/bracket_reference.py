#!/usr/bin/env python3
"""The answer that the bracket of README.md is held to: ten-node tets on graded meshes, extrapolated.

    models/benchmarks/bracket_reference.py [-o FOLDER]     needs gmsh; some minutes

Three meshes of bracket_graded.geo; two coarser ones and these cut into eight; then, where ccx is installed, the
same linear problem (strain: cauchy) by CalculiX's C3D10, whose forces are those of the traction on
straight faces: a third of a face's on each node of its edges."""
import argparse
import math
import os
import shutil
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
COROT = os.environ.get("COROT", os.path.join(ROOT, "build/release/src/main/corot"))
sys.path.insert(0, os.path.join(ROOT, "tests/references"))
import ccx  # noqa: E402

SIZES, CUT = [0.7, 0.5, 0.35], [1.2, 1.0]
TRACTION = -1.25e6


def make_mesh(folder, size):
    path = os.path.join(folder, f"s{size}.msh")
    subprocess.run(["gmsh", "-3", "-order", "2", "-format", "msh22", "-setnumber", "s", str(size),
                    "-o", path, os.path.join(HERE, "bracket_graded.geo")],
                   check=True, stdout=subprocess.DEVNULL)
    return path


def deflection(folder, mesh, *settings):
    """u_z of the end [m]."""
    out = os.path.join(folder, "run")
    shutil.rmtree(out, ignore_errors=True)
    command = [COROT, "static", os.path.join(HERE, "bracket.yaml"), "-o", out, "--quiet"]
    for key in (f"mesh.file={mesh}",) + settings:
        command += ["--set", key]
    subprocess.run(command, check=True)
    with open(os.path.join(out, "probes.csv")) as file:
        rows = file.read().split()
    return float(dict(zip(rows[0].split(","), rows[-1].split(",")))["end.uz"])


def extrapolate(sizes, values):
    """Limit and order p of values = limit + C size^p."""
    def ratio(p):
        a, b, c = (s ** p for s in sizes)
        return (a - b) / (b - c)
    measured = (values[0] - values[1]) / (values[1] - values[2])
    low, high = 0.5, 8.0
    for _ in range(60):
        p = 0.5 * (low + high)
        low, high = (p, high) if ratio(p) < measured else (low, p)
    a, b = sizes[1] ** p, sizes[2] ** p
    return values[2] + (values[2] - values[1]) * b / (a - b), p


def common_limit(first, second):
    """Where the errors of two pairs of values shrink by one factor, and the order that is."""
    (a, b), (c, d) = first, second
    limit = (b * c - a * d) / (b + c - a - d)
    return limit, math.log2((limit - a) / (limit - b))


def end_forces(path, x):
    """The traction on the nodes of the end's faces."""
    with open(path) as file:
        lines = file.read().split("\n")
    at = lines.index("$Nodes") + 1
    number = {row.split()[0]: k for k, row in enumerate(lines[at + 1:at + 1 + int(lines[at])])}
    at = lines.index("$PhysicalNames") + 1
    tag = [row.split()[1] for row in lines[at + 1:at + 1 + int(lines[at])] if '"end"' in row][0]
    at, force = lines.index("$Elements") + 1, {}
    for row in map(str.split, lines[at + 1:at + 1 + int(lines[at])]):
        if row[1] != "9" or row[3] != tag:
            continue
        n = [number[k] for k in row[3 + int(row[2]):]]
        a, b = ([q - p for p, q in zip(x[n[0]], x[k])] for k in n[1:3])
        normal = [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]
        for k in n[3:]:
            force[k] = force.get(k, 0) + TRACTION * 0.5 * math.hypot(*normal) / 3
    return force


def calculix(folder, path):
    x, tets = ccx.read_mesh(path)
    end = ccx.nearest(x, (0.08, 0, 0))
    lines = ["*NODE, NSET=ALL"] + ["%d, %.13E, %.13E, %.13E" % (n + 1, *p) for n, p in enumerate(x)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=BODY"]
    lines += [", ".join(str(n) for n in [k + 1] + [n + 1 for n in t]) for k, t in enumerate(tets)]
    lines += ["*BOUNDARY"] + ["%d, 1, 3" % (n + 1) for n, p in enumerate(x) if p[2] > 0.1 - 1e-9]
    lines += ["*NSET, NSET=E", str(end + 1), "*MATERIAL, NAME=M", "*ELASTIC", "2.1E11, 0.3",
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M", "*STEP", "*STATIC", "*CLOAD"]
    lines += ["%d, 3, %.13E" % (n + 1, f) for n, f in end_forces(path, x).items()]
    lines += ["*NODE PRINT, NSET=E", "U", "*END STEP", ""]
    base = os.path.join(folder, "ccx")
    with open(base + ".inp", "w") as file:
        file.write("\n".join(lines))
    subprocess.run(["ccx", "-i", "ccx"], cwd=folder, stdout=subprocess.DEVNULL, check=True)
    with open(base + ".dat") as file:
        return float(file.read().split()[-1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("-o", dest="folder", default=os.path.join(ROOT, "out/bracket"))
    folder = os.path.abspath(parser.parse_args().folder)
    os.makedirs(folder, exist_ok=True)
    meshes = [make_mesh(folder, size) for size in SIZES]
    values = [deflection(folder, mesh) for mesh in meshes]
    for size, value in zip(SIZES, values):
        print(f"s = {size}: {1e3 * value:.6f} mm", flush=True)
    limit, order = extrapolate(SIZES, values)
    print(f"order {order:.2f}, extrapolated {1e3 * limit:.4f} mm", flush=True)
    pairs = []
    for size in CUT:
        mesh = make_mesh(folder, size)
        pairs.append([deflection(folder, mesh, f"mesh.refine={k}") for k in range(2)])
        print(f"s = {size}: {1e3 * pairs[-1][0]:.6f} mm, cut into eight {1e3 * pairs[-1][1]:.6f} mm",
              flush=True)
    limit, order = common_limit(*pairs)
    print(f"order {order:.2f}, extrapolated {1e3 * limit:.4f} mm", flush=True)
    if shutil.which("ccx"):
        linear = deflection(folder, meshes[1], "strain=cauchy")
        print(f"s = {SIZES[1]}, linear: {1e3 * linear:.6f} mm, CalculiX "
              f"{1e3 * calculix(folder, meshes[1]):.6f} mm")


main()
