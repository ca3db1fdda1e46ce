#!/usr/bin/env python3
"""Writes the compile commands of the sources that clang-tidy checks.

tidy_commands.py BUILD OUTPUT [BASE]
BUILD: a build folder with compile_commands.json. OUTPUT: folder for the new compile_commands.json.
BASE: a commit; selects only sources whose code changed since then, and one source for each header whose code changed.
Default: all sources. Comments do not count as code unless they contain NOLINT; neither do texts of strings, lists of
includes and identifiers that were renamed consistently within a file.
Tests are excluded: two compilers already warn about them, and checking them takes as long as all other sources.
A joined source (CMAKE_UNITY_BUILD) replaces its members if MANY of them changed, because it reads headers once.
"""
import json
import pathlib
import re
import subprocess
import sys

FOLDERS = {"runtime", "bake", "compress", "cli", "examples", "shaders"}
MANY = 3  # number of changed members from which the joined source is cheaper to check


def members(source):
    """Returns the sources that a joined source includes; for other sources the source itself."""
    if "/Unity/" not in source.as_posix():
        return [source.resolve()]
    return [pathlib.Path(name).resolve() for name in re.findall(r'^#include "(.*)"$', source.read_text(), re.M)]


def changed_files(root, base):
    """Returns the files whose code changed since `base`; moved files are compared with their old text."""
    output = subprocess.run(["git", "diff", "--name-status", "--find-renames=30%", "-z", "--diff-filter=d", base,
                             "--", "*.cpp", "*.h"], cwd=root, capture_output=True, text=True, check=True).stdout
    words, old_names = iter(output.split("\0")), {}
    for status in words:
        if status:
            old = next(words)
            old_names[next(words) if status[0] in "RC" else old] = old
    return {root / name for name, old in old_names.items()
            if code_of((root / name).read_text()) != code_of(text_at(root, base, old))}


def text_at(root, base, name):
    """Returns the text of a file in a commit; empty if it does not exist there."""
    return subprocess.run(["git", "show", f"{base}:{name}"], cwd=root, capture_output=True, text=True).stdout


TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|//[^\n]*|/\*.*?\*/|#include[^\n]*|[A-Za-z_]\w*|\s+|.', re.S)


def code_of(text):
    """Returns the tokens of a source that a check can depend on. An identifier is the number of its first occurrence."""
    tokens, numbers = [], {}
    for token in TOKEN.findall(text):
        if token[0] == '"':
            tokens += ['""'] if tokens[-1:] != ['""'] else []  # adjacent strings are one
        elif token.startswith(("//", "/*")):
            tokens += [token] if "NOLINT" in token else []
        elif re.match(r"[A-Za-z_]", token):
            tokens.append(str(numbers.setdefault(token, len(numbers))))
        elif not token.isspace() and not token.startswith("#include"):
            tokens.append(token)
    return tokens


def with_includers(root, changed, sources):
    """Returns the changed sources, and one direct or indirect includer of each changed header that they do not include."""
    files = [path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in (".cpp", ".h")]
    by_name = {}
    for file in files:
        by_name.setdefault(file.name, []).append(file)
    includers = {}
    for file in files:
        for included in re.findall(r'^#include "(.*)"$', file.read_text(), re.M):
            for header in by_name.get(pathlib.Path(included).name, []):
                if header.as_posix().endswith("/" + included.lstrip("./")):
                    includers.setdefault(header, []).append(file)
    result = {file for file in changed if file in sources}
    for header in sorted(file for file in changed if file.suffix == ".h" and file.relative_to(root).parts[0] in FOLDERS):
        reached, queue = set(), [header]
        while queue:
            for file in includers.get(queue.pop(), []):
                if file not in reached:
                    reached.add(file)
                    queue.append(file)
        found = sorted(reached & sources)
        if not found:
            print(f"clang-tidy: no source includes {header.relative_to(root)}")
        elif not reached & result:
            result.add(found[0])
    return result


def main():
    build, output = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    root = pathlib.Path(__file__).resolve().parents[2]
    entries = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["directory"], entry["file"])
        ours = [file for file in members(source) if root in file.parents and root / "tests" not in file.parents
                and build not in file.parents]
        if ours and source.suffix != ".c":
            entries[source] = (entry, ours)
    selected = {file for _, ours in entries.values() for file in ours}
    if len(sys.argv) > 3:
        selected = with_includers(root, changed_files(root, sys.argv[3]), selected)
    commands = []
    for source, (entry, ours) in entries.items():
        chosen = [file for file in ours if file in selected]
        if len(chosen) >= min(MANY, len(ours)):
            commands.append(entry)
        else:
            commands += [{**entry, "file": str(file), "command": entry["command"].replace(str(source), str(file))}
                         for file in chosen]
    if not entries:
        sys.exit(f"{build}/compile_commands.json has no source of {root}")
    output.mkdir(parents=True, exist_ok=True)
    (output / "compile_commands.json").write_text(json.dumps(commands, indent=1))
    print(f"clang-tidy: {len(selected)} sources")


if __name__ == "__main__":
    main()
