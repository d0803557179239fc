"""What we write, in ParaView: pvpython in_paraview.py TYNDALL SCENE FOLDER

Solves a small scene with an animation and opens it as docs/guide/14-exports.md says, without a
picture. Not registered where there is no pvpython (Debian's python3-paraview, which cannot be
installed beside python3-vtk9). Tried with ParaView 5.11.0.
"""

import json
import pathlib
import shutil
import subprocess
import sys

from paraview import simple

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from verdicts import check  # noqa: E402


def opened(path):
    """.vtkhdf by its reader, as ParaView before 5.12 knows it by the ending .hdf alone."""
    if path.suffix == ".vtu":
        reader = simple.OpenDataFile(str(path))
    else:
        reader = simple.VTKHDFReader(FileName=str(path))
    reader.UpdatePipeline()
    return reader


def cells(source):
    return source.GetDataInformation().GetNumberOfCells()


def threshold(source, array, low, high):
    result = simple.Threshold(Input=source)
    # One by one: given to the constructor, ends of 0 are taken for not given.
    result.Scalars = ["CELLS", array]
    result.LowerThreshold = low
    result.UpperThreshold = high
    result.UpdatePipeline()
    return result


def names_of(source):
    names = simple.servermanager.Fetch(source).GetFieldData().GetAbstractArray("names")
    return [names.GetValue(k) for k in range(names.GetNumberOfValues())]


def check_solution(path, report):
    grid = opened(path)
    check(cells(grid) == report["patches"] + report["zones"], f"{path.name}: all cells")
    check("radiance" in grid.PointData.keys(), "radiance of points")
    check({"room.floor+", "lamp+", "haze"} <= set(names_of(grid)), "names")
    check(cells(threshold(grid, "kind", 0, 0)) == report["patches"], "patches alone")
    zones = threshold(grid, "kind", 1, 1)
    check(cells(zones) == report["zones"], "zones alone")
    line = simple.Line(Point1=[0.1, 1.01, 0.9], Point2=[1.9, 1.02, 0.95], Resolution=200)
    along = simple.ResampleWithDataset(SourceDataArrays=zones, DestinationMesh=line)
    along.UpdatePipeline()
    low, high = along.PointData["vtkValidPointMask"].GetRange(0)
    check(low == high == 1, "every place on a line through the room lies in a zone")


def check_series(path, times, counts):
    series = opened(path)
    check(list(series.TimestepValues) == times, f"{path.name}: times {times}")
    ranges = []
    for time, count in zip(times, counts):
        simple.UpdatePipeline(time=time, proxy=series)
        check(cells(series) == count, f"{count} cells at {time}")
        ranges.append(series.CellData["emission"].GetRange(0)[1])
    return ranges


def main(tyndall, scene, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    def run(*arguments):
        subprocess.run([tyndall, *arguments], cwd=folder, check=True, capture_output=True)

    run("solve", str(scene), "-o", "out", "--set", "solve.camera=")
    run("export", "out", "-o", "room.vtu")
    run("animate", str(scene), "-o", "film")
    report = json.loads((folder / "out/report.json").read_text())
    for name in ("out/solution.vtkhdf", "room.vtu"):
        check_solution(folder / name, report)
    finished = report["passes"][1:]
    check_series(folder / "out/passes.vtkhdf.series",
                 [float(k + 1) for k in range(len(finished))],
                 [made["patches"] + made["zones"] for made in finished])
    made = json.loads((folder / "film/report.json").read_text())["frames"]
    lamp = check_series(folder / "film/solutions.vtkhdf.series", [0.5 * k for k in range(5)],
                        [frame["patches"] + frame["zones"] for frame in made])
    check(lamp == [10.0, 8.0, 6.0, 4.0, 2.0], f"the lamp fades as the scene says: {lamp}")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
