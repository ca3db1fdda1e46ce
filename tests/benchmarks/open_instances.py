#!/usr/bin/env python3
"""Sets the factors of all instances of a file to those of unoccluded instances, to measure shared transfer without factors.

    prt bake forest.glb -o shared.glb --instances shared,error=1
    python3 tests/benchmarks/open_instances.py shared.glb open.glb
    prt evaluate own.glb open.glb
"""
import argparse
import json
import struct

NUMBERS = 52  # bytes of an instance, one per number; an unoccluded instance has zeros


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
    first = 20 + json_bytes + 8 + view.get("byteOffset", 0)
    size = NUMBERS * extension["count"]
    data[first : first + size] = bytes(size)
    with open(paths.output, "wb") as file:
        file.write(data)


if __name__ == "__main__":
    main()
