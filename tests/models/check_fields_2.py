#!/usr/bin/python3
"""Reads the folder of a run with ten-node tets the way ParaView would, and checks the fields by VTK's
own shape functions: the numbering of nodes, and of the points of integration.

usage: check_fields_2.py RUN_FOLDER

The run must use the polar measure with exact frames and one material. Exits with 77 where VTK is not
installed.
"""
import json
import sys
import xml.etree.ElementTree as xml

try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import VTK_QUADRATIC_TETRA, vtkQuadraticTetra
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

A, B = (5 + 3 * 5 ** 0.5) / 20, (5 - 5 ** 0.5) / 20
ORDER = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]


def expect(condition, message):
    if not condition:
        sys.exit(f"failed: {message}")


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.SetFileName(path)
    reader.Update()
    expect(not errors, f"{path}: VTK reports errors")
    return reader.GetOutput()


def arrays(attributes):
    return {attributes.GetArrayName(i): vtk_to_numpy(attributes.GetArray(i))
            for i in range(attributes.GetNumberOfArrays())}


def slopes(corner):
    """[10][3] of VTK's shape functions at the point next to a corner, by the last three of its
    barycentric coordinates."""
    at, flat = [A if k == corner else B for k in range(1, 4)], [0.0] * 30
    vtkQuadraticTetra().InterpolateDerivs(at, flat)
    return np.array(flat).reshape(3, 10).T


def polar(F):
    """The rotation nearest to each F."""
    U, _, Vt = np.linalg.svd(F)
    return U @ Vt


def von_mises(F, R, e, material):
    trace = np.trace(e, axis1=1, axis2=2)[:, None, None]
    P = R @ (material["lambda"] * trace * np.eye(3) + 2 * material["mu"] * e)
    sigma = P @ F.transpose(0, 2, 1) / np.linalg.det(F)[:, None, None]
    s = sigma - np.trace(sigma, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
    return np.sqrt(1.5 * (s * s).sum(axis=(1, 2)))


def same(path, name, found, expected, size=1.0):
    # Rounding: F is a quotient of differences of positions, some 1e3 roundings at a small angle.
    off = np.abs(found - expected).max()
    expect(off < 1e-11 * size, f"{path}: {name} is off by {off:.3g}")


def check_file(path, material):
    grid = read(path)
    point, cell = arrays(grid.GetPointData()), arrays(grid.GetCellData())
    expect(set(point) == {"displacement", "velocity"}, f"{path}: point data {sorted(point)}")
    fields = ["frame", "strain", "von_mises", "det"]
    expect(set(cell) == {*fields, *(f + "_points" for f in fields), "material"},
           f"{path}: cell data {sorted(cell)}")
    expect((vtk_to_numpy(grid.GetCellTypesArray()) == VTK_QUADRATIC_TETRA).all(),
           f"{path}: not all are quadratic tets")
    tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 10)
    rest, u, n = vtk_to_numpy(grid.GetPoints().GetData()), point["displacement"], len(tets)

    mean, weight = {name: 0.0 for name in fields}, 0.0
    for k in range(4):
        J = np.einsum("eai,aj->eij", rest[tets], slopes(k))
        w = np.linalg.det(J)
        expect((w > 0).all(), f"{path}: a tet is turned inside out at rest")
        F = np.eye(3) + np.einsum("eai,aj->eij", u[tets], slopes(k)) @ np.linalg.inv(J)
        R = polar(F)
        e = np.transpose(R, (0, 2, 1)) @ F
        e = (e + np.transpose(e, (0, 2, 1))) / 2 - np.eye(3)
        mises = von_mises(F, R, e, material)
        values = {"frame": R.reshape(n, 9), "von_mises": mises, "det": np.linalg.det(F),
                  "strain": np.stack([e[:, i, j] for i, j in ORDER], axis=1)}
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
    entries = xml.parse(f"{folder}/fields.pvd").getroot().findall("./Collection/DataSet")
    expect(len(entries) >= 2, f"{len(entries)} frames")
    for entry in entries:
        moved, mises = check_file(f"{folder}/{entry.get('file')}", result["scenario"]["material"])
    expect(moved > 0.05, f"the body has moved by {moved:.3g} m only")
    expect(np.ptp(mises, axis=1).max() > 0.1 * mises.max(), "the stress is constant in all tets")
    print(f"{len(entries)} frames of {len(mises)} ten-node tets")


main()
