#!/usr/bin/python3
"""Whether VTK reads the same from the fields of two folders, to the last bit.

usage: same_fields.py FOLDER OTHER
"""
import os
import sys

from vtu import arrays, expect, frames_of, read, rest
from vtkmodules.util.numpy_support import vtk_to_numpy


def everything(path):
    grid = read(path)
    cells = grid.GetCells()
    found = {"points": rest(grid), "types": vtk_to_numpy(grid.GetCellTypesArray()),
             "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
             "offsets": vtk_to_numpy(cells.GetOffsetsArray())}
    for data in (grid.GetFieldData(), grid.GetPointData(), grid.GetCellData()):
        found.update(arrays(data))
    return found


def main():
    one, other = frames_of(sys.argv[1]), frames_of(sys.argv[2])
    expect([t for _, t in one] == [t for _, t in other], "frames of other times")
    for (path, _), (packed, _) in zip(one, other):
        a, b = everything(path), everything(packed)
        expect(list(a) == list(b) and len(a) >= 11, f"{packed}: {sorted(b)}")
        for name, array in a.items():
            expect(array.dtype == b[name].dtype and array.tobytes() == b[name].tobytes(),
                   f"{packed}: {name} differs")
        expect(os.path.getsize(packed) < os.path.getsize(path), f"{packed} is no smaller")


main()
