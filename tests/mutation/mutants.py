"""Small changes that make code wrong, each of one token (R. DeMillo, R. Lipton, F. Sayward, "Hints on Test Data
Selection", 1978: tests that see the small ones see most of the large ones)."""
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


# Operators with a blank on both sides, as the formatter writes them; pointers, references and templates have
# none.
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "&&": "||", "||": "&&", "&": "|", "|": "&", "<<": ">>", ">>": "<<",
             "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "===": "!==", "!==": "==="}
NAMES = {"true": "false", "false": "true", "min": "max", "max": "min", "sin": "cos", "cos": "sin", "floor": "ceil",
         "ceil": "floor", "begin": "end", "first": "second", "second": "first", "break": "continue"}
MEMBERS = {"x": "y", "y": "z", "z": "x", "u": "v", "v": "u", "r": "g", "g": "b", "b": "r"}
SKIPPED_BEFORE = {"template", "using", "namespace", "typename", "case"}


def changed_number(text):
    """One more, and from 1 on as often one less in the end: twice as much where it has a point."""
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
    """What a token may become. `before`: the text of the token before it; `spaced`: blanks stand round it."""
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
    """All of a file, in its order."""
    before = ""
    for token in tokens(source):
        spaced = source[token.begin - 1:token.begin].isspace() and source[token.end:token.end + 1].isspace()
        if before not in SKIPPED_BEFORE:
            for after in changes(token, before, spaced):
                yield Mutant(path, token.begin, source.count("\n", 0, token.begin) + 1, token.text, after)
        before = token.text
