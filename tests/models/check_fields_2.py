#!/usr/bin/python3
"""Reads the folder of a run with ten-node tets the way ParaView would, and checks the fields by VTK's
own shape functions: the numbering of nodes, and of the points of integration.

usage: check_fields_2.py RUN_FOLDER

The run must use the polar measure with exact frames and one material. Exits with 77 where VTK is not
installed.
"""
import json
import sys

from vtu import expect, frames_of, polar, rest, same, strain_in, tets, von_mises
import numpy as np
from vtkmodules.vtkCommonDataModel import VTK_QUADRATIC_TETRA, vtkQuadraticTetra

A, B = (5 + 3 * 5 ** 0.5) / 20, (5 - 5 ** 0.5) / 20


def slopes(corner):
    """[10][3] of VTK's shape functions at the point next to a corner, by the last three of its
    barycentric coordinates."""
    at, flat = [A if k == corner else B for k in range(1, 4)], [0.0] * 30
    vtkQuadraticTetra().InterpolateDerivs(at, flat)
    return np.array(flat).reshape(3, 10).T


def check_file(path, material):
    fields = ["frame", "strain", "von_mises", "det"]
    every = [*fields, *(f + "_points" for f in fields), "material"]
    grid, point, cell, node = tets(path, VTK_QUADRATIC_TETRA, 10, every)
    x, u, n = rest(grid), point["displacement"], len(node)

    mean, weight = {name: 0.0 for name in fields}, 0.0
    for k in range(4):
        J = np.einsum("eai,aj->eij", x[node], slopes(k))
        w = np.linalg.det(J)
        expect((w > 0).all(), f"{path}: a tet is turned inside out at rest")
        F = np.eye(3) + np.einsum("eai,aj->eij", u[node], slopes(k)) @ np.linalg.inv(J)
        R = polar(F)
        e, strain = strain_in(R, F)
        mises = von_mises(F, R, e, material)
        values = {"frame": R.reshape(n, 9), "von_mises": mises, "det": np.linalg.det(F),
                  "strain": strain}
        for name in fields:
            size = 1e3 * mises.max() + 1e-9 if name == "von_mises" else 1.0
            stored = cell[name + "_points"].reshape(n, 4, -1)[:, k]
            same(path, f"{name} at point {k}", stored, values[name].reshape(n, -1), size)
            mean[name] = mean[name] + w[:, None] * values[name].reshape(n, -1)
        weight = weight + w
    for name in fields:
        expected = mean[name] / weight[:, None]
        if name == "frame":
            expected = polar(expected.reshape(n, 3, 3)).reshape(n, 9)
        size = 1e3 * mises.max() + 1e-9 if name == "von_mises" else 1.0
        same(path, f"mean {name}", cell[name].reshape(n, -1), expected, size)
    return np.abs(u).max(), cell["von_mises_points"]


def main():
    folder = sys.argv[1]
    with open(f"{folder}/result.json", encoding="utf-8") as file:
        result = json.load(file)
    expect(result["mesh"]["order"] == 2, "the run's mesh is not of order 2")
    files = frames_of(folder)
    for path, _ in files:
        moved, mises = check_file(path, result["scenario"]["material"])
    expect(moved > 0.05, f"the body has moved by {moved:.3g} m only")
    expect(np.ptp(mises, axis=1).max() > 0.1 * mises.max(), "the stress is constant in all tets")
    print(f"{len(files)} frames of {len(mises)} ten-node tets")


main()
