"""CalculiX: solids as its manual advises, *STEP, NLGEOM with automatic increments, *DYNAMIC with a
constant step and its own damping; one writer of decks."""
import os
import re
import shutil

import numpy as np

import lattice

# Of gmsh's bricks of 20 nodes, and of its ten-node tets, in the order of CalculiX.
BRICK = list(range(8)) + [8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15]
ORDER = {("tet", 4): list(range(4)), ("tet", 10): list(range(8)) + [9, 8],
         ("hex", 8): list(range(8)), ("hex", 20): BRICK}
ELEMENTS = {"C3D10": ("tet", 2), "C3D20R": ("hex", 2), "C3D20": ("hex", 2), "C3D8I": ("hex", 1)}


def found():
    return shutil.which("ccx") is not None


def rows(problem):
    """What is measured. Where one brick fills the section, C3D20R has modes without energy: C3D20
    there. By default an increment ends at a residual of 0.5 %, which may be 0.2 % of a
    displacement; 1e-4 costs a tenth more."""
    solid = "file" not in problem
    for kind in ["C3D10"] + ["C3D20R", "C3D8I"] * solid:
        for mesh in problem["coarse" if kind == "C3D8I" else "cells" if solid else "refine"]:
            thin = solid and not problem.get("plane") and sorted(mesh)[1] == 1
            of = "C3D20" if kind == "C3D20R" and thin else kind
            for step in problem.get("steps", [None]):
                residual = None if step or problem.get("linear") else 1e-4
                yield of, mesh, dict(kind=of, step=step, residual=residual)


def element(setting):
    return ELEMENTS[setting["kind"]]


def name(setting):
    return (setting["kind"] + (f", step {setting['step']:g} s" if setting["step"] else "")
            + (f", residual {setting['residual']:g}" if setting["residual"] else ""))


def nodes_in_rows(numbers):
    numbers = [str(n + 1) for n in numbers]
    return [", ".join(numbers[k:k + 12]) + "," * (k + 12 < len(numbers))
            for k in range(0, len(numbers), 12)]


def boundary(mesh, problem):
    lines, held = ["*BOUNDARY"], set()
    for side, axes in problem["hold"]:
        for c in sorted("xyz".index(a) for a in axes):
            for n in mesh.nodes[side]:
                if (n, c) not in held:
                    held.add((n, c))
                    lines.append(f"{n + 1}, {c + 1}, {c + 1}")
    return lines if held else []


def step(mesh, problem, setting):
    """One step: its kind, what moves and loads, what is printed."""
    linear = problem.get("linear")
    lines = ["*STEP" + ("" if linear else ", NLGEOM, INC=100000")]
    if "end" in problem:
        h, end = setting["step"], problem["end"]
        lines += ["*DYNAMIC, DIRECT" if setting.get("direct") else "*DYNAMIC",
                  f"{h:g}, {end:g}, 1e-9, {h:g}"]
    else:
        lines += ["*STATIC"] + ([] if linear else [f"{problem['increment']:g}, 1., 1e-6, 1."])
    if setting["residual"]:
        lines += ["*CONTROLS, PARAMETERS=FIELD",
                  "%g, 1e-2, 0.01, , 0.02, 1e-5, 1e-3, 1e-8" % setting["residual"]]
    if "move" in problem:
        side, vector = problem["move"]
        lines.append("*BOUNDARY")
        lines += [f"{n + 1}, {c + 1}, {c + 1}, {v:.13e}" for n in mesh.nodes[side]
                  for c, v in enumerate(vector)]
    amplitude = ", AMPLITUDE=RISE" if "end" in problem else ""
    force = sum((lattice.traction(mesh, g, v) for g, v in problem.get("tractions", [])),
                np.zeros_like(mesh.x))
    if force.any():
        lines.append("*CLOAD" + amplitude)
        lines += [f"{n + 1}, {c + 1}, {force[n, c]:.13e}" for n, c in zip(*np.nonzero(force))]
    if "gravity" in problem:
        g = np.array(problem["gravity"])
        size = np.linalg.norm(g)
        lines += ["*DLOAD" + amplitude, "BODY, GRAV, %.13e, %g, %g, %g" % (size, *(g / size))]
    output = {"reaction": ["*NODE PRINT, NSET=PROBE, TOTALS=ONLY", "RF"],
              "stress": ["*EL FILE", "S"]}
    lines += output.get(problem["take"], ["*NODE PRINT, NSET=PROBE", "U"])
    return lines + ["*END STEP"]


def deck(mesh, problem, setting):
    lam, mu = problem["lame"]
    lines = ["*NODE, NSET=ALL"]
    lines += ["%d, %.13e, %.13e, %.13e" % (n + 1, *p) for n, p in enumerate(mesh.x)]
    lines.append(f"*ELEMENT, TYPE={setting['kind']}, ELSET=BODY")
    for k, cell in enumerate(mesh.cells[:, ORDER[mesh.kind, mesh.cells.shape[1]]]):
        row = [str(k + 1)] + [str(n + 1) for n in cell]
        lines += [", ".join(row[:12]) + ("," if len(row) > 12 else "")]
        lines += [", ".join(row[12:])] if len(row) > 12 else []
    probe = mesh.nodes[problem["side"]] if "side" in problem else [mesh.nearest(problem["point"])]
    lines += ["*NSET, NSET=PROBE"] + nodes_in_rows(probe) + boundary(mesh, problem)
    lines += ["*MATERIAL, NAME=M", "*ELASTIC",
              "%.13e, %.13e" % (mu * (3 * lam + 2 * mu) / (lam + mu), lam / 2 / (lam + mu)),
              "*DENSITY", "%.13e" % problem["density"],
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M"]
    if "spin" in problem:
        rate, center = problem["spin"]
        lines.append("*INITIAL CONDITIONS, TYPE=VELOCITY")
        for n, p in enumerate(mesh.x):
            lines += [f"{n + 1}, 1, {-rate * (p[1] - center[1]):.13e}",
                      f"{n + 1}, 2, {rate * (p[0] - center[0]):.13e}"]
    if "end" in problem:
        rise, end = problem.get("rise", 0), 10 * problem["end"]
        first = f"0., 0., {rise:g}, 1., " if rise else "0., 1., "
        lines += ["*AMPLITUDE, NAME=RISE", first + f"{end:g}, 1."]
    return "\n".join(lines + step(mesh, problem, setting)) + "\n"


def prepare(folder, problem, mesh, setting):
    if mesh.kind == "hex" and setting["kind"].startswith("C3D20"):
        mesh = lattice.serendipity(mesh)
    with open(os.path.join(folder, "body.inp"), "w") as file:
        file.write(deck(mesh, problem, setting))
    problem["probe_node"] = None if "side" in problem else mesh.nearest(problem["point"])
    return ["ccx", "-i", "body"]


def stress(path, node, component):
    """Of the last block of stresses of a .frd file: extrapolated to the nodes and averaged."""
    column = ["xx", "yy", "zz", "xy", "yz", "zx"].index(component)
    with open(path) as file:
        block = file.read().rsplit("-4  STRESS", 1)[1]
    for line in block.split("\n"):
        if line.startswith(" -1") and int(line[3:13]) == node + 1:
            return float(line[13 + 12 * column:25 + 12 * column])
    raise ValueError(f"{path}: no stress of node {node + 1}")


def answer(folder, problem):
    column = "xyz".find(problem["component"])
    if problem["take"] == "stress":
        return stress(os.path.join(folder, "body.frd"), problem["probe_node"],
                      problem["component"])
    with open(os.path.join(folder, "body.dat")) as file:
        blocks = re.split(r"and time +(\S+)", file.read())
    times = [float(t) for t in blocks[1::2]]
    if not times or times[-1] < problem.get("end", 1.0) * (1 - 1e-6):
        raise ValueError(f"ccx stopped at {times[-1] if times else 0:g}")
    skip = 0 if problem["take"] == "reaction" else 1
    values = [float(b.split()[skip + column]) for b in blocks[2::2]]
    return {"max": max, "min": min}.get(problem["take"], lambda v: v[-1])(values)
