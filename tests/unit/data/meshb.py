"""Writes two.meshb from two.mesh by meshio, whose whole numbers of 8 bytes would make version 4."""
import meshio
import numpy as np

m = meshio.read("two.mesh")
references = [np.asarray(r).astype("i4") for r in m.cell_data["medit:ref"]]
cells = [(c.type, c.data.astype("i4")) for c in m.cells]
meshio.Mesh(m.points, cells, cell_data={"medit:ref": references}).write("two.meshb")
