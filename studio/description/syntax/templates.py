"""A text as xacro reads it: cut into what is evaluated and what stands for itself.

The cuts are those of xacro 2.1.1: `${...}` ends at the first `}`, `$(...)` at the first `)`, and
`$${` or `$$(` stands for `${` or `$(`.
"""

from __future__ import annotations

import re
from enum import Enum
from functools import lru_cache
from typing import Final, TypeAlias

from studio.description.faults import Fault, shorten

_SEGMENT: Final = re.compile(
    r"(?P<escaped>\$\$+[{(])|\$\{(?P<expression>[^}]*)\}|\$\((?P<substitution>[^)]*)\)"
    r"|(?P<text>[^$]+|\$[^{($]+|\$$)"
)


class Cut(Enum):
    """Kind of a segment."""

    TEXT = 0
    EXPRESSION = 1
    SUBSTITUTION = 2


Segment: TypeAlias = tuple[Cut, str]
"""The cut and its text without `${ }` or `$( )`."""


@lru_cache(maxsize=20_000)
def segments_of(text: str) -> tuple[Segment, ...]:
    """Cut a text.

    Raises:
        Fault: A `${` or `$(` is not closed.
    """
    found: list[Segment] = []
    position = 0
    while position < len(text):
        match = _SEGMENT.match(text, position)
        if match is None:
            raise _unclosed(text, position)
        found.append(_segment(match))
        position = match.end()
    return tuple(found)


def _segment(match: re.Match[str]) -> Segment:
    kind = match.lastgroup
    if kind == "expression":
        return Cut.EXPRESSION, match["expression"]
    if kind == "substitution":
        return Cut.SUBSTITUTION, match["substitution"]
    return Cut.TEXT, match["text"] or match["escaped"][1:]


def _unclosed(text: str, position: int) -> Fault:
    rest = text[position:]
    closing = {"${": "}", "$(": ")"}.get(rest[:2])
    if closing:
        what = f'"{rest[:2]}" is not closed by "{closing}" in "{shorten(text)}"'
    else:
        what = f'"$" in "{shorten(text)}" begins nothing: write "$${{" for a literal "${{"'
    return Fault("bad-expression", f"{what}.")
