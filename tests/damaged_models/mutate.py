#!/usr/bin/env python3
"""Runs prt on models with one or a few errors, and reports failures.

mutate.py PRT SCENE.glb... [--cases N] [--first I] [--seed S] [--jobs J] [--keep FOLDER]
The scenes are baked and compressed first. Then every case changes one of these files (mutations.py) and passes it to one
command. Case I of seed S is always the same. A case passes if
- the status is 0 or 1, without a sanitizer report, in bounded time and memory;
- with status 1, one line on stderr gives the reason, and no output remains;
- with status 0, the output can be read again, and every figure is finite;
- the program prints only printable characters and no internal name of a library.
Other cases are printed, and their files are stored in --keep. The exit status is 1 if a case fails.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

from mutations import mutate

SECONDS = 60  # limit for one command, sanitized, on a busy machine; an idle machine needs a few seconds
ENVIRONMENT = dict(os.environ, UBSAN_OPTIONS="print_stacktrace=1",
                   ASAN_OPTIONS="detect_leaks=0:quarantine_size_mb=16:hard_rss_limit_mb=1024:max_allocation_size_mb=512")
INNER = re.compile(r"std::|vector::|basic_string|\[json\.exception|terminate called|Assertion|Sanitizer|runtime error")
NO_NUMBER = re.compile(r"(?<![\w./-])-?(nan|inf)(?![\w./-])")
NULLS = {"seam_position_metres", "relative_l2", "standard_error"}  # null if there is no seam, or no light to compare with
LIGHT = {"prtkit_light": 1, "order": 3, "coefficients": {channel: [3] + [0.1] * 8 for channel in ("red", "green", "blue")}}  # of the same order as the bakes

# Commands for each kind of file: {file} is the changed one, {baked} and {shipped} are the original files.
SCENE = [["info", "{file}"],
         ["bake", "{file}", "-o", "out.glb", "--rays", "4", "--order", "2", "--device", "cpu"],
         ["bake", "{file}", "-o", "out.glb", "--rays", "4", "--order", "2", "--device", "cpu", "--bounces", "1"],
         ["render", "{file}", "--lights", "light.json", "-o", "out.exr", "--size", "16x8", "--samples", "1", "--device", "cpu"]]
COMPRESS = ["compress", "{file}", "-o", "out.glb"]
# Commands that copy the content of a file.
AO = ["ao", "{file}", "-o", "out.glb", "--rays", "4", "--device", "cpu"]
PASS_ON = [AO, AO + ["--occluders"], AO + ["--texels", "32", "--texels", "unwrap"],
           ["lobes", "{file}", "-o", "out.glb", "--rays", "4", "--poses", "1", "--poses", "frames=1", "--device", "cpu"]]
RELIGHT = ["relight", "{file}", "--lights", "light.json", "-o", "out.glb"]
MAKE = ["make", "{file}", "-o", "out.glb", "--lights", "light.json", "--max-error", "0.5", "--seconds", "0.1", "--best-effort"]
SCENE += [["info", "{file}", "--check"], MAKE] + PASS_ON
BAKED = SCENE[:2] + SCENE[3:4] + PASS_ON + [RELIGHT] + [COMPRESS, COMPRESS + ["--meshopt"], COMPRESS + ["--reorder"],
                                 COMPRESS + ["--bits", "float", "--preset", "custom", "--clusters", "3", "--components", "2"],
                                 ["evaluate", "{file}", "{shipped}"]]
SHIPPED = SCENE[:1] + SCENE[3:4] + PASS_ON + [["evaluate", "{baked}", "{file}"], ["shader", "{file}", "-o", "out.vert"],
                                              RELIGHT] + SCENE[1:2]
# Commands for files of occlusion volumes and lobes.
KEPT = SCENE[:1] + PASS_ON + SCENE[1:2]
# Commands for files of texels.
RAW_TEXELS = SCENE[:1] + SCENE[3:4] + PASS_ON + [COMPRESS, COMPRESS + ["--preset", "custom", "--clusters", "3", "--components", "2"],
                                      ["evaluate", "{file}", "{shipped}"]]
TEXELS = SCENE[:1] + SCENE[3:4] + PASS_ON + [["evaluate", "{baked}", "{file}"], ["shader", "{file}", "-o", "out.comp"],
                                  ["shader", "{file}", "-o", "out.frag", "--stage", "fragment"]] + SCENE[1:2]
SHIPMENTS = [["--meshopt"], ["--preset", "custom", "--bits", "float", "--clusters", "2", "--components", "3"], ["--preset", "u64", "--reorder"],
             ["--preset", "u32x4", "--predictors", "position"],
             ["--preset", "custom", "--bits", "float", "--clusters", "2", "--components", "3", "--predictors", "position"]]


class Bases:
    """The source files of cases: scenes, their bakes and their compressed files."""

    def __init__(self, program, scenes, folder):
        self.files = []
        for scene in scenes:
            baked = folder / f"{scene.stem}.baked.glb"
            self.make(program, ["bake", scene, "-o", baked, "--rays", "16", "--order", "3", "--device", "cpu", "--storage",
                                "float16" if len(self.files) % 2 else "float32"])
            shipped = [folder / f"{scene.stem}.{i}.glb" for i in range(len(SHIPMENTS))]
            for path, options in zip(shipped, SHIPMENTS):
                self.make(program, ["compress", baked, "-o", path, *options])
            names = {"baked": str(baked), "shipped": str(shipped[0])}
            self.files += [(scene.read_bytes(), SCENE, names)] * 2 + [(baked.read_bytes(), BAKED, names)] * 3
            self.files += [(path.read_bytes(), SHIPPED, names) for path in shipped]
            self.add_lightmap(program, scene, folder)
            self.add_kept(program, scene, folder)

    def add_kept(self, program, scene, folder):
        """Adds files with occlusion volumes and, for animated scenes, with lobes."""
        for name, options in (("volume", ["ao", "--occluders"]), ("lobes", ["lobes", "--poses", "1", "--poses", "frames=0"])):
            path = folder / f"{scene.stem}.{name}.glb"
            done = subprocess.run([program, options[0], scene, "-o", path, *options[1:], "--rays", "4", "--device", "cpu"], check=False,
                                  env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            if done.returncode == 0:
                self.files.append((path.read_bytes(), KEPT, {}))

    def add_lightmap(self, program, scene, folder):
        """Adds lightmap files if the materials of the scene support them."""
        names = {name: str(folder / f"{scene.stem}.texels.{name}.glb") for name in ("baked", "shipped")}
        bake = [program, "bake", scene, "-o", names["baked"], "--texels", "32", "--texels", "unwrap", "--rays", "4", "--order", "2", "--device", "cpu"]
        if subprocess.run(bake, check=False, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode != 0:
            return
        self.make(program, ["compress", names["baked"], "-o", names["shipped"], "--preset", "u64"])
        self.files += [(pathlib.Path(names[name]).read_bytes(), commands, names)
                       for name, commands in (("baked", RAW_TEXELS), ("shipped", TEXELS)) for _ in range(2)]

    @staticmethod
    def make(program, arguments):
        subprocess.run([program, *map(str, arguments)], check=True, env=ENVIRONMENT, stdout=subprocess.DEVNULL)


def run(program, arguments, folder):
    """Returns status, stdout and stderr; the status is -1 after the time limit."""
    try:
        done = subprocess.run([program, *arguments], cwd=folder, env=ENVIRONMENT, capture_output=True, timeout=SECONDS,
                              stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout, done.stderr
    except subprocess.TimeoutExpired:
        return -1, b"", b""


def wrong_text(data):
    """Returns the first error of a text for users, or None."""
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return "prints text that is not UTF-8"
    odd = [c for c in text.replace("\n", "") if not c.isprintable()]
    if odd:
        return f"prints {odd[0]!r}"
    inner = INNER.search(text)
    return f"prints '{inner.group()}'" if inner else None


def shortened(error):
    """Returns the lines of a report with the error and its position in our sources, or the end of the report."""
    lines = [line for line in error.decode(errors="backslashreplace").splitlines()
             if re.search(r"prt: error|ERROR:|runtime error|SUMMARY|terminate called|Assertion| in prt::", line)]
    return "\n    ".join(line.strip()[:240] for line in lines[:8]) or error.decode(errors="backslashreplace")[-500:]


def nulls(report, name=""):
    """Yields the names of members that are null."""
    if report is None:
        yield name
    for key, value in report.items() if isinstance(report, dict) else enumerate(report) if isinstance(report, list) else ():
        yield from nulls(value, key if isinstance(key, str) else name)


def numbers_are_finite(path):
    """Raises ValueError if a figure of a report is missing or not finite (null in JSON)."""
    def refuse(word):
        raise ValueError(f"{path.name} contains {word}")
    report = json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
    for name in set(nulls(report)) - NULLS:
        refuse(f"null for {name}")


def wrong_output(program, folder):
    """Returns the first error of the output of a command with status 0, or None."""
    try:
        for path in folder.glob("*.report.json"):
            numbers_are_finite(path)
    except ValueError as error:
        return str(error)
    for name, reader in (("out.glb", ["info", "out.glb"]), ("out.exr", ["project", "out.exr", "-o", "check.json"])):
        if (folder / name).exists():
            status, _, error = run(program, reader, folder)
            if status != 0:
                return f"{name} cannot be read again: {error.decode(errors='replace').strip()}"
    return None


def finding(program, arguments, folder, before):
    """Runs a command and returns its error, or None."""
    status, out, error = run(program, arguments, folder)
    if status not in (0, 1):
        return "takes too long" if status == -1 else f"ends with {status}: " + shortened(error)
    wrong = wrong_text(out) or wrong_text(error)
    if wrong:
        return wrong + ": " + shortened(error)
    if status == 0:
        if NO_NUMBER.search(out.decode()):
            return "prints a figure that is not finite: " + out.decode()
        return wrong_output(program, folder)
    if "--check" in arguments and b"check: " in out:
        return None
    lines = [line for line in error.decode().splitlines() if line.startswith("prt: error")]
    if len(lines) != 1 or not error.endswith((lines[0] + "\n").encode()):
        return f"prints {len(lines)} error lines: {error.decode()}"
    left = sorted(path.name for path in folder.iterdir() if path.name not in before)
    return f"leaves {left} with status 1: {lines[0]}" if left else None


def check_case(program, bases, seed, case, keep):
    """Creates and checks a case. Returns the line to print if it fails, else None."""
    choose = random.Random(f"{seed} {case}")
    data, commands, names = choose.choice(bases.files)
    command = choose.choice(commands)
    changed = mutate(choose, data)
    with tempfile.TemporaryDirectory(prefix="prt-mutate-") as name:
        folder = pathlib.Path(name)
        (folder / "case.glb").write_bytes(changed)
        (folder / "light.json").write_text(json.dumps(LIGHT), encoding="utf-8")
        arguments = [part.format(file="case.glb", **names) for part in command]
        if command[0] != "shader":
            arguments += ["--json", "case.report.json"]
        before = {"case.glb", "light.json"}
        wrong = finding(program, arguments, folder, before)
        if wrong is None and (folder / "case.glb").read_bytes() != changed:
            wrong = "changed its input"
    if wrong is None:
        return None
    if keep:
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{seed}-{case}.glb").write_bytes(changed)
    return f"case {case}: prt {' '.join(arguments)}: {wrong}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("scenes", type=pathlib.Path, nargs="+")
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    found = 0
    with tempfile.TemporaryDirectory(prefix="prt-mutate-") as folder:
        bases = Bases(program, [scene.resolve() for scene in arguments.scenes], pathlib.Path(folder))
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as workers:
            cases = range(arguments.first, arguments.first + arguments.cases)
            for line in workers.map(lambda case: check_case(program, bases, arguments.seed, case, arguments.keep), cases):
                if line:
                    found += 1
                    print(line, flush=True)
    print(f"{arguments.cases} cases, {found} findings")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
