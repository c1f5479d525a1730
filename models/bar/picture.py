#!/usr/bin/python3
"""Draws the deformed bar at a few moments of a run, coloured by von Mises stress.

    /usr/bin/python3 models/bar/picture.py out/bar bar.png

needs python3-vtk9 (Debian). Reads fields.pvd of the run's folder."""
import os
import sys
import xml.etree.ElementTree as tree

import vtk

MOMENTS = [0.0, 3.0, 6.0, 10.0]  # s
SPACING = 0.26  # m between the bodies


def deformed(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    grid.GetPointData().SetActiveVectors("displacement")
    warp = vtk.vtkWarpVector()
    warp.SetInputData(grid)
    warp.Update()
    return warp.GetOutput()


def text(actor_position, words, size):
    source = vtk.vtkBillboardTextActor3D()
    source.SetInput(words)
    source.SetPosition(actor_position)
    source.GetTextProperty().SetFontSize(size)
    source.GetTextProperty().SetColor(0.15, 0.15, 0.15)
    source.GetTextProperty().SetJustificationToCentered()
    return source


def main(folder, output):
    entries = [(float(e.get("timestep")), e.get("file"))
               for e in tree.parse(os.path.join(folder, "fields.pvd")).iter("DataSet")]
    bodies = [(t, deformed(os.path.join(folder, min(entries, key=lambda e: abs(e[0] - t))[1])))
              for t in MOMENTS]
    top = max(b.GetCellData().GetArray("von_mises").GetRange()[1] for _, b in bodies)

    colours = vtk.vtkColorTransferFunction()
    for k, rgb in enumerate([(0.80, 0.86, 0.93), (0.55, 0.75, 0.87), (0.99, 0.87, 0.56),
                             (0.96, 0.55, 0.30), (0.70, 0.10, 0.15)]):
        colours.AddRGBPoint(top * k / 4, *rgb)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for k, (t, body) in enumerate(bodies):
        mapper = vtk.vtkDataSetMapper()
        mapper.SetInputData(body)
        mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray("von_mises")
        mapper.SetLookupTable(colours)
        mapper.UseLookupTableScalarRangeOn()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.35, 0.35, 0.35)
        actor.GetProperty().SetAmbient(0.45)
        actor.GetProperty().SetDiffuse(0.6)
        actor.SetPosition(k * SPACING, 0, 0)
        renderer.AddActor(actor)
        renderer.AddActor(text((k * SPACING + 0.05, 0, -0.07), f"t = {t:g} s", 26))
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle("von Mises\nstress [Pa]")
    bar.SetNumberOfLabels(4)
    bar.SetLabelFormat("%.0f")
    bar.SetPosition(0.88, 0.2)
    bar.SetWidth(0.07)
    bar.SetHeight(0.6)
    bar.UnconstrainedFontSizeOn()
    for style in (bar.GetLabelTextProperty(), bar.GetTitleTextProperty()):
        style.SetColor(0.15, 0.15, 0.15)
        style.SetFontSize(20)
        style.ItalicOff()
        style.ShadowOff()
        style.BoldOff()
    renderer.AddActor(bar)

    camera = renderer.GetActiveCamera()
    camera.SetViewUp(0, 0, 1)
    camera.SetFocalPoint(0.56, 0.05, 0.265)
    camera.SetPosition(0.15, -3.0, 0.75)
    camera.SetViewAngle(15.5)
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1200, 640)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(output)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
