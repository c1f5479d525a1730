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

from vtu import arrays, expect, frames_of, polar, rest, same, strain_in, tets, von_mises
import numpy as np

VTK_TETRA = 10


def edges(x, tets):
    """[ntet][3][3], one edge a column."""
    return np.stack([x[tets[:, k]] - x[tets[:, 0]] for k in (1, 2, 3)], axis=2)


def check_file(path, time, materials):
    fields = ["frame", "strain", "von_mises", "det", "material"]
    grid, point, cell, node = tets(path, VTK_TETRA, 4, fields)
    stored = arrays(grid.GetFieldData())["TimeValue"][0]
    expect(stored == time, f"{path}: time {stored} in the file, {time} in the list")
    names = [grid.GetCellData().GetArray("strain").GetComponentName(i) for i in range(6)]
    expect(names == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"], f"{path}: strain is {names}")
    expect(grid.GetPointData().GetVectors().GetName() == "displacement", f"{path}: no vectors")
    expect(cell["material"].min() >= 0 and cell["material"].max() < materials,
           f"{path}: material out of range")

    x = rest(grid)
    D, d = edges(x, node), edges(x + point["displacement"], node)
    expect((np.linalg.det(D) > 0).all(), f"{path}: a rest volume is not positive")
    F = d @ np.linalg.inv(D)
    R = cell["frame"].reshape(-1, 3, 3)
    e, strain = strain_in(R, F)
    for name, found, expected in (("frame", R, polar(F)), ("strain", cell["strain"], strain),
                                  ("det", cell["det"], np.linalg.det(F))):
        same(path, name, found, expected)
    expect((cell["von_mises"] >= 0).all(), f"{path}: negative von Mises stress")
    turn = np.arccos(np.clip((np.trace(R, axis1=1, axis2=2) - 1) / 2, -1, 1)).max()
    return point["displacement"], cell["von_mises"], turn, (F, R, e)


def check_von_mises(path, material, found, state):
    """Of one material without groups: by way of the law, as a whole."""
    if not isinstance(material, dict) or "mu" not in material or "lambda" not in material:
        return
    expected = von_mises(*state, material)
    off = np.abs(found - expected).max()
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

    files = frames_of(folder)
    for path, time in files:
        displacement, mises, turn, state = check_file(path, time, materials)
        for name, probe in result["probes"].items():
            row = [float(probes[time][f"{name}.u{c}"]) for c in "xyz"]
            expect(row == list(displacement[probe["node"]]),
                   f"{path}: probe {name} is not at its node")
    check_von_mises(path, material, mises, state)
    expect(time == result["t_reached"], f"the last frame is at {time}")
    expect(turn >= smallest_turn, f"frames have turned by {turn:.3g} rad only")
    print(f"{len(files)} frames, the last turned by up to {turn:.3g} rad")


main()
