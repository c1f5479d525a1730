#!/usr/bin/python3
"""Draws a body at a few moments of a run: the refined surface shaded, the unrefined one as wires.

    /usr/bin/python3 models/surfaces.py bar-hierarchical models/bar-hierarchical/surfaces.png

needs python3-vtk9 (Debian) and a display, or xvfb-run before it. Reads fields.pvd of out/NAME, as
models/run NAME leaves it, and the mesh of models/NAME."""
import math
import os
import sys
import xml.etree.ElementTree as tree

import vtk

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
VIEWS = {
    "bar-hierarchical": {
        "mesh": "bar.msh", "colour": (0.86, 0.88, 0.90), "wire": (0.78, 0.10, 0.10), "tube": 0.0008,
        "moments": [0.0, 2.5, 5.0, 10.0], "spacing": 0.24, "label": (0.05, 0.05, -0.06),
        "eye": (-0.35, -1.0, 0.3), "size": (1200, 480), "zoom": 2.25,
    },
    "liver": {
        "mesh": "liver.msh", "colour": (0.62, 0.22, 0.18), "wire": (0.95, 0.85, 0.75),
        "tube": 0.0006, "groups": {1: (0.30, 0.50, 0.85), 2: (0.30, 0.75, 0.35)},
        "moments": [0.0, 2.5, 10.0], "spacing": 0.31, "label": (0, 0, -0.11),
        "push": (-0.447, 0, -0.894), "pushed at": [2.5, 10.0],
        "eye": (-0.85, 0.1, 0.5), "size": (1200, 330), "zoom": 3.0,
    },
}


def fine_surface(path):
    """The deformed surface of a VTU file, and the grid itself."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    grid.GetPointData().SetActiveVectors("displacement")
    warp = vtk.vtkWarpVector()
    warp.SetInputData(grid)
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(warp.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(surface.GetOutputPort())
    normals.SetFeatureAngle(50)
    normals.Update()
    return normals.GetOutput(), warp.GetOutput().GetPoints()


def coarse_faces(path):
    """The outer faces of a gmsh 2.2 file's tets, turned outwards, and its groups of triangles."""
    with open(path, encoding="ascii") as f:
        lines = iter(f.read().splitlines())
    faces, groups = {}, {}
    for line in lines:
        if line != "$Elements":
            continue
        for _ in range(int(next(lines))):
            row = [int(word) for word in next(lines).split()]
            nodes = [i - 1 for i in row[3 + row[2]:]]
            if row[1] == 2:
                groups.setdefault(row[3], []).append(nodes)
            if row[1] == 4:
                for face in (0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3):
                    face = [nodes[k] for k in face]
                    faces.setdefault(tuple(sorted(face)), []).append(face)
    return [same[0] for same in faces.values() if len(same) == 1], groups


def towards(faces, points, eye):
    """Those of the faces that look into this direction."""
    seen = []
    for face in faces:
        p, q, r = (points.GetPoint(i) for i in face)
        normal = [0.0, 0.0, 0.0]
        vtk.vtkTriangle.ComputeNormal(p, q, r, normal)
        if sum(n * e for n, e in zip(normal, eye)) > 0:
            seen.append(face)
    return seen


def wires(faces, points, radius):
    """The faces' edges as tubes; refinement leaves the numbers of the coarse nodes as they are."""
    lines = vtk.vtkCellArray()
    for a, b in {tuple(sorted((f[k], f[k - 1]))) for f in faces for k in range(3)}:
        lines.InsertNextCell(2)
        lines.InsertCellPoint(a)
        lines.InsertCellPoint(b)
    poly = vtk.vtkPolyData()
    poly.SetPoints(points)
    poly.SetLines(lines)
    tube = vtk.vtkTubeFilter()
    tube.SetInputData(poly)
    tube.SetRadius(radius)
    tube.SetNumberOfSides(8)
    tube.Update()
    return tube.GetOutput()


def arrows(faces, points, direction):
    """An arrow that ends at the middle of each face."""
    length, middles, vectors = 0.035, vtk.vtkPoints(), vtk.vtkDoubleArray()
    vectors.SetNumberOfComponents(3)
    for face in faces:
        corners = [points.GetPoint(i) for i in face]
        middles.InsertNextPoint(*(sum(x) / 3 - length * d for x, d in zip(zip(*corners), direction)))
        vectors.InsertNextTuple(direction)
    poly = vtk.vtkPolyData()
    poly.SetPoints(middles)
    poly.GetPointData().SetVectors(vectors)
    arrow = vtk.vtkArrowSource()
    arrow.SetTipLength(0.4)
    glyph = vtk.vtkGlyph3D()
    glyph.SetInputData(poly)
    glyph.SetSourceConnection(arrow.GetOutputPort())
    glyph.SetScaleModeToDataScalingOff()
    glyph.SetScaleFactor(length)
    glyph.Update()
    return glyph.GetOutput()


def show(renderer, poly, colour, at, specular=0.0):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(poly)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().SetAmbient(0.3)
    actor.GetProperty().SetDiffuse(0.7)
    actor.GetProperty().SetSpecular(specular)
    actor.GetProperty().SetSpecularPower(25)
    actor.SetPosition(*at)
    renderer.AddActor(actor)


def label(renderer, words, at):
    actor = vtk.vtkBillboardTextActor3D()
    actor.SetInput(words)
    actor.SetPosition(*at)
    actor.GetTextProperty().SetFontSize(24)
    actor.GetTextProperty().SetColor(0.15, 0.15, 0.15)
    actor.GetTextProperty().SetJustificationToCentered()
    renderer.AddActor(actor)


def write(layers, view, output):
    """One layer over the other, seen along one and the same direction."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*view["size"])
    window.SetNumberOfLayers(len(layers))
    camera = layers[0].GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetViewUp(0, 0, 1)
    camera.SetPosition(*view["eye"])
    camera.SetFocalPoint(0, 0, 0)
    layers[0].ResetCamera()
    camera.Zoom(view["zoom"])
    lights = vtk.vtkLightKit()
    lights.AddLightsToRenderer(layers[0])
    for k, layer in enumerate(layers):
        layer.SetLayer(k)
        layer.SetActiveCamera(camera)
        window.AddRenderer(layer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(output)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def main(name, output):
    view, folder = VIEWS[name], os.path.join(ROOT, "out", name)
    outer, groups = coarse_faces(os.path.join(ROOT, "models", name, view["mesh"]))
    files = [(float(e.get("timestep")), e.get("file"))
             for e in tree.parse(os.path.join(folder, "fields.pvd")).iter("DataSet")]
    body, over = vtk.vtkRenderer(), vtk.vtkRenderer()
    body.SetBackground(1, 1, 1)
    across = math.hypot(*view["eye"][:2])
    aside = (-view["eye"][1] / across, view["eye"][0] / across, 0)  # to the right of the picture
    for k, moment in enumerate(view["moments"]):
        t, file = min(files, key=lambda entry: abs(entry[0] - moment))
        surface, points = fine_surface(os.path.join(folder, file))
        at = [k * view["spacing"] * x for x in aside]
        show(body, surface, view["colour"], at, 0.3)
        seen = towards(outer, points, view["eye"])
        show(over, wires(seen, points, view["tube"]), view["wire"], at)
        for group, colour in view.get("groups", {}).items():
            part = [face for face in seen if sorted(face) in map(sorted, groups[group])]
            show(over, wires(part, points, 1.5 * view["tube"]), colour, at)
        if t in view.get("pushed at", []):
            show(body, arrows(groups[2], points, view["push"]), (0.20, 0.60, 0.25), at)
        label(body, f"t = {t:g} s", [x + y for x, y in zip(at, view["label"])])
    write([body, over], view, output)


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in VIEWS:
        sys.exit(__doc__)
    main(*sys.argv[1:])
