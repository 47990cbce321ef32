# PyYAML's nodes and events are untyped.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""A small YAML file of the studio's own, one list of named items, read as hostile.

Nothing in it is followed, repeated or constructed, and every fault names its line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import yaml

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.errors import DescriptionError

SIZE_LIMIT_BYTES: Final = 1 << 20
VERSION: Final = "1"
NAME_LIMIT: Final = 100
"""Letters of an item's name."""
_EVENT_LIMIT: Final = 200_000
_KEY_LIMIT: Final = 4096
"""Letters."""
_LOADER: Final = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(frozen=True, slots=True)
class ListKind:
    """What a list contains, and how much of it."""

    noun: str
    """Of one item; the list's key is its plural."""
    error: Callable[[str, str], DescriptionError]
    """Makes the error of a file (its path) for a reason."""
    item_limit: int
    entry_limit: int
    """Keys of one mapping."""
    depth_limit: int
    """Collections inside collections."""


class NamedList:
    """Reads the list of a file."""

    def __init__(self, path: str, data: bytes, kind: ListKind) -> None:
        self._path, self._data, self._kind = path, data, kind

    def items(self) -> Sequence[yaml.Node]:
        """Return the items of the list; an empty file has none.

        Raises:
            DescriptionError: The kind's: it is no YAML, too large, or no list of such items.
        """
        root, key = self._root(), f"{self._kind.noun}s"
        if root is None:
            return ()
        top = self.mapping(root, {"version", key})
        if "version" in top and self.text(top["version"]) != VERSION:
            raise self.fault(top["version"], "is of another version of the studio")
        listed = top.get(key)
        if listed is None or is_null(listed):
            return ()
        if not isinstance(listed, yaml.SequenceNode):
            raise self.fault(listed, f"must be a list of {key}")
        if len(listed.value) > self._kind.item_limit:
            raise self.fault(listed, f"holds more than {self._kind.item_limit} {key}")
        self.refuse_twins(listed, [self.name(item) for item in listed.value])
        return listed.value

    def name(self, item: yaml.Node) -> str:
        """Return the name of an item; errors as for `items`."""
        keys = self.mapping(item, None)
        if "name" not in keys:
            raise self.fault(item, f"is a {self._kind.noun} without a name")
        name = self.text(keys["name"]).strip()
        if not name or len(name) > NAME_LIMIT:
            raise self.fault(keys["name"], f"is no name of up to {NAME_LIMIT} letters")
        return name

    def mapping(self, node: yaml.Node, allowed: set[str] | None) -> dict[str, yaml.Node]:
        """Return the values by key; `allowed` None: any keys. Errors as for `items`."""
        if not isinstance(node, yaml.MappingNode) or len(node.value) > self._kind.entry_limit:
            raise self.fault(node, "must be keys with values")
        pairs = [(self.text(key), value) for key, value in node.value]
        self.refuse_twins(node, [key for key, _ in pairs])
        unknown = [key for key, _ in pairs if allowed is not None and key not in allowed]
        if unknown:
            raise self.fault(node, f'has the unknown key "{unknown[0]}"')
        return dict(pairs)

    def text(self, node: yaml.Node, limit: int = _KEY_LIMIT) -> str:
        """Return one text of up to `limit` letters, as it was written; errors as for `items`."""
        if not isinstance(node, yaml.ScalarNode):
            raise self.fault(node, "must be one text")
        text = str(node.value)
        if len(text) > limit:
            raise self.fault(node, f"is longer than {limit:,} characters")
        return text

    def refuse_twins(self, node: yaml.Node, names: Iterable[str]) -> None:
        """Check that no name occurs twice; errors as for `items`."""
        seen: set[str] = set()
        for name in names:
            if name in seen:
                raise self.fault(node, f'has "{name}" twice')
            seen.add(name)

    def fault(self, where: yaml.Node | yaml.Event | None, reason: str) -> DescriptionError:
        """Return the error of a place; None: of the file."""
        line = where.start_mark.line + 1 if where is not None and where.start_mark else 1
        return self._error(f"line {line} {reason}")

    def _error(self, reason: str) -> DescriptionError:
        return self._kind.error(self._path, reason)

    def _root(self) -> yaml.Node | None:
        if len(self._data) > SIZE_LIMIT_BYTES:
            raise self._error(f"it is larger than {SIZE_LIMIT_BYTES >> 20} MB")
        try:
            text = self._data.decode("utf-8-sig")
            self._survey(text)
            return yaml.compose(text, _LOADER)
        except UnicodeDecodeError as error:
            raise self._error("it is not UTF-8 text") from error
        except yaml.YAMLError as error:
            raise self._error(f"it is no YAML ({_reason(error)})") from error

    def _survey(self, text: str) -> None:
        """Refuse what such a list has no use for, before anything is made of it."""
        depth, noun = 0, self._kind.noun
        for count, event in enumerate(yaml.parse(text, _LOADER)):
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > self._kind.depth_limit or count > _EVENT_LIMIT:
                raise self.fault(event, "is nested too deeply or too long")
            if getattr(event, "anchor", None) or getattr(event, "tag", None) not in (None, "!"):
                raise self.fault(event, f"has an anchor, alias or tag, which no {noun} needs")


def is_null(node: yaml.Node) -> bool:
    """Whether a key has no value."""
    return isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:null"


def lines_of(node: yaml.Node) -> tuple[int, int]:
    """Return the lines [start, end) of an item, from 0; comments below it are not its own."""
    return node.start_mark.line, _last_line(node) + 1


def _last_line(node: yaml.Node) -> int:
    """Return a node's last line of content; a collection's end is behind its comments."""
    match node:
        case yaml.MappingNode() if node.value and not node.flow_style:
            return max(_last_line(part) for pair in node.value for part in pair)
        case yaml.SequenceNode() if node.value and not node.flow_style:
            return max(_last_line(part) for part in node.value)
        case _:
            end = node.end_mark
            return end.line - (end.column == 0 and end.line > node.start_mark.line)


def _reason(error: yaml.YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or "it cannot be parsed"
    return f"line {mark.line + 1}: {problem}" if mark else str(problem)
