"""Writes quarter.feb from quarter.msh: ten-node tets with curved edges, nodes on 01 12 02 03 13 23."""
import meshio

m = meshio.read("quarter.msh")
tets = [c.data + 1 for c in m.cells if c.type == "tetra10"][0]
faces = [c.data[s] + 1 for c, s in zip(m.cells, m.cell_sets["round"]) if c.type == "triangle6" and s is not None and len(s)]
with open("quarter.feb", "w") as f:
    f.write('<?xml version="1.0" encoding="ISO-8859-1"?>\n<febio_spec version="4.0">\n<Mesh>\n')
    f.write('<Nodes name="quarter">\n')
    for i, x in enumerate(m.points):
        f.write('<node id="%d">%.17g,%.17g,%.17g</node>\n' % (i + 1, *x))
    f.write('</Nodes>\n<Elements type="tet10" name="body">\n')
    for i, t in enumerate(tets):
        f.write('<elem id="%d">%s</elem>\n' % (i + 1, ",".join(map(str, t))))
    f.write('</Elements>\n<Surface name="round">\n')
    for i, t in enumerate(t for block in faces for t in block):
        f.write('<tri6 id="%d">%s</tri6>\n' % (i + 1, ",".join(map(str, t))))
    f.write("</Surface>\n</Mesh>\n</febio_spec>\n")
