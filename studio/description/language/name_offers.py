"""Names that may be typed inside `${...}` and `$(...)`: what can be read there, and functions."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Final

from studio.description.expressions.symbols import PURE_SYMBOLS, SAFE_BUILTINS, Namespace
from studio.description.language.offers import Offer, Snippet, plain, written
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.subject import MISSING, found_in, found_of, keys_below, printed
from studio.description.language.uses import chains_of
from studio.description.syntax.params import read_parameters

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.graph import Scope
    from studio.description.language.cursor import Cursor
    from studio.description.language.token_at import Segment
    from studio.description.language.uses import Chain

_PARAMETER, _OWN, _READABLE, _COMMON, _RARE = range(5)
_USUAL: Final = frozenset(
    {
        *("pi", "radians", "degrees", "sin", "cos", "tan", "asin", "acos", "atan", "atan2"),
        *("sqrt", "abs", "min", "max", "round", "floor", "ceil", "hypot", "pow"),
        *("len", "str", "int", "float", "xacro", "math", "True", "False"),
    }
)
_COMMANDS: Final = ("arg", "find", "eval", "env", "optenv")
_BELOW: Final = re.compile(r"(?:\.|\[\s*(?:'|\"|&quot;|&apos;))\s*$")
_KEY_END: Final = re.compile(r"(?:'|\"|&quot;|&apos;)?\s*\]?\s*")
"""Between a name or key and the `.` or `[` behind it."""
_NAME_END: Final = re.compile(r"\w*")
_NAME: Final = re.compile(r"[^\W\d]\w*$|$")
_OPERAND: Final = re.compile(r"\s*(\w+)\s+(.*)$", re.DOTALL)
_BLANK_FREE: Final = re.compile(r"[^\s)]*")


def name_around(cursor: Cursor) -> tuple[int, int]:
    """Return the name under the cursor: where it begins and ends, in characters of the text."""
    before = cursor.text[max(0, cursor.index - 200) : cursor.index]
    typed = _NAME.search(before)
    start = cursor.index - (len(typed[0]) if typed else 0)
    end = _NAME_END.match(cursor.text, cursor.index)
    return start, end.end() if end else cursor.index


def expression_offers(cursor: Cursor, segment: Segment) -> Iterator[Offer]:
    """Yield names that can be read at the cursor of an expression."""
    start, _ = name_around(cursor)
    before = cursor.text[segment.start : start]
    below = _BELOW.search(before)
    if below is None:
        yield from _names(cursor)
        return
    chains = chains_of(before[: below.start()])
    if chains and _KEY_END.fullmatch(before, chains[-1].steps[-1].end, below.start()):
        yield from _members(cursor, chains[-1], is_key=not below[0].startswith("."))


def _members(cursor: Cursor, chain: Chain, *, is_key: bool) -> Iterator[Offer]:
    """Yield names or keys behind what the chain means."""
    for scope in cursor.scopes()[:1] or ():
        found = found_in(scope, chain)
        if found is None:
            return
        if isinstance(found.value, Namespace):
            for name, value in found.value.items():
                yield _exposed(cursor, name, value, _COMMON)
            return
        kind = Kind.YAML if found.kind in {Kind.YAML, Kind.PROPERTY} else Kind.PROPERTY
        for name, value in keys_below(found):
            if is_key or name.isidentifier():
                yield plain(_OWN, kind, name, detail=printed(value))


def _names(cursor: Cursor) -> Iterator[Offer]:
    scopes = cursor.scopes()
    if scopes:
        yield from _in_scope(cursor, scopes[0])
    if cursor.macro is not None:
        for name in read_parameters(cursor.written(cursor.macro, "params"))[0]:
            if not name.startswith("*"):
                yield plain(_PARAMETER, Kind.PARAMETER, name)
    if scopes:
        symbols: dict[str, Any] = scopes[0].run.symbols
    else:
        symbols = PURE_SYMBOLS
    for tag in cursor.declarations:
        if tag.name == "xacro:property" and (name := cursor.written(tag, "name")):
            value = cursor.written(tag, "value") or cursor.written(tag, "default")
            yield plain(_OWN, Kind.PROPERTY, name, detail=printed(value))
    for name, value in symbols.items():
        yield _exposed(cursor, name, value, _COMMON if name in _USUAL else _RARE)


def _in_scope(cursor: Cursor, scope: Scope) -> Iterator[Offer]:
    """Yield names of the run that can be read here, with what they came to."""
    inner: Scope | None = scope
    while inner is not None:
        for name, cell in inner.cells.items():
            if name.startswith("*"):
                continue
            found = found_of(name, cell)
            value = "" if found.value is MISSING else printed(found.value)
            is_own = any(one.tree.path == cursor.file for one in found.elements)
            group = _PARAMETER if found.kind is Kind.PARAMETER else _OWN if is_own else _READABLE
            shown = "" if found.kind is Kind.NAMESPACE else value
            yield plain(group, found.kind, name, detail=shown)
        inner = inner.parent


def _exposed(cursor: Cursor, name: str, value: Any, group: int) -> Offer:  # noqa: ANN401
    if not callable(value):
        detail = "" if isinstance(value, Namespace) else printed(value)
        return plain(group, Kind.CONSTANT, name, detail=detail)
    end = name_around(cursor)[1]
    if cursor.text[end : end + 1] == "(":
        return plain(group, Kind.FUNCTION, name)
    return written(group, Kind.FUNCTION, name, Snippet().write(f"{name}(").stop().write(")"))


def substitution_offers(cursor: Cursor, segment: Segment) -> tuple[list[Offer], int, int]:
    """Return what may be typed inside `$(...)`, and the range that it replaces."""
    typed = cursor.text[segment.start : cursor.index]
    operand = _OPERAND.match(typed)
    if operand is None:
        start = cursor.index - len(typed.lstrip())
        return list(_commands(cursor, segment)), start, _end_of(cursor, r"\w*\s?")
    if operand[1] == "eval":
        start, end = name_around(cursor)
        return [*_args(cursor), *_functions(cursor)], start, end
    start = segment.start + operand.start(2)
    found = _BLANK_FREE.match(cursor.text, cursor.index, max(segment.end, cursor.index))
    offers = {"arg": _args, "find": _packages}.get(operand[1], _environment)
    return list(offers(cursor)), start, found.end() if found else cursor.index


def _end_of(cursor: Cursor, pattern: str) -> int:
    found = re.compile(pattern).match(cursor.text, cursor.index)
    return found.end() if found else cursor.index


def _commands(cursor: Cursor, segment: Segment) -> Iterator[Offer]:
    closing = "" if segment.is_closed else ")"
    for group, name in enumerate(_COMMANDS):
        snippet = Snippet().write(f"{name} ").stop().write(closing)
        yield written(group, Kind.COMMAND, name, snippet)


def _args(cursor: Cursor) -> Iterator[Offer]:
    if cursor.trace is not None:
        for name, one in cursor.trace.arguments.items():
            yield plain(_OWN, Kind.ARG, name, detail=printed(one.value))
    for tag in cursor.declarations:
        if tag.name == "xacro:arg" and (name := cursor.written(tag, "name")):
            yield plain(_READABLE, Kind.ARG, name, detail=cursor.written(tag, "default"))


def _functions(cursor: Cursor) -> Iterator[Offer]:
    for name, value in {**SAFE_BUILTINS, **PURE_SYMBOLS}.items():
        yield _exposed(cursor, name, value, _COMMON if name in _USUAL else _RARE)


def _packages(cursor: Cursor) -> Iterator[Offer]:
    for name, folders in cursor.reading.policy.packages.items():
        is_own = any(cursor.file.startswith(f"{folder}/") for folder in folders)
        yield plain(0 if is_own else 1, Kind.PACKAGE, name, detail=folders[0] if folders else "")


def _environment(cursor: Cursor) -> Iterator[Offer]:
    for name, value in cursor.reading.policy.environment.items():
        yield plain(0, Kind.ENVIRONMENT, name, detail=printed(value))
