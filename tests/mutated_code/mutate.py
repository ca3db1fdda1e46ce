#!/usr/bin/env python3
"""Inserts one error into the code at a time and reports the tests that detect it.

mutate.py REPOSITORY BUILD_DIR LOG.jsonl PATH ... [--count N] [--seed S]
PATH: files or folders of the repository. Mutants are drawn from all of them; the draw depends only on the seed. LOG gets one
line per mutant: its position, the old and new text, and "killed" (by which test), "survived", "timed out" or "did not
compile". Mutants in LOG are not run again. The file is restored after each mutant, also after Ctrl-C; use a copy of the
repository, so that you can work in the original meanwhile.
"""
import argparse
import contextlib
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import time
from collections import Counter

from mutants import mutants
from targets import SUFFIXES, suites_of

MAX_BUILD_SECONDS = 1800
# A test is stopped after this multiple of its normal time, but not before this number of seconds.
TIMES_NORMAL, MIN_LIMIT = 5, 60
MAX_MEMORY = 8 << 30  # bytes of a test program: a mutant may request any amount


def files_of(root, paths):
    for path in paths:
        here = root / path
        for file in [here] if here.is_file() else sorted(here.rglob("*")):
            name = file.relative_to(root).as_posix()
            if file.suffix in SUFFIXES and suites_of(name):
                yield name


@contextlib.contextmanager
def mutated(root, mutant):
    """Applies the mutant for the time of the context. The restored source is newer than the build of the mutant."""
    path = root / mutant.path
    source = path.read_bytes().decode("utf-8")
    try:
        path.write_bytes(mutant.applied_to(source).encode("utf-8"))
        yield
    finally:
        path.write_bytes(source.encode("utf-8"))


def run(command, limit, **options):
    """Returns exit status and output, and ends all processes of the command. The status is None after the time limit."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          start_new_session=True, **options) as process:
        try:
            output = process.communicate(timeout=limit)[0]
            return process.returncode, output
        except subprocess.TimeoutExpired:
            return None, ""
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))


def failed_test(output):
    """Returns the first failed test, or the last one that was started."""
    failed = re.search(r"^\[  FAILED  \] ([^\s,]+)|^not ok \d+ - (.*)", output, re.MULTILINE)
    if failed:
        return failed[1] or failed[2]
    begun = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
    return begun[-1] if begun else ""


class Tests:
    """Builds and runs test suites."""

    def __init__(self, root, build):
        self.root, self.build = root, build
        self.limits = {}

    def built(self, suite):
        if suite.program == "node":
            return True
        return run(["ninja", "-C", str(self.build), suite.program], MAX_BUILD_SECONDS)[0] == 0

    def run_suite(self, suite):
        command = suite.command(self.build, self.root)
        # node reserves more memory than it uses
        options = {} if suite.program == "node" else {"preexec_fn": limit_memory}
        return run(command, self.limits.get(suite, MAX_BUILD_SECONDS), **options)

    def measure(self, suite):
        """Runs a suite without a mutant, which must pass, and measures its time."""
        if suite in self.limits:
            return
        if not self.built(suite):
            sys.exit(f"{suite.program} does not build")
        begin = time.monotonic()
        status, output = self.run_suite(suite)
        if status != 0:
            sys.exit(f"{suite.program} fails without a mutant: {failed_test(output)}\n{output[-2000:]}")
        self.limits[suite] = max(MIN_LIMIT, TIMES_NORMAL * (time.monotonic() - begin))

    def judge(self, mutant):
        suites = suites_of(mutant.path)
        for suite in suites:
            self.measure(suite)
        with mutated(self.root, mutant):
            for suite in suites:
                if not self.built(suite):
                    return {"result": "did not compile"}
                status, output = self.run_suite(suite)
                if status is None:
                    return {"result": "timed out"}
                if status != 0:
                    return {"result": "killed", "by": failed_test(output) or f"{suite.program}: status {status}"}
        return {"result": "survived"}


def key_of(line):
    return (line["path"], line["begin"], line["before"], line["after"])


def summary(log):
    lines = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()] if log.exists() else []
    counts = Counter(line["result"] for line in lines)
    for line in lines:
        if line["result"] == "survived":
            print(f"{line['path']}:{line['line']}: {line['before']!r} -> {line['after']!r} survived")
    print(", ".join(f"{count} {result}" for result, count in counts.most_common()) or "no mutants")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("repository", type=pathlib.Path)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("log", type=pathlib.Path)
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    root = arguments.repository.resolve()
    every = [mutant for name in files_of(root, arguments.paths)
             for mutant in mutants(name, (root / name).read_bytes().decode("utf-8"))]
    random.Random(arguments.seed).shuffle(every)
    done = set()
    if arguments.log.exists():
        done = {key_of(json.loads(line)) for line in arguments.log.read_text(encoding="utf-8").splitlines()}
    drawn = [mutant for mutant in every[:arguments.count] if key_of(mutant._asdict()) not in done]
    tests = Tests(root, arguments.build.resolve())
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # ends as Ctrl-C does
    try:
        for mutant in sorted(drawn):  # mutants of one file are consecutive: each suite is rebuilt once
            line = {**mutant._asdict(), **tests.judge(mutant)}
            with arguments.log.open("a", encoding="utf-8") as log:
                log.write(json.dumps(line) + "\n")
            print(f"{mutant.path}:{mutant.line}: {mutant.before!r} -> {mutant.after!r} {line['result']} {line.get('by', '')}", flush=True)
    except KeyboardInterrupt:
        print("stopped")
    summary(arguments.log)


if __name__ == "__main__":
    main()
