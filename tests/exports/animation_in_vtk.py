#!/usr/bin/python3
"""An animation, in VTK's own reader: animation_in_vtk.py TYNDALL SCENE FOLDER

The scene's lamp fades while its sun stays, on one mesh. Exits with 77, skipped, where VTK is
missing (Debian's python3-vtk9), unless TYNDALL_REQUIRE_VTK is set.
"""

import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from other_readers import begin, check_series, columns, names_of, read  # noqa: E402
from verdicts import check  # noqa: E402

TIMES = [0.0, 0.5, 1.0, 1.5, 2.0]      # five frames, two a second
EMISSION = [10.0, 8.0, 6.0, 4.0, 2.0]  # of the lamp, as the scene's track says
LIGHT = ["emission", "flux_divergence", "incident", "irradiance", "net_flux", "radiosity",
         "source_radiance", "source_radiance_gradient"]
OTHERS = ["albedo", "extinction", "kind", "level", "name_id", "parent"]


def values(array):
    """Of all cells or points; no numbers (patches have no source radiance) as 0."""
    numbers = [array.GetValue(k) for k in range(array.GetNumberOfValues())]
    return [0.0 if x != x else x for x in numbers]


def check_emission(grids):
    for grid, expected in zip(grids, EMISSION):
        cells = columns(grid.GetCellData())
        lamp = names_of(grid).index("lamp+")
        found = {cells["emission"].GetValue(k) for k in range(grid.GetNumberOfCells())
                 if cells["name_id"].GetValue(k) == lamp and cells["kind"].GetValue(k) == 0}
        check(found == {expected}, f"the lamp emits {expected}: {found}")


def check_light(name, frames):
    """What the lamp's light adds is straight in its emission; the sun's part stays."""
    first, last = frames[0], frames[-1]
    size = max(abs(x) for x in first)
    check(max(abs(a - b) for a, b in zip(first, last)) > 0.1 * size, f"{name} changes")
    for emission, frame in zip(EMISSION, frames):
        share = (EMISSION[0] - emission) / (EMISSION[0] - EMISSION[-1])
        # A sum of doubles: what is off is rounding.
        worst = max(abs(x - (1.0 - share) * a - share * b)
                    for x, a, b in zip(frame, first, last))
        check(worst <= 1e-9 * size, f"{name} where the lamp emits {emission} ({worst / size:.0e})")


def main(tyndall, scene, folder):
    vtk = begin(folder)
    subprocess.run([tyndall, "animate", str(scene), "-o", "film", "--quiet"], cwd=folder,
                   check=True)
    report = json.loads((folder / "film/report.json").read_text())
    done = [frame["done"] for frame in report["frames"]]
    check(done == ["superposed"] * len(TIMES), f"frames are sums: {done}")

    path = folder / "film/solutions.vtkhdf.series"
    cells = check_series(vtk, path, len(TIMES))
    check(len(set(cells)) == 1, "on one mesh")
    files = json.loads(path.read_text())["files"]
    check([file["time"] for file in files] == TIMES, "at the times of two frames a second")
    named = sorted(path.parent / file["name"] for file in files)
    check(named == sorted((folder / "film/solutions").iterdir()), "all the solutions there are")

    grids = [read(vtk, path.parent / file["name"]) for file in files]
    check_emission(grids)
    data = [columns(grid.GetCellData()) for grid in grids]
    for name in LIGHT:
        check_light(name, [values(arrays[name]) for arrays in data])
    check_light("radiance", [values(grid.GetPointData().GetArray("radiance")) for grid in grids])
    radiosity = [values(arrays["radiosity"]) for arrays in data]
    dark = EMISSION[-1] / EMISSION[0]
    check(any(b > 2.0 * dark * a for a, b in zip(radiosity[0], radiosity[-1])), "the sun shines on")
    for name in OTHERS:
        frames = [values(arrays[name]) for arrays in data]
        check(all(frame == frames[0] for frame in frames), f"{name} stays")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
