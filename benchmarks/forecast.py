#!/usr/bin/env python3
"""How good `tyndall check` foresees: every example scene is checked, then solved, and pictured.

    benchmarks/forecast.py build/release/bin/tyndall examples/scenes/*.toml [--solve-only]

Prints a Markdown table: elements, CPU seconds and memory, as foreseen and as found, and their ratios.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile


def run(*arguments):
    result = subprocess.run(arguments, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {result.stderr}")
    return json.loads(result.stdout)


def main():
    program = sys.argv[1]
    scenes = [argument for argument in sys.argv[2:] if not argument.startswith("--")]
    pictured = "--solve-only" not in sys.argv
    ratios = {"elements": [], "seconds": [], "memory": []}
    print("| scene | elements | found | CPU s | found | MB | found | trial, CPU s |")
    print("|---|---|---|---|---|---|---|---|")
    for scene in scenes:
        foreseen = run(program, "check", scene, "--json")["forecast"]
        with tempfile.TemporaryDirectory() as folder:
            command = ["run", "--no-view"] if pictured else ["solve"]
            found = run(program, command[0], scene, "-o", folder, "--json", *command[1:])
        elements = found["patches"] + found["zones"]
        seconds = foreseen["solve_cpu_seconds"]
        if pictured:
            seconds += foreseen["picture_cpu_seconds"]
        pairs = {
            "elements": (foreseen["elements"], elements),
            "seconds": (seconds, found["cpu_seconds"]),
            "memory": (foreseen["memory_bytes"] / 1e6, found["peak_memory_bytes"] / 1e6),
        }
        cells = [pathlib.Path(scene).stem]
        for name, (before, after) in pairs.items():
            ratios[name].append(before / after)
            digits = 1 if name == "seconds" else 0
            cells += [f"{before:.{digits}f}", f"{after:.{digits}f}"]
        cells.append(f"{foreseen['trial_cpu_seconds']:.1f}")
        print("| " + " | ".join(cells) + " |", flush=True)
    for name, values in ratios.items():
        spread = math.exp(math.sqrt(sum(math.log(v) ** 2 for v in values) / len(values)))
        print(f"{name}: from {min(values):.2f} to {max(values):.2f} of what was found; "
              f"off by a factor of {spread:.2f}, root mean square")


if __name__ == "__main__":
    main()
