#!/usr/bin/env python3
"""Gives all instances of a file the factors of the open: what sharing transfer is without them.

    prt bake forest.glb -o shared.glb --instances shared --instance-error 1
    python3 tests/benchmarks/open_instances.py shared.glb open.glb
    prt evaluate own.glb open.glb
"""
import argparse
import json
import struct

FLOAT, HALF = 5126, 5131
NUMBERS = 32  # of an instance: four rows of what passes, one of what comes from below, four colors


def open_factors():
    numbers = [0.0] * NUMBERS
    numbers[3] = numbers[19] = 1.0  # the last of the first row and of the fifth
    return numbers


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input")
    parser.add_argument("output")
    paths = parser.parse_args()
    with open(paths.input, "rb") as file:
        data = bytearray(file.read())
    json_bytes = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + json_bytes])
    extension = document["extensions"]["PRTKIT_instances"]
    view = document["bufferViews"][extension["factors"]["bufferView"]]
    letter = {FLOAT: "f", HALF: "e"}[extension["factors"].get("componentType", FLOAT)]
    packed = struct.pack(f"<{NUMBERS}{letter}", *open_factors())
    first = 20 + json_bytes + 8 + view.get("byteOffset", 0)
    for i in range(extension["count"]):
        data[first + i * len(packed) : first + (i + 1) * len(packed)] = packed
    with open(paths.output, "wb") as file:
        file.write(data)


if __name__ == "__main__":
    main()
