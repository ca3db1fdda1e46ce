#!/usr/bin/env python3
"""Measures runtime, baker and compressor, and writes the figures as JSON.

measure.py BUILD [-o FILE] [--repeat N]
BUILD is a build folder of preset dev. Each figure is the minimum of N runs, in seconds. Use an idle machine.
Default of -o: results/MACHINE-COMMIT.json in the folder of this script.
"""
import argparse
import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).parent
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
BAKES = {  # name of the figure: scene and options
    "bake knot": ("knot", "--rays 1024"),
    "bake room, 3 bounces": ("room", "--rays 512 --bounces 3"),
    "bake tree, 2 bounces": ("tree", "--rays 256 --bounces 2"),
}
COMPRESSIONS = {
    "compress knot, u32": ("knot", "--preset u32"),
    "compress room, u32": ("room", "--preset u32"),
    "compress tree, u64": ("tree", "--preset u64"),
    "compress knot, 9 bytes": ("knot", "--bytes-per-vertex 9"),
}


def output_of(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          text=True, **options).stdout


def processor():
    found = re.search(r"^model name\s*:\s*(.+)$", pathlib.Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    return found.group(1) if found else platform.machine()


def runtime_figures(build):
    report = json.loads(output_of(build / "tests/runtime_benchmark", "--benchmark_format=json"))
    return {"runtime " + run["name"]: run["real_time"] * UNITS[run["time_unit"]] for run in report["benchmarks"]}


def report_of(prt, *arguments):
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        output_of(prt, *arguments, "--json", file.name)
        return json.load(open(file.name, encoding="utf-8"))


def program_figures(build, folder):
    prt = build / "cli/prt"
    figures = {}
    for name, (scene, options) in BAKES.items():
        figures[name] = report_of(prt, "bake", folder / f"{scene}.glb", "-o", folder / f"{scene}.baked.glb",
                                  *options.split())["seconds"]
    for name, (scene, options) in COMPRESSIONS.items():
        figures[name] = report_of(prt, "compress", folder / f"{scene}.baked.glb", "-o", folder / "shipped.glb",
                                  *options.split())["seconds"]
    bench = report_of(prt, "bench", folder / "knot.glb", "--from", "256", "--to", "256", "--most-seconds", "10")
    for run in bench["runs"]:
        figures[f"bench knot, {run['series']}, {run['rays']}"] = run["seconds"]
    return figures


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("-o", dest="output", type=pathlib.Path)
    arguments.add_argument("--repeat", type=int, default=3)
    arguments = arguments.parse_args()
    build = arguments.build.resolve()

    seconds = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        output_of(build / "examples/scenes/example_scenes", folder)
        for i in range(arguments.repeat):
            print(f"run {i + 1} of {arguments.repeat}", file=sys.stderr)
            for name, value in {**runtime_figures(build), **program_figures(build, folder)}.items():
                seconds[name] = min(value, seconds.get(name, value))

    commit = output_of("git", "rev-parse", "--short=12", "HEAD", cwd=HERE).strip()
    changed = bool(output_of("git", "status", "--porcelain", "--untracked-files=no", cwd=HERE))
    result = {
        "commit": commit + ("+changes" if changed else ""),
        "date": datetime.date.today().isoformat(),
        "machine": {"processor": processor(), "threads": os.cpu_count(), "load_before": round(os.getloadavg()[2], 2)},
        "seconds": {name: float(f"{value:.4g}") for name, value in seconds.items()},
    }
    machine = re.sub(r"[^a-z0-9]+", "-", processor().lower()).strip("-")
    output = arguments.output or HERE / "results" / f"{machine}-{os.cpu_count()}-{result['commit']}.json"
    output.parent.mkdir(exist_ok=True)
    output.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print(output)


if __name__ == "__main__":
    main()
