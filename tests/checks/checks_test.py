#!/usr/bin/env python3
"""Tests that each check reports violations and accepts valid code."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).parent


def failures(check, files):
    """Returns exit status and output lines of a check on a repository with these files."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        result = subprocess.run([sys.executable, FOLDER / check, root], capture_output=True, text=True)
        return result.returncode, result.stdout.splitlines()


HEADERS = {"runtime/include/prt/sh.h": "", "bake/include/prt/bake.h": "", "bake/scene/surfaces.h": "",
           "compress/include/prt/compress.h": ""}


class IncludeArrows(unittest.TestCase):
    def check(self, path, text):
        return failures("include_arrows.py", {**HEADERS, path: text})

    def test_accept_allowed_includes(self):
        for path, include in [("runtime/sh/sh.cpp", "<glm/vec3.hpp>"), ("runtime/sh/sh.cpp", "<vector>"),
                              ("bake/bake.cpp", '"prt/sh.h"'), ("bake/bake.cpp", '"scene/surfaces.h"'),
                              ("cli/main.cpp", '"prt/compress.h"'), ("examples/viewer/a.cpp", '"prt/bake.h"')]:
            self.assertEqual(self.check(path, f"#include {include}\n"), (0, []))

    def test_reject_includes_in_the_wrong_direction(self):
        for path, include in [("runtime/sh/sh.cpp", '"prt/bake.h"'), ("runtime/sh/sh.cpp", "<Eigen/Core>"),
                              ("runtime/light/light.cpp", "<nlohmann/json.hpp>"), ("bake/bake.cpp", '"prt/compress.h"'),
                              ("compress/search.cpp", '"prt/bake.h"'), ("examples/viewer/a.cpp", '"scene/surfaces.h"'),
                              ("bake/bake.cpp", "<boost/any.hpp>")]:
            status, lines = self.check(path, f"#include {include}\n")
            self.assertEqual((status, len(lines)), (1, 1), (path, include))

    def test_reject_unknown_folders(self):
        self.assertEqual(self.check("examples/new/main.cpp", "")[0], 1)


class Sizes(unittest.TestCase):
    def check(self, text):
        return failures("sizes.py", {"bake/a.cpp": text, "bake/b.cpp": "int f() {\n    return 1;\n}\n" * 200})

    def test_accept_sixty_lines_twelve_members_seven_parameters(self):
        members = "".join(f"    int m{i};\n" for i in range(12)) + "    static int shared;\n    static constexpr int kMax = 3;\n"
        self.assertEqual(self.check("int f(int a, std::map<int, int> b, int c, int d, int e, int g, int h) {\n" + "    ++a;\n" * 58
                                    + "}\nstruct S {\n" + members + "};\n"), (0, []))

    def test_reject_long_functions(self):
        self.assertEqual(self.check("int f() {\n" + "    g();\n" * 59 + "}\n")[0], 1)

    def test_reject_many_functions_of_medium_length(self):
        self.assertEqual(self.check(("int f() {\n" + "    g();\n" * 44 + "}\n") * 4)[0], 1)

    def test_reject_many_members(self):
        self.assertEqual(self.check("void f() {}\nclass C {\n    int a, b, c, d;\n    double* e;\n    int g[3], h = 1, i{2};\n"
                                    "    std::function<void(int, int)> j;\n    C& k;\n    int l, m, n;\n};\n")[0], 1)

    def test_reject_many_parameters(self):
        self.assertEqual(self.check("void f(int a, int b, int c, int d, int e, int g, int h, int i = 2);\nvoid g() {}\n")[0], 1)


if __name__ == "__main__":
    unittest.main()
