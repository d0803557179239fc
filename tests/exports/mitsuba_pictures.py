#!/usr/bin/env python3
"""Exported scenes in Mitsuba 3: mitsuba_pictures.py TYNDALL PROJECT FOLDER [--pictures]

Renders what `tyndall export` writes of scenes by Mitsuba (`pip install mitsuba`), and compares the
picture with ours, followed by our own paths, within the noise of both: block by block, and in the
mean. Exits with 77, skipped, where mitsuba cannot be imported, unless TYNDALL_REQUIRE_MITSUBA is
set. With --pictures it writes both pictures side by side as PNG files.
"""

import json
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
from verdicts import check, skip  # noqa: E402

BATCHES = 12  # independent pictures, whose spread is Mitsuba's noise
BLOCK = 8     # pixels

# A scene, settings for a small picture, samples of ours and of each batch of Mitsuba's.
SCENES = [
    ("examples/scenes/window_shafts", ["camera.main.width=80", "camera.main.height=56"], 256, 8),
    ("examples/scenes/cornell_fog", ["camera.main.width=48", "camera.main.height=48"], 512, 32),
    ("examples/scenes/columns_obj", ["camera.main.width=64", "camera.main.height=48"], 256, 16),
    # Fog that thins with height: a grid volume.
    ("examples/scenes/ground_fog", ["camera.main.width=64", "camera.main.height=48"], 128, 8),
    # All kinds of lights, mirrors, gloss, phase functions, extinctions that differ in colour.
    ("tests/scenes/many_lights", [], 256, 12),
]
# The solution has no part in a picture by paths: as little of it as there can be.
QUICK = ["solve.refinement=uniform", "solve.max_elements=300", "solve.rays=16",
         "solve.gather_rays=16", "solve.error=0.9"]


def settings(keys):
    return [word for key in keys for word in ("--set", key)]


class Pictures:
    """Of one scene: ours with its standard error, and Mitsuba's batches."""

    def __init__(self, mi, np, tyndall, folder):
        self.mi, self.np, self.tyndall, self.folder = mi, np, tyndall, folder

    def run(self, *arguments):
        return subprocess.run([self.tyndall, *arguments], cwd=self.folder, check=True,
                              capture_output=True, text=True).stdout

    def ours(self, scene, keys, samples, name):
        self.run("solve", str(scene), "-o", name, *settings(keys + QUICK))
        self.run("render", name, "--method", "path_traced", "--samples", str(samples), "-o",
                 f"{name}.exr")
        bitmap = self.mi.Bitmap(str(self.folder / f"{name}.exr"))
        names = [field.name for field in bitmap.struct_()]
        values = self.np.array(bitmap).astype(float)
        colours = ["R", "G", "B"] if "R" in names else ["Y"]
        pick = lambda prefix: values[..., [names.index(prefix + c) for c in colours]]
        return pick(""), pick("error.")

    def theirs(self, scene, keys, samples, name):
        self.run("export", str(scene), "-o", f"{name}.xml", *settings(keys))
        loaded = self.mi.load_file(str(self.folder / f"{name}.xml"))
        batches = [self.np.array(self.mi.render(loaded, spp=samples, seed=k)).astype(float)
                   for k in range(BATCHES)]
        return self.np.stack([b if b.ndim == 3 else b[..., None] for b in batches])

    def blocks(self, picture):
        height, width, channels = picture.shape
        return picture.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK,
                               channels).mean((1, 3))


def compare(pictures, ours, error, theirs):
    """z of the blocks, root mean square and largest; of the mean; and the means' ratio less 1."""
    np = pictures.np
    batches = np.stack([pictures.blocks(b) for b in theirs])
    variance = batches.var(0, ddof=1) / BATCHES + pictures.blocks(error ** 2) / BLOCK ** 2
    z = (pictures.blocks(ours) - batches.mean(0)) / np.sqrt(variance)
    means = theirs.mean((1, 2, 3))
    noise = np.sqrt(means.var(ddof=1) / BATCHES
                    + (error.mean(-1) ** 2).sum() / error.mean(-1).size ** 2)
    off = ours.mean() - means.mean()
    return {"rms": float(np.sqrt((z ** 2).mean())), "worst": float(abs(z).max()),
            "mean": float(off / noise), "off": float(off / means.mean()),
            "noise": float(noise / means.mean())}


def agrees(found):
    # Blocks' z have a Student distribution of some 11 degrees of freedom where Mitsuba's noise is
    # the larger: variance 11/9, and one of a thousand values beyond 4.4. Blocks with a lamp in
    # them have spikes, so that their noise is underestimated by either.
    return found["rms"] < 1.4 and found["worst"] < 7.0 and abs(found["mean"]) < 4.0


def write_png(pictures, ours, theirs, path):
    from PIL import Image
    np = pictures.np
    both = np.concatenate([ours, theirs.mean(0)], 1)
    both = np.repeat(both, 3 // both.shape[-1], -1) / (6.0 * np.median(both))
    codes = (np.clip(both, 0.0, 1.0) ** (1.0 / 2.2) * 255.0).astype("uint8")
    Image.fromarray(codes).resize((codes.shape[1] * 5, codes.shape[0] * 5), 0).save(path)


def main(tyndall, project, folder, with_pictures):
    try:
        import mitsuba as mi
        import numpy as np
        mi.set_variant("scalar_rgb")
    except ImportError as error:
        skip(f"no mitsuba: {error}", "TYNDALL_REQUIRE_MITSUBA")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    pictures = Pictures(mi, np, tyndall, folder)
    results = {}
    for path, keys, samples, batch in SCENES:
        scene = project / f"{path}.toml"
        name = scene.stem
        ours, error = pictures.ours(scene, keys, samples, name)
        theirs = pictures.theirs(scene, keys, batch, name)
        if with_pictures:
            write_png(pictures, ours, theirs, folder / f"{name}.png")
        found = results[name] = compare(pictures, ours, error, theirs)
        check(agrees(found), f"{name}: {found}")
        if name == "window_shafts":
            # The comparison must be able to fail: a third more haze is another picture.
            other, error = pictures.ours(scene, keys + ["medium.haze.extinction=0.2"], samples,
                                         "hazier")
            hazier = compare(pictures, other, error, theirs)
            check(not agrees(hazier), f"a third more haze is seen: {hazier}")
    (folder / "results.json").write_text(json.dumps(results, indent=2))


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]),
         "--pictures" in sys.argv[4:])
