#!/usr/bin/env python3
"""Tests that only code is mutated, that results are correct, and that files are restored."""
import json
import pathlib
import signal
import stat
import subprocess
import sys
import tempfile
import time
import unittest

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER))
from mutants import mutants  # noqa: E402

TOY = """// a + b
#define SUM(a, b) \\
    (a + b)
/// Adds.
int sum(const int* a, int b) {
    static_assert(sizeof(int) >= 4, "a + b");
    if (!a)
        throw Error("1 + 1" + std::to_string(1 + 1));
    return *a + b;
}
"""
# Replaces a test program: sum.cpp must add, and must not loop.
PROGRAM = """#!/bin/sh
grep -q 'a + b;' {root}/runtime/core/sh/sum.cpp && exit 0
echo '[  FAILED  ] Sum.Adds'; exit 1
"""
NINJA = "#!/bin/sh\n! grep -q 'if (a)' {root}/runtime/core/sh/sum.cpp\n"


def changes(source):
    return [(mutant.before, mutant.after) for mutant in mutants("a.cpp", source)]


class Mutants(unittest.TestCase):
    def test_exclude_comments_strings_and_assertions(self):
        self.assertEqual(changes(TOY), [("!", ""), ("+", "-")])

    def test_change_operators_signs_constants_members_and_comparisons(self):
        self.assertEqual(changes("x = -a.u * 0.5f;"), [("-", ""), ("u", "v"), ("*", "/"), ("0.5f", "1.0f")])
        self.assertEqual(changes("i < n && v[1]"), [("<", "<="), ("&&", "||"), ("1", "2"), ("1", "0")])

    def test_exclude_templates_pointers_and_references(self):
        self.assertEqual(changes("std::vector<float*> f(const A& a, B&& b, C* c);"), [])
        self.assertEqual(changes('R"(a + b)" "a + b" \'+\''), [])


class Run(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        self.source = self.root / "runtime/core/sh/sum.cpp"
        self.write(self.source, TOY)
        self.write(self.root / "build/tests/runtime_tests", PROGRAM.format(root=self.root))
        self.write(self.root / "tools/ninja", NINJA.format(root=self.root))

    def tearDown(self):
        self.folder.cleanup()

    @staticmethod
    def write(path, text):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(path.stat().st_mode | stat.S_IXUSR)

    def start(self):
        command = [sys.executable, FOLDER / "mutate.py", self.root, self.root / "build", self.root / "log.jsonl", "runtime"]
        return subprocess.Popen(command, env={"PATH": f"{self.root}/tools:/usr/bin:/bin"}, stdout=subprocess.PIPE, text=True)

    def mutate(self):
        with self.start() as process:
            output = process.communicate()[0]
        self.assertEqual(process.returncode, 0)
        return output, [json.loads(line) for line in (self.root / "log.jsonl").read_text(encoding="utf-8").splitlines()]

    def test_reports_results_and_restores_the_file(self):
        _, lines = self.mutate()
        self.assertEqual([(line["line"], line["before"], line["result"], line.get("by")) for line in lines],
                         [(7, "!", "did not compile", None), (9, "+", "killed", "Sum.Adds")])
        self.assertEqual(self.source.read_text(encoding="utf-8"), TOY)

    def test_continues_an_interrupted_run(self):
        self.mutate()
        log = self.root / "log.jsonl"
        first = log.read_text(encoding="utf-8").splitlines()[0]
        log.write_text(first + "\n", encoding="utf-8")
        _, lines = self.mutate()
        self.assertEqual([line["before"] for line in lines], ["!", "+"])

    def test_restores_the_file_when_stopped(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            self.write(self.root / "build/tests/runtime_tests", PROGRAM.format(root=self.root).replace("exit 1", "sleep 600"))
            with self.start() as process:
                while self.source.read_text(encoding="utf-8") != TOY.replace("*a + b", "*a - b"):
                    time.sleep(0.01)
                process.send_signal(stop)
                output = process.communicate()[0]
            self.assertIn("stopped", output)
            self.assertEqual(self.source.read_text(encoding="utf-8"), TOY)

    def test_lists_survivors(self):
        self.write(self.root / "build/tests/runtime_tests", "#!/bin/sh\n")
        output, _ = self.mutate()
        self.assertIn("runtime/core/sh/sum.cpp:9: '+' -> '-' survived", output)
        self.assertIn("1 survived", output)


if __name__ == "__main__":
    unittest.main()
