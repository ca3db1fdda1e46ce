#!/usr/bin/env python3
"""Checks that functions, classes and parameter lists stay small.

sizes.py REPOSITORY [--list N]
Uses universal-ctags. The lines of a function are counted from its name to its closing brace. Constants of a class do not
count as data members. --list prints the N largest of each kind and per folder.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
from collections import Counter, defaultdict

FOLDERS = ("runtime", "bake", "compress", "cli", "examples", "tests")
MAX_LINES = 60  # per function
MAX_LINES_OF_99_PERCENT = 45  # limit for 99 % of the functions of a folder
MAX_MEMBERS = 12
MAX_PARAMETERS = 7
FIXED_SIGNATURES = {"keep_encoded",  # callback of tinygltf
                    "prt_light_from_lat_long"}  # C has no spans


def tags(root):
    files = [str(path) for folder in FOLDERS for path in sorted((root / folder).rglob("*.[ch]*"))
             if path.suffix in (".c", ".h", ".cpp") and "node_modules" not in path.parts]
    command = ["ctags-universal", "--languages=C,C++", "--map-C=-.h", "--map-C++=+.h", "--fields=+neStK", "--fields-C++=+{properties}",
               "--kinds-C++=+pfmsc", "--output-format=json", "-L", "-", "-o", "-"]
    output = subprocess.run(command, input="\n".join(files), capture_output=True, text=True, check=True).stdout
    for line in output.splitlines():
        tag = json.loads(line)
        tag["path"] = str(pathlib.Path(tag["path"]).relative_to(root))
        yield tag


def parameter_count(signature):
    """Returns the number of parameters of a signature such as `(a, b<c, d>, e = {f, g})`."""
    inside = signature[signature.index("(") + 1:signature.rindex(")")].replace("->", "").strip()
    if inside in ("", "void"):
        return 0
    depth = 0
    count = 1
    for character in inside:
        depth += (character in "(<[{") - (character in ")>]}")
        count += character == "," and depth == 0
    return count


def largest_allowed(sizes):
    """Returns the size that 99 % of `sizes` do not exceed."""
    return sorted(sizes)[math.ceil(0.99 * len(sizes)) - 1] if sizes else 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("repository", type=pathlib.Path)
    arguments.add_argument("--list", type=int, default=0, metavar="N")
    arguments = arguments.parse_args()

    lines = defaultdict(list)
    members = Counter()
    parameters = []
    for tag in tags(arguments.repository.resolve()):
        position = f"{tag['path']}:{tag['line']} {tag['name']}"
        folder = tag["path"].split("/")[0]
        if tag["kind"] == "function":
            lines[folder].append((tag.get("end", tag["line"]) - tag["line"] + 1, position))
        if tag["kind"] in ("function", "prototype") and "signature" in tag and tag["name"] not in FIXED_SIGNATURES:
            parameters.append((parameter_count(tag["signature"]), position))
        if tag["kind"] == "member" and "static" not in tag.get("properties", ""):
            members[f"{tag['path']} {tag['scope']}"] += 1

    if not lines:
        sys.exit("no functions found")
    wrong = []
    for folder, found in sorted(lines.items()):
        common = largest_allowed([size for size, _ in found])
        if arguments.list:
            print(f"{folder}: {len(found)} functions, 99 % at most {common} lines, longest {max(found)[0]}")
            for size, position in sorted(found, reverse=True)[:arguments.list]:
                print(f"    {size} {position}")
        if common > MAX_LINES_OF_99_PERCENT:
            wrong.append(f"{folder}: more than 1 % of the functions are longer than {MAX_LINES_OF_99_PERCENT} lines ({common})")
        wrong += [f"{position}: {size} lines, at most {MAX_LINES}" for size, position in found if size > MAX_LINES]
    if arguments.list:
        print("members:", *[f"    {count} {name}" for name, count in members.most_common(arguments.list)], sep="\n")
        print("parameters:", *[f"    {count} {position}" for count, position in sorted(parameters, reverse=True)[:arguments.list]], sep="\n")
    wrong += [f"{name}: {count} data members, at most {MAX_MEMBERS}" for name, count in members.items() if count > MAX_MEMBERS]
    wrong += [f"{position}: {count} parameters, at most {MAX_PARAMETERS}" for count, position in parameters if count > MAX_PARAMETERS]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
