"""Splits C++, GLSL and JavaScript into tokens; knows only as much grammar as mutation needs.

Omits code in which tests cannot detect a change: comments, strings, preprocessor lines, assertions and thrown
exceptions.
"""
import re
from typing import NamedTuple


class Token(NamedTuple):
    kind: str  # "name", "number" or "sign"
    text: str
    begin: int  # offset in the source
    end: int


# Alternatives in the order in which they are tried.
PATTERNS = re.compile(r"""
    (?P<skipped> //[^\n]*(?:\\\n[^\n]*)* | /\*.*?\*/
               # a preprocessor line with its continuation lines
               | ^[ \t]*\#(?:[^\n\\]|\\.)*
               | R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"
               | "(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*' | `(?:[^`\\]|\\.)*` | \s+ )
  | (?P<name> [A-Za-z_$][\w$]* )
  | (?P<number> (?:0[xX][\da-fA-F']+(?:\.[\da-fA-F]*)?(?:[pP][+-]?\d+)? | (?:\d[\d']*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?) [uUlLfFn]* )
  | (?P<sign> <<=|>>=|<=>|===|!==|->\*|\.\.\.|\+\+|--|->|::|&&|\|\||[-+*/%&|^!=<>]=|<<|>>|. )
""", re.VERBOSE | re.MULTILINE | re.DOTALL)

OPENING, CLOSING = "([{", ")]}"


def tokens(source):
    """Returns all tokens in order, except omitted ones."""
    result = [Token(match.lastgroup, match.group(), match.start(), match.end())
              for match in PATTERNS.finditer(source) if match.group("skipped") is None]
    return list(without_messages(result))


def without_messages(all_tokens):
    """Omits assertions (`assert(...)`, `static_assert(...)`) and throw statements up to their semicolon."""
    end_at = None  # end of the omitted part, at its depth
    depth = 0
    for token in all_tokens:
        if end_at is None and token.text in ("assert", "static_assert", "throw"):
            end_at, depth = ";", 0
        if end_at is None:
            yield token
            continue
        depth += (token.text in OPENING) - (token.text in CLOSING)
        if token.text == end_at and depth <= 0:
            end_at = None
