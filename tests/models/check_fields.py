#!/usr/bin/python3
"""Reads a run's folder the way ParaView would and checks the fields against each other.

usage: check_fields.py RUN_FOLDER [SMALLEST_TURN]

The run must use the polar measure with exact frames, so that all fields follow from the
displacement. SMALLEST_TURN [rad]: some frame of the last file has turned at least so far.
Exits with 77 where VTK is not installed.
"""
import csv
import json
import sys
import xml.etree.ElementTree as xml

try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

VTK_TETRA = 10


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
    return {
        attributes.GetArrayName(i): vtk_to_numpy(attributes.GetArray(i))
        for i in range(attributes.GetNumberOfArrays())
    }


def edges(x, tets):
    """[ntet][3][3], one edge a column."""
    return np.stack([x[tets[:, k]] - x[tets[:, 0]] for k in (1, 2, 3)], axis=2)


def polar(F):
    """The rotation nearest to each F, by another way than the one under test."""
    U, _, Vt = np.linalg.svd(F)
    return U @ Vt


def check_file(path, time, materials):
    grid = read(path)
    point, cell = arrays(grid.GetPointData()), arrays(grid.GetCellData())
    stored = arrays(grid.GetFieldData())["TimeValue"][0]
    expect(stored == time, f"{path}: time {stored} in the file, {time} in the list")
    expect(set(point) == {"displacement", "velocity"}, f"{path}: point data {sorted(point)}")
    expect(set(cell) == {"frame", "strain", "von_mises", "det", "material"},
           f"{path}: cell data {sorted(cell)}")
    expect((vtk_to_numpy(grid.GetCellTypesArray()) == VTK_TETRA).all(), f"{path}: not all tets")
    names = [grid.GetCellData().GetArray("strain").GetComponentName(i) for i in range(6)]
    expect(names == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"], f"{path}: strain is {names}")
    expect(grid.GetPointData().GetVectors().GetName() == "displacement", f"{path}: no vectors")
    expect(cell["material"].min() >= 0 and cell["material"].max() < materials,
           f"{path}: material out of range")

    tets = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    rest = vtk_to_numpy(grid.GetPoints().GetData())
    D, d = edges(rest, tets), edges(rest + point["displacement"], tets)
    expect((np.linalg.det(D) > 0).all(), f"{path}: a rest volume is not positive")
    F = d @ np.linalg.inv(D)
    R = cell["frame"].reshape(-1, 3, 3)
    e = np.transpose(R, (0, 2, 1)) @ F
    e = (e + np.transpose(e, (0, 2, 1))) / 2 - np.eye(3)
    order = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
    strain = np.stack([e[:, i, j] for i, j in order], axis=1)
    # Rounding: F is a quotient of differences of positions, some 1e3 roundings from the corner.
    for name, found, expected in (("frame", R, polar(F)), ("strain", cell["strain"], strain),
                                  ("det", cell["det"], np.linalg.det(F))):
        off = np.abs(found - expected).max()
        expect(off < 1e-11, f"{path}: {name} is off by {off:.3g}")
    expect((cell["von_mises"] >= 0).all(), f"{path}: negative von Mises stress")
    turn = np.arccos(np.clip((np.trace(R, axis1=1, axis2=2) - 1) / 2, -1, 1)).max()
    return point["displacement"], cell["von_mises"], turn


def check_von_mises(path, folder, von_mises):
    """Of one material without groups: from the strain by way of the law, as a whole."""
    with open(f"{folder}/result.json", encoding="utf-8") as file:
        material = json.load(file)["scenario"]["material"]
    if not isinstance(material, dict) or "mu" not in material or "lambda" not in material:
        return
    cell = arrays(read(path).GetCellData())
    R = cell["frame"].reshape(-1, 3, 3)
    xx, yy, zz, xy, yz, xz = cell["strain"].T
    e = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    P = R @ (material["lambda"] * np.trace(e, axis1=1, axis2=2)[:, None, None] * np.eye(3)
             + 2 * material["mu"] * e)
    F = R @ (e + np.eye(3))  # R'F is symmetric for the polar factor
    sigma = P @ F.transpose(0, 2, 1) / np.linalg.det(F)[:, None, None]
    s = sigma - np.trace(sigma, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3
    expected = np.sqrt(1.5 * (s * s).sum(axis=(1, 2)))
    off = np.abs(von_mises - expected).max()
    expect(off <= 1e-9 * expected.max(), f"{path}: von Mises stress is off by {off:.3g} Pa")


def main():
    folder = sys.argv[1]
    smallest_turn = float(sys.argv[2]) if len(sys.argv) > 2 else 0.0
    with open(f"{folder}/result.json", encoding="utf-8") as file:
        result = json.load(file)
    with open(f"{folder}/probes.csv", encoding="utf-8", newline="") as file:
        probes = {float(row["t"]): row for row in csv.DictReader(file)}
    material = result["scenario"]["material"]
    materials = len(material) if isinstance(material, list) else 1

    entries = xml.parse(f"{folder}/fields.pvd").getroot().findall("./Collection/DataSet")
    expect(len(entries) >= 2, f"{len(entries)} frames")
    for entry in entries:
        path, time = f"{folder}/{entry.get('file')}", float(entry.get("timestep"))
        displacement, von_mises, turn = check_file(path, time, materials)
        for name, probe in result["probes"].items():
            row = [float(probes[time][f"{name}.u{c}"]) for c in "xyz"]
            expect(row == list(displacement[probe["node"]]),
                   f"{path}: probe {name} is not at its node")
    check_von_mises(path, folder, von_mises)
    expect(time == result["t_reached"], f"the last frame is at {time}")
    expect(turn >= smallest_turn, f"frames have turned by {turn:.3g} rad only")
    print(f"{len(entries)} frames, the last turned by up to {turn:.3g} rad")


main()
