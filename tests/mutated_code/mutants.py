"""Generates small errors in code, each of one token (R. DeMillo, R. Lipton, F. Sayward, "Hints on Test Data
Selection", 1978: tests that detect small errors detect most large ones)."""
import re
from typing import NamedTuple

from source_tokens import tokens


class Mutant(NamedTuple):
    path: str  # from the root of the repository
    begin: int  # offset in the source
    line: int
    before: str
    after: str

    def applied_to(self, source):
        end = self.begin + len(self.before)
        if source[self.begin:end] != self.before:
            raise ValueError(f"{self.path}:{self.line} has changed")
        return source[:self.begin] + self.after + source[end:]


# Operators with a blank on both sides, as the formatter writes them; pointers, references and templates have no
# blanks.
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "&&": "||", "||": "&&", "&": "|", "|": "&", "<<": ">>", ">>": "<<",
             "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "===": "!==", "!==": "==="}
NAMES = {"true": "false", "false": "true", "min": "max", "max": "min", "sin": "cos", "cos": "sin", "floor": "ceil",
         "ceil": "floor", "begin": "end", "first": "second", "second": "first", "break": "continue"}
MEMBERS = {"x": "y", "y": "z", "z": "x", "u": "v", "v": "u", "r": "g", "g": "b", "b": "r"}
SKIPPED_BEFORE = {"template", "using", "namespace", "typename", "case"}


def changed_number(text):
    """Returns an integer plus one, or a decimal number times two (1 for 0); None for hexadecimal floats."""
    match = re.fullmatch(r"(\d+)([uUlLn]*)", text)
    if match:
        return f"{int(match[1]) + 1}{match[2]}"
    match = re.fullmatch(r"(\d*\.?\d*(?:[eE][+-]?\d+)?)([fF]?)", text)
    if not match:
        return None  # hexadecimal: bits
    value = float(match[1])
    return f"{2 * value!r}{match[2]}" if value else f"1.0{match[2]}"


def fewer(text):
    match = re.fullmatch(r"([1-9]\d*)([uUlLn]*)", text)
    return f"{int(match[1]) - 1}{match[2]}" if match else None


def changes(token, before, spaced):
    """Returns the replacements of a token. `before`: text of the previous token; `spaced`: has blanks on both sides."""
    text = token.text
    if token.kind == "number":
        return [change for change in (changed_number(text), fewer(text)) if change is not None]
    if token.kind == "name":
        if before == "." and text in MEMBERS:
            return [MEMBERS[text]]
        return [NAMES[text]] if text in NAMES else []
    if text in OPERATORS and spaced:
        return [OPERATORS[text]]
    if text in ("++", "--"):
        return ["--" if text == "++" else "++"]
    if (text == "-" and not spaced) or text == "!":
        return [""]  # a sign
    return []


def mutants(path, source):
    """Yields all mutants of a file, in order."""
    before = ""
    for token in tokens(source):
        spaced = source[token.begin - 1:token.begin].isspace() and source[token.end:token.end + 1].isspace()
        if before not in SKIPPED_BEFORE:
            for after in changes(token, before, spaced):
                yield Mutant(path, token.begin, source.count("\n", 0, token.begin) + 1, token.text, after)
        before = token.text
