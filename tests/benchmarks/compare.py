#!/usr/bin/env python3
"""Compares two files of measure.py; the exit status is 1 if a figure became slower.

compare.py OLD NEW [--max-loss 0.02]
Prints the speed of NEW relative to OLD. A loss is a figure whose relative speed is below 1 - max-loss. Figures that only
one file contains are listed. Files of different machines are rejected.
"""
import argparse
import json
import math
import sys


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("old")
    arguments.add_argument("new")
    arguments.add_argument("--max-loss", type=float, default=0.02)
    arguments = arguments.parse_args()
    old, new = (json.load(open(name, encoding="utf-8")) for name in (arguments.old, arguments.new))
    machines = [(file["machine"]["processor"], file["machine"]["threads"]) for file in (old, new)]
    if machines[0] != machines[1]:
        sys.exit(f"compare.py: the files are of different machines: {machines[0]} and {machines[1]}")

    shared = [name for name in old["seconds"] if name in new["seconds"]]
    if not shared:
        sys.exit("compare.py: the files have no figure in common")
    speeds = {name: old["seconds"][name] / new["seconds"][name] for name in shared}
    lost = [name for name, speed in speeds.items() if speed < 1 - arguments.max_loss]
    for name, speed in sorted(speeds.items(), key=lambda entry: entry[1]):
        print(f"{speed:6.3f}  {name}{'  LOST' if name in lost else ''}")
    mean = math.exp(sum(map(math.log, speeds.values())) / len(speeds))
    print(f"{mean:6.3f}  geometric mean of {len(shared)}, {old['commit']} to {new['commit']}")
    for name in sorted(set(old["seconds"]) ^ set(new["seconds"])):
        print(f"        only in {'the old' if name in old['seconds'] else 'the new'} file: {name}")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
