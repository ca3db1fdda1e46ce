#!/usr/bin/env python3
"""Checks that texts for users are written in plain technical English.

words.py REPOSITORY
Reads comments of public headers and public shaders, string literals of the libraries, of `prt` and of the viewer, the
README files and the documents. Prints `file:line: 'words': write ...` for each construction that the tables below
reject. Skips `code` in backticks and code blocks of documents. Checks names of constants in all sources.
"""
import bisect
import pathlib
import re
import sys

HEADERS = ("**/include/prt/**/*.h",)
SHADERS = ("shaders/prt_*", "shaders/shared_*")  # `prt shader` writes these and strings of runtime/shader
PROGRAMS = ("runtime/**/*", "bake/**/*", "compress/**/*", "cli/**/*", "examples/viewer/**/*")
DOCUMENTS = ("README.md", "docs/*.md", "examples/*/README.md")
SOURCES = (*PROGRAMS, "examples/**/*", "shaders/*", "tests/**/*")

# First words that no sentence may have: what to write instead.
BEGINNINGS = {
    "of": "the thing first ('Number of ...') or a verb ('Returns ...')",
    "what": "the noun",
    "where": "'If ...', or the position first",
    "who": "'Users who ...', or the part of the program",
    "those": "the noun",
    "as": "'Like ...', 'Because ...', or the subject first",
    "so": "'Therefore ...', or the subject first",
    "gives": "'Returns ...'",
    "tells": "'Returns whether ...', 'Reports ...'",
}

# Words that no text may have, as regular expressions without regard to case: what to write instead.
WORDS = {
    r"told|tells?( \w+)? of": "'reported', 'passed', 'shows'",
    r"apart": "'separate', 'separately', 'at a distance of'",
    r"(so|as) many": "'a number of', 'the same number of'",
    r"(is|are|was|were) none": "'does not exist', 'is missing', 'is invalid'",
    r"(is|are|was|were) such": "the property itself",
    r"(is|are|was|were) no \w+": "'is not a ...', 'is invalid'",
    r"(lies?|lay) on": "'is on'",
    r"stands?|stood": "'is', 'is stored'",
    r"stand-ins?": "'proxy'",
    r"whatever": "'any'",
    r"knows? (no|nothing|of|about)": "'does not support', 'does not use'",
    r"who": "'which'",
    r"places?": "'position', 'location', 'slot', 'instead of'",
    r"turn(s|ed|ing)?": "'rotate', 'rotation', 'become', 'convert'",
    r"says?|said|saying": "'reports', 'states', 'defines', 'shows'",
    r"of (its|their) own": "'its own ...', 'separate'",
    r"alike": "'equal', 'the same'",
    r"beside": "'next to', 'in addition to'",
    r"but for": "'except'",
    r"otherwise by": "'default: by ...'",
    r"too(?=[.,;:)]|$)": "'also'",
    r"errs?|erred": "'has an error of'",
    r"pays?|paid": "'is worth', 'reduces ...'",
    r"comes? to": "'is', 'becomes'",
    r"lean": "'mean blocked direction'",
    r"openness": "'ambient visibility'",
    r"guides?": "'predictor'; 'documentation' for a text",
    r"the (most|least)(?=[.,;:)]|$)": "'the largest', 'the smallest'",
}

# Phrases with such words that are plain English.
ALLOWED = re.compile("|".join((
    r"\b(users?|people|readers?|anyone|everyone|someone) who\b",
    r"\bthere (is|are|was|were) (no|none|such)\b",
    r"\b(is|are) no (longer|more)\b",
    r"(^|(?<=[.!?] ))Places? (?=(the|a|an|each|all)\b)",
    r"\b(in|into) place\b(?! of)",
    r"\b(takes?|taking|took) place\b",
    r"\bdecimal places?\b",
    r"\bin turn\b",
    r"\bturn(s|ed|ing)? (it |them )?(on|off)\b",
    r"\bstands? for\b",
    r"\bthat is to say\b",
    r"\b(so|as) many( \w+)? as possible\b",
)), re.IGNORECASE)

NAMES = re.compile(r"\bk(Most|Least|Largest|Smallest)[A-Z]\w*")

# (file, words as printed): why they are allowed there.
EXCEPTIONS = {}

BEGINNING = re.compile(rf"(?:^|(?<=[.!?]) )[(*_\"]*({'|'.join(BEGINNINGS)})(?= )", re.IGNORECASE)
CODE = re.compile(r"`[^`]*`")
ANYWHERE = [(re.compile(rf"(?<![\w-])({words})(?![\w-])", re.IGNORECASE), instead) for words, instead in WORDS.items()]
TOKENS = re.compile(r"""(?P<comment>//[^\n]*|/\*.*?\*/)|R"(?P<mark>[^\s(]*)\((?P<raw>.*?)\)(?P=mark)"|(?P<include>\#\s*include[^\n]*)"""
                    r"""|"(?P<string>(?:\\.|[^"\\\n])*)"|(?<=\d)'(?=\d)|'(?:\\.|[^'\\\n])*'""", re.DOTALL)


class Text:
    """A comment, a string or a paragraph that reaches over one line or more."""

    def __init__(self, is_fragment=False):
        self.words = ""
        self.is_fragment = is_fragment  # it may continue a sentence
        self.starts, self.lines = [], []

    def add(self, line, words):
        words = " ".join(words.split())
        self.starts.append(len(self.words) + bool(self.words))
        self.lines.append(line)
        self.words = f"{self.words} {words}" if self.words else words

    def line_of(self, position):
        return self.lines[bisect.bisect_right(self.starts, position) - 1]


def comments(source):
    """Comments of C++ or GLSL. Comment lines without code between them are one text; an empty one separates texts."""
    texts, end, trailing = [], None, False
    for token in TOKENS.finditer(source):
        if not token["comment"]:
            continue
        line = source.count("\n", 0, token.start()) + 1
        between = None if end is None else source[end:token.start()]
        continues = between is not None and between.count("\n") == 1 and not between.strip()
        before = source[source.rfind("\n", 0, token.start()) + 1:token.start()].strip()
        if trailing and not token["comment"].startswith("///<"):
            continues = False
        if before or not continues:
            trailing = bool(before)
        for number, words in enumerate(token["comment"].strip("/*<").split("\n")):
            words = words.strip(" *<")
            if not continues or not words:
                texts.append(Text())
            texts[-1].add(line + number, words)
            continues = True
        end = token.end()
    return texts


def strings(source):
    """String literals of C++; adjacent ones are one text. A `//` comment in a raw string (GLSL) begins a text."""
    texts, end = [], None
    for token in TOKENS.finditer(source):
        words = token["string"] if token["string"] is not None else token["raw"]
        if words is None:
            continue
        if end is None or source[end:token.start()].strip():
            before = source[:token.start()].rstrip()[-1:]
            texts.append(Text(is_fragment=before not in ("(", "{", ",", "=") or words.startswith(" ")))
        line = source.count("\n", 0, token.start()) + 1
        for number, part in enumerate(re.sub(r"\\[nt]", "  ", words).split("\n")):
            if number and "//" in part:
                texts.append(Text())
            texts[-1].add(line + number, part.replace("//", " "))
        end = token.end()
    return texts


def paragraphs(document):
    """Paragraphs, list items, headings and table cells of Markdown, without code. Cells may be noun phrases."""
    texts, fenced, open_paragraph = [], False, False
    for number, line in enumerate(document.split("\n"), 1):
        if line.lstrip().startswith("```"):
            fenced, open_paragraph = not fenced, False
            continue
        if fenced:
            continue
        line = re.sub(r"\$[^$]+\$", "X", CODE.sub("X", line))
        line = re.sub(r"\]\([^)]*\)|<[^>]*>", "", line).replace("[", "").replace("]", "")
        words = re.sub(r"^\s*([#>*+-]+|\d+\.)\s+", "", line)
        if line.lstrip().startswith("|"):
            for cell in line.strip(" |").split("|"):
                texts.append(Text(is_fragment=not re.match(r"\s*(what|where|who) \S", cell, re.IGNORECASE)))
                texts[-1].add(number, cell)
            open_paragraph = False
        elif not words.strip():
            open_paragraph = False
        else:
            if not open_paragraph or words != line:
                texts.append(Text(is_fragment=words == line and words[0].islower()))  # it may follow an equation
            texts[-1].add(number, words)
            open_paragraph = not line.startswith("#")
    return texts


def faults(text):
    """Yields (line, words, what to write instead) for each rejected construction in `text`."""
    words = text.words
    for plain in (CODE, ALLOWED):
        words = plain.sub(lambda phrase: "_" * len(phrase[0]), words)
    for found in BEGINNING.finditer(words):
        ends = re.search(r"[.!?](?= |$)", words[found.end():])
        is_question = ends and ends[0] == "?"
        if not is_question and not (text.is_fragment and found.start() == 0):
            yield text.line_of(found.start(1)), found[1] + " ...", BEGINNINGS[found[1].lower()] + " at the beginning of a sentence"
    for pattern, instead in ANYWHERE:
        for found in pattern.finditer(words):
            yield text.line_of(found.start()), found[0], instead


def files(root, patterns):
    """Files of the repository that match, without those that builds make."""
    found = {path for pattern in patterns for path in root.glob(pattern)}
    return sorted(path for path in found if path.is_file() and not {"build", "node_modules"} & set(path.relative_to(root).parts))


def sources(root, patterns):
    """Files among these that are C++, C or GLSL."""
    return [path for path in files(root, patterns) if path.suffix in (".h", ".cpp", ".c", ".glsl", ".vert", ".frag", ".comp")]


def main():
    """Prints what is rejected; returns the exit status."""
    root = pathlib.Path(sys.argv[1]).resolve()
    work = [(path, comments) for path in sources(root, HEADERS + SHADERS)]
    work += [(path, strings) for path in sources(root, PROGRAMS)]
    work += [(path, paragraphs) for path in files(root, DOCUMENTS)]
    wrong = set()
    for path, texts_of in work:
        name = str(path.relative_to(root))
        wrong |= {(name, *fault) for text in texts_of(path.read_text(encoding="utf-8")) for fault in faults(text)
                  if (name, fault[1]) not in EXCEPTIONS}
    for path in sources(root, SOURCES):
        source = path.read_text(encoding="utf-8")
        wrong |= {(str(path.relative_to(root)), source.count("\n", 0, name.start()) + 1, name[0], "kMax..., kMin...")
                  for name in NAMES.finditer(source)}
    for name, line, words, instead in sorted(wrong):
        print(f"{name}:{line}: '{words}': write {instead}")
    return 1 if wrong or not work else 0


if __name__ == "__main__":
    sys.exit(main())
