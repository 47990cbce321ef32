"""Texts of `.rviz` files as trees and back: bounded while they are read, scalars kept as written.

A tree is a dict, a list or a str. A str is a scalar as it stands in the file, so that `0.50` and
`true` are written back as they were; in double quotes if it was quoted in any way, as `"0.5"`.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Final, TypeAlias, cast

import yaml

from studio.errors import RvizConfigError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ENDINGS: Final = (".rviz", ".studio.yaml")
"""Of RViz's files, and of those that hold the studio's panels, too."""

Tree: TypeAlias = "dict[str, Tree] | list[Tree] | str"
"""Never changed in place: parts are shared."""

SIZE_LIMIT_BYTES: Final = 1 << 20
"""The largest file of the corpus has 20 kB."""
NODES_MAX: Final = 50_000
"""Values with every alias counted where it stands; the largest file of the corpus has 700."""
DEPTH_MAX: Final = 40
"""Values inside values; the deepest file of the corpus has 10."""
_KEY_MAX: Final = 1000
"""No YAML reader takes a longer one on the line of its value."""
NULL: Final = "~"
_NULLS: Final = frozenset({"~", "null", "Null", "NULL"})
_PLAIN: Final = re.compile(
    r"[A-Za-z0-9_/<.(+$][^\x00-\x1f\x7f-\x9f\ufeff\u2028\u2029\ud800-\udfff#:]*"
)
"""Texts that no YAML reader takes for anything else, if they also read as texts."""
_WORDS: Final = re.compile(
    r"(?i:true|false|yes|no|on|off|null|~)|[-+.]?[0-9][-+0-9a-zA-Z_.:]*|[-+]?\.(?i:inf|nan)|="
)
"""Texts that would be read as something else than texts."""
_ESCAPED: Final = re.compile("[\x7f-\x9f\ufeff\u2028\u2029\ud800-\udfff]")


def read_tree(text: str) -> Tree:
    """Return the tree of a YAML text.

    Raises:
        RvizConfigError: It is no YAML, or larger or deeper than any file of RViz.
    """
    if len(text) > SIZE_LIMIT_BYTES or len(text.encode("utf-8", "replace")) > SIZE_LIMIT_BYTES:
        raise RvizConfigError(f"it has more than {SIZE_LIMIT_BYTES >> 20} MB")
    try:
        return _Builder(text).tree()
    except yaml.YAMLError as error:
        raise RvizConfigError(*_fault_of(error)) from None
    except (RecursionError, ValueError, OverflowError) as error:
        raise RvizConfigError(f"it is no YAML that can be read: {error}") from None


def write_tree(tree: Tree) -> str:
    """Return the YAML text of a tree, laid out as RViz does."""
    return "\n".join(_lines(tree, "")) + "\n"


def text_of(scalar: str) -> str:
    """Return what a scalar says; nothing for none."""
    if scalar.startswith('"'):
        return cast("str", json.loads(scalar))
    return "" if scalar in _NULLS else scalar


def scalar_of(text: str) -> str:
    """Return the scalar for a text, in quotes only where it would be read as something else."""
    if _PLAIN.fullmatch(text) and text == text.rstrip() and not _WORDS.fullmatch(text):
        return text
    return quoted(text)


def quoted(text: str) -> str:
    """Return a text in double quotes, which JSON and YAML write alike."""
    written = json.dumps(text, ensure_ascii=False)
    return _ESCAPED.sub(lambda found: f"\\u{ord(found[0]):04x}", written)


def is_null(tree: Tree) -> bool:
    """Whether nothing stands there."""
    return isinstance(tree, str) and tree in _NULLS


class _Builder:
    """Builds the tree from events, and stops as soon as there are too many."""

    def __init__(self, text: str) -> None:
        loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
        parse = cast("Callable[..., Iterator[yaml.Event]]", yaml.parse)  # pyright: ignore[reportUnknownMemberType]
        self._events = parse(text, Loader=loader)
        self._anchors: dict[str, tuple[Tree, int] | None] = {}
        """With how many values each has; None: it is not complete."""
        self._count = 0

    def tree(self) -> Tree:
        """Return the tree of the only document."""
        next(self._events)
        if isinstance(next(self._events), yaml.StreamEndEvent):
            return {}
        tree = self._node(next(self._events), 0)
        next(self._events)
        if not isinstance(next(self._events), yaml.StreamEndEvent):
            raise RvizConfigError("it holds more than one document of YAML")
        return tree

    def _node(self, event: yaml.Event, depth: int) -> Tree:
        if isinstance(event, yaml.AliasEvent):
            return self._alias(event)
        anchor: str | None = getattr(event, "anchor", None)
        before = self._count
        if anchor:
            self._anchors[anchor] = None
        self._add(1)
        if depth > DEPTH_MAX:
            raise RvizConfigError(f"its values are nested deeper than {DEPTH_MAX}", _line(event))
        made = self._value(event, depth)
        if anchor:
            self._anchors[anchor] = (made, self._count - before)
        return made

    def _value(self, event: yaml.Event, depth: int) -> Tree:
        if isinstance(event, yaml.MappingStartEvent):
            return self._mapping(depth)
        if isinstance(event, yaml.SequenceStartEvent):
            return [self._node(one, depth + 1) for one in self._until(yaml.SequenceEndEvent)]
        return _scalar(cast("yaml.ScalarEvent", event))

    def _mapping(self, depth: int) -> dict[str, Tree]:
        made: dict[str, Tree] = {}
        for event in self._until(yaml.MappingEndEvent):
            key = self._node(event, depth + 1)
            if not isinstance(key, str) or len(key) > _KEY_MAX:
                raise RvizConfigError("a key is no text, or too long", _line(event))
            made[_key(key)] = self._node(next(self._events), depth + 1)
        return made

    def _until(self, end: type[yaml.Event]) -> Iterator[yaml.Event]:
        while not isinstance(event := next(self._events), end):
            yield event

    def _alias(self, event: yaml.AliasEvent) -> Tree:
        found = self._anchors.get(event.anchor)
        if found is None:
            raise RvizConfigError(
                f'the alias "{event.anchor[:60]}" stands for itself', _line(event)
            )
        tree, count = found
        self._add(count)
        return tree

    def _add(self, count: int) -> None:
        self._count += count
        if self._count > NODES_MAX:
            raise RvizConfigError(f"it has more than {NODES_MAX:,} values")


def _scalar(event: yaml.ScalarEvent) -> str:
    is_plain = event.style in (None, "") and event.tag in _PLAIN_TAGS
    text = event.value.encode("utf-8", "replace").decode("utf-8")
    return (text or NULL) if is_plain and text.isprintable() else quoted(text)


_PLAIN_TAGS: Final = (
    None,
    *(f"tag:yaml.org,2002:{one}" for one in ("int", "float", "bool", "null")),
)


def _key(scalar: str) -> str:
    """Return a key without the quotes that it does not need."""
    return scalar_of(text_of(scalar)) if scalar.startswith('"') else scalar


def _lines(tree: Tree, indent: str) -> Iterator[str]:
    if isinstance(tree, str):
        yield f"{indent}{tree}"
    elif not tree:
        yield f"{indent}{_EMPTY[isinstance(tree, dict)]}"
    elif isinstance(tree, dict):
        for key, value in tree.items():
            yield from _entry(key, value, indent)
    else:
        for value in tree:
            inner = list(_lines(value, f"{indent}  "))
            yield f"{indent}- {inner[0].lstrip(' ')}"
            yield from inner[1:]


_EMPTY: Final = ("[]", "{}")


def _entry(key: str, value: Tree, indent: str) -> Iterator[str]:
    if isinstance(value, str):
        yield f"{indent}{key}: {value}"
        return
    yield f"{indent}{key}:"
    yield from _lines(value, f"{indent}  ")


def _line(event: yaml.Event) -> int | None:
    return None if event.start_mark is None else event.start_mark.line + 1


def _fault_of(error: yaml.YAMLError) -> tuple[str, int | None]:
    mark = getattr(error, "problem_mark", None)
    reason = getattr(error, "problem", None) or getattr(error, "reason", None) or "it is no YAML"
    return str(reason)[:200], None if mark is None else mark.line + 1
