#!/usr/bin/env python3
"""Checks that functions, classes and parameter lists stay small.

sizes.py REPOSITORY [--list N]
Measures by universal-ctags. Lines of a function are those from its name to its closing brace. Constants of a class are
no data members. --list prints the N largest of each kind and per folder.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
from collections import Counter, defaultdict

FOLDERS = ("runtime", "bake", "compress", "cli", "examples", "tests")
MOST_LINES = 60  # per function
MOST_LINES_OF_99_PERCENT = 45  # limit for 99 % of the functions of a folder
MOST_MEMBERS = 12
MOST_PARAMETERS = 7
PARAMETERS_GIVEN = {"keep_encoded",  # by tinygltf, which calls it
                    "prt_light_from_lat_long"}  # by C, which has no spans


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
    """Counts what commas part at the outermost level of `(a, b<c, d>, e = {f, g})`."""
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
    """The size that 99 % of them do not pass."""
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
        place = f"{tag['path']}:{tag['line']} {tag['name']}"
        folder = tag["path"].split("/")[0]
        if tag["kind"] == "function":
            lines[folder].append((tag.get("end", tag["line"]) - tag["line"] + 1, place))
        if tag["kind"] in ("function", "prototype") and "signature" in tag and tag["name"] not in PARAMETERS_GIVEN:
            parameters.append((parameter_count(tag["signature"]), place))
        if tag["kind"] == "member" and "static" not in tag.get("properties", ""):
            members[f"{tag['path']} {tag['scope']}"] += 1

    if not lines:
        sys.exit("no functions found")
    wrong = []
    for folder, found in sorted(lines.items()):
        common = largest_allowed([size for size, _ in found])
        if arguments.list:
            print(f"{folder}: {len(found)} functions, 99 % at most {common} lines, longest {max(found)[0]}")
            for size, place in sorted(found, reverse=True)[:arguments.list]:
                print(f"    {size} {place}")
        if common > MOST_LINES_OF_99_PERCENT:
            wrong.append(f"{folder}: more than 1 % of the functions are longer than {MOST_LINES_OF_99_PERCENT} lines ({common})")
        wrong += [f"{place}: {size} lines, at most {MOST_LINES}" for size, place in found if size > MOST_LINES]
    if arguments.list:
        print("members:", *[f"    {count} {name}" for name, count in members.most_common(arguments.list)], sep="\n")
        print("parameters:", *[f"    {count} {place}" for count, place in sorted(parameters, reverse=True)[:arguments.list]], sep="\n")
    wrong += [f"{name}: {count} data members, at most {MOST_MEMBERS}" for name, count in members.items() if count > MOST_MEMBERS]
    wrong += [f"{place}: {count} parameters, at most {MOST_PARAMETERS}" for count, place in parameters if count > MOST_PARAMETERS]
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
