#!/usr/bin/env python3
"""The pictures of docs/guide/14-exports.md: vtk_pictures.py SOLUTION.vtkhdf FOLDER

By VTK alone, without a window, and with the steps that the guide gives for ParaView: patches by
their radiosity without the near walls (vtk_surfaces.png), zones on a slice by their source
radiance (vtk_slice.png). Python with VTK (`pip install vtk`, or Debian's python3-vtk9).
"""

import pathlib
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

SIZE = (520, 360)


def read(path):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def threshold(grid, array, low, high):
    keep = vtk.vtkThreshold()
    keep.SetInputData(grid)
    keep.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, array)
    keep.SetLowerThreshold(low)
    keep.SetUpperThreshold(high)
    keep.Update()
    return keep.GetOutput()


def plane(origin, normal):
    result = vtk.vtkPlane()
    result.SetOrigin(*origin)
    result.SetNormal(*normal)
    return result


def sliced(grid, origin, normal):
    cut = vtk.vtkCutter()
    cut.SetInputData(grid)
    cut.SetCutFunction(plane(origin, normal))
    cut.Update()
    return cut.GetOutput()


def actor(data, points, array, decades, edges=False):
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputData(data)
    source = data.GetPointData() if points else data.GetCellData()
    high = float(vtk_to_numpy(source.GetArray(array)).max())
    if points:
        mapper.SetScalarModeToUsePointFieldData()
    else:
        mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(array)
    colours = vtk.vtkLookupTable()
    colours.SetNumberOfColors(256)
    colours.SetScaleToLog10()
    colours.SetTableRange(high / 10.0 ** decades, high)
    ramp = vtk.vtkColorTransferFunction()
    ramp.SetColorSpaceToLab()
    for place, colour in [(0.0, (0.05, 0.03, 0.2)), (0.35, (0.45, 0.1, 0.45)),
                          (0.7, (0.93, 0.45, 0.25)), (1.0, (1.0, 0.97, 0.75))]:
        ramp.AddRGBPoint(place, *colour)
    for k in range(256):
        colours.SetTableValue(k, *ramp.GetColor(k / 255.0), 1.0)
    mapper.SetLookupTable(colours)
    mapper.UseLookupTableScalarRangeOn()
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().LightingOff()
    if edges:
        result.GetProperty().EdgeVisibilityOn()
        result.GetProperty().SetEdgeColor(0.25, 0.25, 0.3)
        result.GetProperty().SetLineWidth(0.5)
    return result


def picture(actors, eye, target, path):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    for a in actors:
        renderer.AddActor(a)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(*eye)
    camera.SetFocalPoint(*target)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(path))
    writer.SetInputConnection(shot.GetOutputPort())
    writer.Write()


def main(solution, folder):
    grid = read(solution)
    patches, zones = threshold(grid, "kind", -0.5, 0.5), threshold(grid, "kind", 0.5, 1.5)
    # The outsides of the walls are dark, and the lamp would outshine all.
    room = threshold(patches, "radiosity", 0.001, 1000.0)
    seen = actor(room, True, "radiance", 2.0, edges=True)
    seen.GetProperty().BackfaceCullingOn()  # near walls, whose insides look away
    picture([seen], (7.0, -7.0, 6.4), (2.3, 1.9, 1.1), folder / "vtk_surfaces.png")
    middle = sliced(zones, (2.5, 2.0, 1.5), (0, 1, 0))
    floor = sliced(zones, (2.5, 2.0, 0.9), (0, 0, 1))
    picture([actor(middle, True, "radiance", 1.7, edges=True),
             actor(floor, True, "radiance", 1.7)], (5.6, -6.6, 4.6), (2.4, 2.0, 1.3),
            folder / "vtk_slice.png")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
