"""Writes IN as OUT, Netgen's, by meshio 5, which cannot with the data that cells have: volume.py IN OUT."""
import sys

import meshio

mesh = meshio.read(sys.argv[1])
groups = mesh.cell_data.get("CellEntityIds", [])
keep = [i for i, block in enumerate(mesh.cells) if block.type not in ("vertex", "line", "line3")]
mesh = meshio.Mesh(mesh.points, [mesh.cells[i] for i in keep],
                   cell_data={"netgen:index": [groups[i].reshape(-1).astype(int) for i in keep]})
meshio.write(sys.argv[2], mesh, file_format="netgen")
