#!/usr/bin/env python3
"""Tests that each check reports violations and accepts valid code."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).parent
sys.path.insert(0, str(FOLDER))
from tidy_commands import code_of  # noqa: E402


def failures(check, files):
    """Returns exit status and output lines of a check on a repository with these files."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        result = subprocess.run([sys.executable, FOLDER / check, root], capture_output=True, text=True)
        return result.returncode, result.stdout.splitlines()


HEADERS = {"runtime/include/prt/core/sh.h": "", "bake/include/prt/bake/bake.h": "", "bake/scene/surfaces.h": "",
           "compress/include/prt/compress/compress.h": "", "runtime/core/sh/sh.cpp": "", "bake/pipeline/bake.cpp": "",
           "compress/pipeline/compress.cpp": ""}


class IncludeArrows(unittest.TestCase):
    def check(self, path, text):
        return failures("include_arrows.py", {**HEADERS, path: text})

    def test_accept_allowed_includes(self):
        for path, include in [("runtime/core/sh/sh.cpp", "<glm/vec3.hpp>"), ("runtime/core/sh/sh.cpp", "<vector>"),
                              ("bake/pipeline/bake.cpp", '"prt/core/sh.h"'), ("bake/pipeline/bake.cpp", '"bake/scene/surfaces.h"'),
                              ("cli/main.cpp", '"prt/compress/compress.h"'), ("examples/viewer/a.cpp", '"prt/bake/bake.h"')]:
            self.assertEqual(self.check(path, f"#include {include}\n"), (0, []))

    def test_reject_includes_in_the_wrong_direction(self):
        for path, include in [("runtime/core/sh/sh.cpp", '"prt/bake/bake.h"'), ("runtime/core/sh/sh.cpp", "<Eigen/Core>"),
                              ("runtime/core/light/light.cpp", "<nlohmann/json.hpp>"), ("bake/pipeline/bake.cpp", '"prt/compress/compress.h"'),
                              ("compress/search.cpp", '"prt/bake/bake.h"'), ("examples/game/a.cpp", '"bake/scene/surfaces.h"'),
                              ("bake/pipeline/bake.cpp", "<boost/any.hpp>")]:
            status, lines = self.check(path, f"#include {include}\n")
            self.assertEqual((status, len(lines)), (1, 1), (path, include))

    def test_reject_higher_layers(self):
        self.assertEqual(self.check("bake/pipeline/bake.cpp", '#include "bake/scene/surfaces.h"\n'), (0, []))
        files = {**HEADERS, "bake/plan/plan.h": "", "bake/scene/rays.cpp": '#include "bake/plan/plan.h"\n'}
        self.assertEqual(failures("include_arrows.py", files)[0], 1)
        files = {**HEADERS, "bake/plan/plan.cpp": "", "bake/include/prt/bake/plan.h": "", "bake/scene/rays.cpp": '#include "prt/bake/plan.h"\n'}
        self.assertEqual(failures("include_arrows.py", files)[0], 1)

    def test_reject_private_and_unstable_headers_in_public_ones(self):
        files = {**HEADERS, "bake/pipeline/a.h": "", "bake/include/prt/bake/bake.h": '#include "bake/pipeline/a.h"\n'}
        self.assertEqual(failures("include_arrows.py", files)[0], 1)
        stable = {"runtime/include/prt/core/sh.h": "// A. Stable.\n", "runtime/core/sh/light.cpp": "",
                  "runtime/include/prt/core/light.h": '// B. Stable.\n#include "prt/core/sh.h"\n'}
        self.assertEqual(failures("include_arrows.py", {**HEADERS, **stable}), (0, []))
        stable["runtime/include/prt/core/sh.h"] = "// A. Experimental.\n"
        self.assertEqual(failures("include_arrows.py", {**HEADERS, **stable})[0], 1)

    def test_reject_circles_of_folders(self):
        files = {**HEADERS, "cli/a/a.h": '#include "cli/b/b.h"\n', "cli/b/b.h": '#include "cli/c/c.h"\n', "cli/c/c.h": ""}
        self.assertEqual(failures("include_arrows.py", files), (0, []))
        files["cli/c/c.h"] = '#include "cli/a/a.h"\n'
        status, lines = failures("include_arrows.py", files)
        self.assertEqual((status, lines), (1, ["cli/a, cli/b, cli/c: include each other in a circle"]))

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


class Words(unittest.TestCase):
    HEADER = "runtime/include/prt/a.h"

    def found(self, path, text):
        """Line and words of each fault, as the check prints them."""
        status, lines = failures("words.py", {"README.md": "", path: text})
        self.assertEqual(status, 1 if lines else 0)
        faults = []
        for line in lines:
            name, number, words, instead = line.split(":", 3)
            self.assertEqual((name, instead[:7]), (path, " write "))
            faults.append((int(number), words.strip(" '")))
        return faults

    def test_find_first_words_of_comments_and_sentences(self):
        for word in ("Of", "What", "Where", "Who", "Those", "As", "So", "Gives", "Tells"):
            self.assertIn((2, f"{word} ..."), self.found(self.HEADER, f"int a;\n/// {word} the light.\nint b;\n"))
            self.assertIn((2, f"{word} ..."), self.found(self.HEADER, f"// Light is\n// white. {word} the light.\n"))
        self.assertEqual(self.found(self.HEADER, "int a; ///< of the map\nint b; ///< what it is\n"),
                         [(1, "of ..."), (2, "what ...")])
        self.assertEqual(self.found(self.HEADER, "// Names a light.\n//\n// of suns\nint a;\n/* where it is */\n"),
                         [(3, "of ..."), (5, "where ...")])

    def test_find_words(self):
        for words in ("told", "tells of", "tells us of", "apart", "so many", "as many", "are none", "is such", "is no lamp", "lies on",
                      "stands", "stand-in", "whatever", "knows no", "who", "place", "places", "turned", "says", "of its own", "alike",
                      "beside", "but for", "otherwise by", "errs", "pays", "comes to", "lean", "openness", "guides"):
            self.assertEqual(self.found(self.HEADER, f"/// Light {words} rest.\nint a;\n"), [(1, words)])
        self.assertEqual(self.found(self.HEADER, "/// Light is\n/// as\n/// many, too.\n"), [(2, "as many"), (3, "too")])

    def test_find_names_in_all_sources(self):
        self.assertEqual(self.found("tests/a.cpp", "int a;\nint b = kMostRays + kLeast;\n"), [(2, "kMostRays")])

    def test_read_strings_of_programs(self):
        for path in ("cli/a.cpp", "bake/b/a.cpp", "compress/a.h", "runtime/a/b.cpp", "examples/viewer/a/b.cpp"):
            self.assertEqual(self.found(path, 'f(1\'000, "a \\"lamp\\" "\n  "is told"); // told\n'), [(2, "told")])
        self.assertEqual(self.found("cli/a.cpp", 'f("what it is"); g("Light.\\nOf suns");\n'), [(1, "Of ..."), (1, "what ...")])
        self.assertEqual(self.found("runtime/a.cpp", 'auto a = R"(float b;\n// What it is\n)";\n'), [(2, "What ...")])

    def test_read_shaders_and_documents(self):
        self.assertEqual(self.found("shaders/prt_a.glsl", "float a; // of suns\n"), [(1, "of ...")])
        self.assertEqual(self.found("docs/a.md", "# Light\nIt is\ntold.\n\n- What it is\n\n| light | what it is |\n"),
                         [(3, "told"), (5, "What ..."), (7, "what ...")])

    def test_allow_plain_texts(self):
        for path, text in [
                (self.HEADER, "// Returns the light of suns, where it is known; at most\n// of 9 bands. What it is is not here?\nint turn;\n"),
                (self.HEADER, "/// Users who edit in place turn it off: `told` takes place in turn.\n/// There is no lamp.\n/// There is none.\n/// Places the probes.\n"),
                (self.HEADER, "#include <told.h>\n"),
                ("bake/scene/a.h", "// told\n"), ("shaders/bake_a.glsl", "// told\n"), ("docs/deep/a.md", "told\n"),
                ("cli/a.cpp", 'f(name + " of suns", b ? "what" : "of it"); // told\n'),
                ("docs/a.md", "```\ntold\n```\nSee `told`, [why](told.md), $apart$.\n\n| what | where |\n|---|---|\n| of suns | as baked |\n\nwhere D is"),
                ("build/a.md", "told\n")]:
            self.assertEqual(self.found(path, text), [], (path, text))


class ChangedCode(unittest.TestCase):
    CODE = '#include "a.h"\nint f(int part) { return part + g("text"); } // why\n'

    def test_ignores_names_texts_comments_and_includes(self):
        same = '#include "b.h"\n/// Returns it.\nint f(int term)\n{ return term + h("other " "words"); }\n'
        self.assertEqual(code_of(self.CODE), code_of(same))

    def test_sees_every_other_change(self):
        for old, new in [("part + g", "g + part"), ("+", "-"), ("return part", "return f"), ("// why", "// NOLINT"),
                         ('"text"', '"text", 1'), ("int part", "int part = 0")]:
            self.assertNotEqual(code_of(self.CODE), code_of(self.CODE.replace(old, new)), (old, new))


if __name__ == "__main__":
    unittest.main()
