#!/usr/bin/python3
"""What we write, in the readers of others: other_readers.py TYNDALL SCENE FOLDER

Solves a small scene and opens solution.vtkhdf and its exports by VTK's own readers (Debian's
python3-vtk9); also by PyVista, Gmsh and meshio, each where it can be imported. Exits with 77,
skipped, where VTK is missing, unless TYNDALL_REQUIRE_VTK is set.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from verdicts import check, skip  # noqa: E402

ARRAYS = ["albedo", "emission", "error", "extinction", "flux_divergence", "incident", "irradiance",
          "kind", "level", "name_id", "net_flux", "parent", "radiosity", "source_radiance",
          "source_radiance_gradient"]


def near(a, b, relative):
    return abs(a - b) <= relative * max(abs(a), abs(b))


def read(vtk, path):
    reader = vtk.vtkHDFReader() if path.suffix == ".vtkhdf" else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def columns(data):
    return {data.GetArrayName(k): data.GetArray(k) for k in range(data.GetNumberOfArrays())}


def names_of(grid):
    names = grid.GetFieldData().GetAbstractArray("names")
    return [names.GetValue(k) for k in range(names.GetNumberOfValues())]


def sizes_by_name(vtk, grid):
    """Area of every side and volume of every medium, summed over their cells."""
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    cells = columns(sizes.GetOutput().GetCellData())
    names, result = names_of(grid), {}
    for k in range(grid.GetNumberOfCells()):
        name = names[int(cells["name_id"].GetValue(k))]
        size = cells["Area" if cells["kind"].GetValue(k) == 0 else "Volume"].GetValue(k)
        result[name] = result.get(name, 0.0) + size
    return result


def check_sizes(vtk, grid, stated):
    found = sizes_by_name(vtk, grid)
    # Doubles in the file; VTK sums thousands of cells.
    expected = {side["name"]: side["area"] for side in stated["sides"]}
    expected.update({medium["name"]: medium["volume"] for medium in stated["media"]})
    check(set(found) == set(expected), f"cells of all {len(expected)} sides and media")
    check(all(near(found[name], expected[name], 1e-9) for name in expected),
          "areas of sides and volumes of media")


def tets_alone(vtk, grid):
    threshold = vtk.vtkThreshold()
    threshold.SetInputData(grid)
    threshold.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "kind")
    threshold.SetLowerThreshold(0.5)
    threshold.SetUpperThreshold(1.5)
    threshold.Update()
    return threshold.GetOutput()


def probed_by_vtk(vtk, grid, places):
    points = vtk.vtkPoints()
    for place in places:
        points.InsertNextPoint(*place)
    cloud = vtk.vtkPolyData()
    cloud.SetPoints(points)
    probe = vtk.vtkProbeFilter()
    probe.SetInputData(cloud)
    probe.SetSourceData(tets_alone(vtk, grid))
    # VTK's default looks from the nearest point on, and never leaves that point's cell where every
    # cell has points of its own.
    if hasattr(probe, "SetCellLocator"):  # VTK 9.7
        probe.SetCellLocator(vtk.vtkStaticCellLocator())
    else:
        strategy = vtk.vtkCellLocatorStrategy()
        strategy.SetCellLocator(vtk.vtkStaticCellLocator())
        probe.SetFindCellStrategy(strategy)
    probe.Update()
    output = probe.GetOutput().GetPointData()
    check(all(output.GetArray("vtkValidPointMask").GetValue(k) for k in range(len(places))),
          "every probe lies in a zone")
    return output


def check_probes(vtk, grid, run, folder, stated_error):
    places = [(0.13 + 0.2 * k, 0.27 + 0.13 * (k % 7), 1.1 + 0.11 * (k % 5)) for k in range(13)]
    (folder / "points.csv").write_text("".join("%r,%r,%r\n" % p for p in places))
    run("probe", "out", "--points", "points.csv", "-o", "probed.csv")
    lines = (folder / "probed.csv").read_text().splitlines()
    head = lines[0].split(",")
    ours = [[float(word) for word in line.split(",")] for line in lines[1:]]
    data = probed_by_vtk(vtk, grid, places)
    radiance, gradient = data.GetArray("radiance"), data.GetArray("source_radiance_gradient")
    bands = radiance.GetNumberOfComponents()
    worst = square = total = 0.0
    for k in range(len(places)):
        for b in range(bands):
            value = radiance.GetComponent(k, b)
            exact = ours[k][head.index(f"J_{b}")]
            square += (value - exact) ** 2
            total += exact ** 2
            worst = max(worst, abs(value / exact - 1.0))
    check(gradient.GetNumberOfComponents() == 3 * bands, "a gradient in every band")
    off = math.sqrt(square / total)
    # probe gathers J anew at each place; how far the file's linear functions are off, root mean
    # square, the report states. Twice that, as 13 places are no average over the room.
    check(off < 2.0 * stated_error, f"J at {len(places)} places, as tyndall probe says, to "
          f"{off:.1%} (worst {worst:.1%}; the report states {stated_error:.1%})")


def check_linear(grid):
    """The points' radiance is the linear function that mean and gradient of the cell say."""
    cells, radiance = columns(grid.GetCellData()), grid.GetPointData().GetArray("radiance")
    bands, worst, seen = radiance.GetNumberOfComponents(), 0.0, 0
    for k in range(0, grid.GetNumberOfCells(), 7):
        cell = grid.GetCell(k)
        ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        places = [grid.GetPoint(i) for i in ids]
        centre = [sum(p[a] for p in places) / len(places) for a in range(3)]
        for b in range(bands):
            mean = cells["source_radiance"].GetComponent(k, b)
            slope = [cells["source_radiance_gradient"].GetComponent(k, 3 * b + a)
                     for a in range(3)]
            for i, place in zip(ids, places):
                linear = mean + sum(s * (p - c) for s, p, c in zip(slope, place, centre))
                worst = max(worst, abs(linear - radiance.GetComponent(i, b)))
                seen = max(seen, abs(linear))
    check(worst < 1e-9 * seen, f"points' radiance is the cells' linear function ({worst:.1e})")


def check_same(a, b):
    """Two grids hold the same numbers."""
    check(a.GetNumberOfCells() == b.GetNumberOfCells()
          and a.GetNumberOfPoints() == b.GetNumberOfPoints(), "as many cells and points")
    check(names_of(a) == names_of(b), "the same names")
    for data in ("GetCellData", "GetPointData"):
        ours, theirs = columns(getattr(a, data)()), columns(getattr(b, data)())
        check(set(ours) == set(theirs), f"the same arrays {sorted(ours)}")
        for name, array in ours.items():
            other = theirs[name]
            check(array.GetNumberOfComponents() == other.GetNumberOfComponents()
                  and all(array.GetValue(k) == other.GetValue(k)
                          or array.GetValue(k) != array.GetValue(k)
                          for k in range(array.GetNumberOfValues())), f"array {name}, bit for bit")


def check_series(vtk, path, count):
    series = json.loads(path.read_text())
    check(series["file-series-version"] == "1.0", f"{path.name} is a series")
    files = series["files"]
    check(len(files) == count, f"of {count} files")
    times = [file["time"] for file in files]
    check(times == sorted(set(times)), f"at times that ascend {times}")
    cells = [read(vtk, path.parent / file["name"]).GetNumberOfCells() for file in files]
    check(all(n > 0 for n in cells), f"which open: {cells} cells")
    return cells


def with_pyvista(folder, cells):
    try:
        import pyvista
    except ImportError:
        return print("not here: pyvista")
    for name in ("out/solution.vtkhdf", "room.vtu"):
        grid = pyvista.read(folder / name)
        check(grid.n_cells == cells and "radiosity" in grid.cell_data, f"pyvista reads {name}")
    check(pyvista.read(folder / "room.ply").n_points > 0, "pyvista reads room.ply")


def with_gmsh(folder, stated):
    try:
        import gmsh
    except (ImportError, OSError):
        return print("not here: gmsh")
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(folder / "room.msh"))
    volumes = {}
    for dimension, tag in gmsh.model.getPhysicalGroups():
        name = gmsh.model.getPhysicalName(dimension, tag)
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            kinds, tags, _ = gmsh.model.mesh.getElements(dimension, entity)
            for numbers in tags:
                sizes = gmsh.model.mesh.getElementQualities(numbers, "volume")
                volumes[name] = volumes.get(name, 0.0) + sum(sizes)
    gmsh.finalize()
    for medium in stated["media"]:
        check(near(volumes[medium["name"]], medium["volume"], 1e-9),
              f"gmsh: volume of {medium['name']}")
    for side in stated["sides"]:
        if side["name"] in ("room.floor+", "lamp+"):
            check(near(volumes[side["name"][:-1]], side["area"], 1e-9),
                  f"gmsh: area of {side['name'][:-1]}")


def with_meshio(folder, stated, grid):
    try:
        import meshio
    except ImportError:
        return print("not here: meshio")
    mesh = meshio.read(folder / "room.msh")
    check(sum(len(block.data) for block in mesh.cells if block.type == "tetra")
          == stated["tetrahedra"], "meshio: all tetrahedra")
    check({"room.floor", "fog", "openings"} <= set(mesh.field_data), "meshio: physical names")
    surfaces = meshio.read(folder / "room.ply")
    check({"radiosity_0", "radiosity_1", "radiosity_2", "red"} <= set(surfaces.point_data),
          "meshio: what points of room.ply carry")
    # It refuses arrays of texts: without the names, as the guide says.
    lines = (folder / "room.vtu").read_text().splitlines(keepends=True)
    first, last = lines.index("<FieldData>\n"), lines.index("</FieldData>\n")
    (folder / "numbers.vtu").write_text("".join(lines[:first] + lines[last + 1:]))
    cells = meshio.read(folder / "numbers.vtu")
    check(sum(len(block.data) for block in cells.cells) == grid.GetNumberOfCells()
          and set(cells.cell_data) == set(columns(grid.GetCellData())), "meshio: room.vtu")


def begin(folder):
    """An empty folder, and VTK; without it the test is skipped."""
    try:
        import vtk
    except ImportError:
        skip("no python3-vtk9", "TYNDALL_REQUIRE_VTK")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return vtk


def main(tyndall, scene, folder):
    vtk = begin(folder)

    def run(*arguments):
        return subprocess.run([tyndall, *arguments], cwd=folder, check=True, capture_output=True,
                              text=True).stdout

    quick = ["--set", "solve.error=0.05", "--set", "solve.max_elements=6000", "--set",
             "solve.camera="]
    run("solve", str(scene), "-o", "out", *quick)
    stated = json.loads(run("check", str(scene), "--json"))
    report = json.loads((folder / "out/report.json").read_text())
    grid = read(vtk, folder / "out/solution.vtkhdf")
    check(grid.GetNumberOfCells() == report["patches"] + report["zones"], "all cells")
    check(sorted(columns(grid.GetCellData())) == ARRAYS, "all arrays of the guide")
    check_sizes(vtk, grid, stated)
    check_linear(grid)
    check_probes(vtk, grid, run, folder, report["estimated_solution_error"])
    run("export", "out", "-o", "room.vtu")
    check_same(grid, read(vtk, folder / "room.vtu"))
    cells = check_series(vtk, folder / "out/passes.vtkhdf.series", len(report["passes"]) - 1)
    check(cells == sorted(cells), "of passes that grow")
    run("export", "out", "-o", "room.msh")
    run("export", "out", "-o", "room.ply")
    with_pyvista(folder, grid.GetNumberOfCells())
    with_gmsh(folder, stated)
    with_meshio(folder, stated, grid)


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
