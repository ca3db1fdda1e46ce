#!/usr/bin/env python3
"""Compares the output of AMD's compiler for the baker's kernels with stored results.

gpu_static.py KERNEL_COST DRIVERS [--write] [--results FILE]
KERNEL_COST: the program of that name; DRIVERS: a folder of tests/support/fetch_drivers.sh. Needs no GPU. Prints differences;
the exit status is 1 if a kernel has fewer subgroups per SIMD, more spills, or 5 % more cycles. --write stores the new
figures. Add a note about each change by hand to the list "changes" of FILE.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

FAMILIES = ["navi21", "navi31"]
KEPT = {"VGPRs": "vgprs", "LDS size": "shared_bytes", "Scratch size": "scratch_bytes", "Spilled VGPRs": "spilled",
        "Subgroups per SIMD": "subgroups_per_simd", "Inverse Throughput": "inverse_throughput"}
SLOWER = 1.05


def measure(program, drivers, family):
    environment = dict(os.environ, RADV_FORCE_FAMILY=family, VK_DRIVER_FILES=str(drivers / "radeon.json"),
                       LD_LIBRARY_PATH=str(drivers / "lib"))
    printed = subprocess.run([program], env=environment, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return {kernel: {key: statistics[name] for name, key in KEPT.items()}
            for kernel, statistics in json.loads(printed.stdout).items()}


def worse(before, now):
    return (now["subgroups_per_simd"] < before["subgroups_per_simd"] or now["spilled"] > before["spilled"]
            or now["inverse_throughput"] > SLOWER * before["inverse_throughput"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("drivers", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path(__file__).parent / "gpu_static.json")
    arguments = parser.parse_args()
    results = json.loads(arguments.results.read_text()) if arguments.results.exists() else {"changes": [], "kernels": {}}
    status = 0
    for family in FAMILIES:
        now = measure(arguments.program.resolve(), arguments.drivers.resolve(), family)
        before = results["kernels"].get(family, {})
        for kernel, figures in now.items():
            known = before.get(kernel)
            if known == figures:
                continue
            print(f"{family}, {kernel}: {figures}" + (f", before {known}" if known else ""))
            status |= known is not None and worse(known, figures)
        results["kernels"][family] = now
    if arguments.write:
        arguments.results.write_text(json.dumps(results, indent=1) + "\n")
        return 0
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
