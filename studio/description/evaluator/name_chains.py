"""The names in an expression with what is read of them: `cfg['joint']['limit']`, `ns.length`.

Works on the text as written, references such as `&lt;` included, and on expressions that are not
finished yet.
"""

from __future__ import annotations

import keyword
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Iterator

Key: TypeAlias = str | int

_TOKEN: Final = re.compile(
    r"(?P<string>&quot;.*?(?:&quot;|$)|&apos;.*?(?:&apos;|$)|'[^']*'?|\"[^\"]*\"?)|&#?\w+;"
    r"|(?P<number>\d[\w.]*|\.\d\w*)|(?P<name>[^\W\d]\w*)|(?P<sign>\S)",
    re.DOTALL,
)
_LOOP: Final = re.compile(r"\bfor\s+([\w\s,()]+?)\s+in\b")
_WORD: Final = re.compile(r"[^\W\d]\w*")
_QUOTES: Final = ("&quot;", "&apos;", "'", '"')


@dataclass(frozen=True, slots=True)
class Step:
    """One name or key of a chain, and where it stands: a key without its quotes."""

    key: Key
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Chain:
    """A name and what is read below it; `steps[0]` is the name itself."""

    steps: tuple[Step, ...]
    is_local: bool = False
    """The name of a loop inside the expression."""

    @property
    def base(self) -> str:
        """The name that it begins with."""
        return str(self.steps[0].key)

    @property
    def keys(self) -> tuple[Key, ...]:
        """What is read below the name."""
        return tuple(step.key for step in self.steps[1:])

    def up_to(self, index: int) -> Chain | None:
        """The chain up to the step that a cursor is in; None when it is in none."""
        for count, step in enumerate(self.steps, 1):
            if step.start <= index <= step.end:
                return Chain(self.steps[:count], self.is_local)
        return None


@lru_cache(maxsize=8192)
def chains_of(text: str) -> tuple[Chain, ...]:
    """All chains of an expression, in order."""
    local = {name for loop in _LOOP.findall(text) for name in _WORD.findall(loop)}
    return tuple(
        Chain(steps, is_local=str(steps[0].key) in local) for steps in _chains(_tokens(text))
    )


def chain_at(text: str, index: int) -> Chain | None:
    """The chain under a cursor, up to the step that it is in."""
    found = (chain.up_to(index) for chain in chains_of(text))
    return next((chain for chain in found if chain is not None), None)


def string_at(text: str, index: int) -> Step | None:
    """The quoted text under a cursor."""
    for found in _tokens(text):
        if found.lastgroup == "string":
            step = _quoted(found)
            if step.start <= index <= step.end:
                return step
    return None


def _tokens(text: str) -> list[re.Match[str]]:
    return list(_TOKEN.finditer(text))


def _chains(tokens: list[re.Match[str]]) -> Iterator[tuple[Step, ...]]:
    position = 0
    while position < len(tokens):
        found = tokens[position]
        position += 1
        if found.lastgroup == "name" and not keyword.iskeyword(found[0]):
            steps = [Step(found[0], found.start(), found.end())]
            position = _read_steps(tokens, position, steps)
            yield tuple(steps)
        elif found[0] == ".":  # of a call or a bracket: no name of its own
            position += position < len(tokens) and tokens[position].lastgroup == "name"


def _read_steps(tokens: list[re.Match[str]], position: int, steps: list[Step]) -> int:
    """Add what is read below a name; where to go on."""
    while position + 1 < len(tokens):
        sign, inside = tokens[position], tokens[position + 1]
        if sign[0] == "." and inside.lastgroup == "name":
            steps.append(Step(inside[0], inside.start(), inside.end()))
            position += 2
        elif sign[0] == "[" and (step := _key(inside)) and _is(tokens, position + 2, "]"):
            steps.append(step)
            position += 3
        else:
            break
    return position


def _is(tokens: list[re.Match[str]], position: int, sign: str) -> bool:
    return position < len(tokens) and tokens[position][0] == sign


def _key(found: re.Match[str]) -> Step | None:
    if found.lastgroup == "string":
        return _quoted(found)
    if found.lastgroup == "number" and found[0].isdecimal() and len(found[0]) < 10:
        return Step(int(found[0]), found.start(), found.end())
    return None


def _quoted(found: re.Match[str]) -> Step:
    quote = next(one for one in _QUOTES if found[0].startswith(one))
    start = found.start() + len(quote)
    closed = found[0].endswith(quote) and len(found[0]) >= 2 * len(quote)
    end = found.end() - len(quote) if closed else found.end()
    return Step(found.string[start:end], start, end)
