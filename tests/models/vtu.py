"""The fields of a run as VTK reads them, and what its frames, strains and stresses should be.

Exits with 77 where VTK is not installed."""
import sys
import xml.etree.ElementTree as xml

try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

ORDER = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]  # of the components of a symmetric tensor


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


def tets(path, cell_type, nnode, cell_fields):
    """The grid of a file, its point and its cell data, and the nodes of its tets [ntet][nnode]."""
    grid = read(path)
    point, cell = arrays(grid.GetPointData()), arrays(grid.GetCellData())
    expect(set(point) == {"displacement", "velocity"}, f"{path}: point data {sorted(point)}")
    expect(set(cell) == set(cell_fields), f"{path}: cell data {sorted(cell)}")
    expect((vtk_to_numpy(grid.GetCellTypesArray()) == cell_type).all(),
           f"{path}: not all cells are of type {cell_type}")
    return grid, point, cell, vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, nnode)


def rest(grid):
    return vtk_to_numpy(grid.GetPoints().GetData())


def frames_of(folder):
    """Path and time of the files that fields.pvd lists."""
    entries = xml.parse(f"{folder}/fields.pvd").getroot().findall("./Collection/DataSet")
    expect(len(entries) >= 2, f"{len(entries)} frames")
    return [(f"{folder}/{entry.get('file')}", float(entry.get("timestep"))) for entry in entries]


def polar(F):
    """The rotation nearest to each F, by another way than the one under test."""
    U, _, Vt = np.linalg.svd(F)
    return U @ Vt


def strain_in(R, F):
    """sym(R'F) - I, and its components in the order of a file."""
    e = np.transpose(R, (0, 2, 1)) @ F
    e = (e + np.transpose(e, (0, 2, 1))) / 2 - np.eye(3)
    return e, np.stack([e[:, i, j] for i, j in ORDER], axis=1)


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
