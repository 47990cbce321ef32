# PyYAML's nodes and events are untyped.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""The file of variants: a small YAML beside the robot's, read as hostile, written for people.

What a person wrote stays: variants that did not change keep their lines, comments above each one
and around the list included. A text that reads back as anything else than what was to be written
is written anew as a whole.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

import yaml

from studio.description.editing.variants import TextName, Variant
from studio.description.syntax.yaml_text import yaml_bytes
from studio.description.values import SiteKind
from studio.errors import VariantsFileError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

SIZE_LIMIT_BYTES: Final = 1 << 20
VARIANT_LIMIT: Final = 200
NAME_LIMIT: Final = 100
NOTE_LIMIT: Final = 2000
_TEXT_LIMIT: Final = 100_000
_ENTRY_LIMIT: Final = 5000
"""Arguments, or texts, of one variant."""
_DEPTH_LIMIT: Final = 12
_EVENT_LIMIT: Final = 200_000
_NUMBER_LIMIT: Final = 100_000
_VERSION: Final = 1
_LOADER: Final = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_KEYS: Final = {
    "argument": SiteKind.ARG,
    "property": SiteKind.PROPERTY,
    "key": SiteKind.YAML,
    "parameter": SiteKind.PARAM_DEFAULT,
    "attribute": SiteKind.LITERAL,
}
_KEY_OF: Final = {kind: key for key, kind in _KEYS.items()}
_WITHIN: Final = {SiteKind.PARAM_DEFAULT: "macro", SiteKind.LITERAL: "of"}
"""The key of `TextName.within`."""
_ITEM: Final = re.compile(r"\s*-\s")
_HEAD: Final = (
    "# Variants of {entry}: named sets of arguments and values on top of what the files say.\n"
    "# Written by the studio; edit it as you like.\n"
    f"version: {_VERSION}\n"
)


@dataclass(frozen=True, slots=True)
class _Item:
    """One variant of a file and its lines [start, end) there."""

    variant: Variant
    start: int
    end: int


def read_variants(path: str, data: bytes) -> tuple[Variant, ...]:
    """The variants of a file, in its order; an empty file has none.

    Raises:
        VariantsFileError: It is no YAML, too large, or says something that no variant can.
    """
    return tuple(item.variant for item in _Reading(path, data).items())


def write_variants(path: str, entry: str, before: bytes, variants: Sequence[Variant]) -> bytes:
    """The bytes of a file with these variants, as much as can be as it was.

    Args:
        path: Where the file lies, for the words of errors.
        entry: Name of the entry file, told in a new file's first line.
        before: The file as it is; empty for none.
        variants: All of them, in order.

    Raises:
        VariantsFileError: The file as it is cannot be read, or what was written could not be.
    """
    written = _woven(path, before, variants) if before.strip() else None
    if written is None or not _says(path, written, variants):
        written = _HEAD.format(entry=entry.replace("\n", " ")).encode() + _whole(variants)
    if len(written) > SIZE_LIMIT_BYTES:
        raise VariantsFileError(path, "the variants are too many for one file; delete some")
    if not _says(path, written, variants):
        raise VariantsFileError(path, _unwritable(path, variants))
    return written


def _unwritable(path: str, variants: Sequence[Variant]) -> str:
    """Why variants do not read back as they are: which one, where it is one."""
    alone = (one for one in variants if not _says(path, _whole([one]), [one]))
    found = next(alone, None)
    if found is None:
        return "a file cannot hold these variants together; delete one, or give it another name"
    return f'"{found.name}" has a name or a text that a file cannot hold; make it shorter'


def _says(path: str, written: bytes, variants: Sequence[Variant]) -> bool:
    try:
        return read_variants(path, written) == tuple(variants)
    except VariantsFileError:
        return False


def _whole(variants: Sequence[Variant]) -> bytes:
    if not variants:
        return b"variants: []\n"
    return ("variants:\n" + "".join(_spelled(one, "  ") for one in variants)).encode()


def _woven(path: str, before: bytes, variants: Sequence[Variant]) -> bytes | None:
    """The old text with the items exchanged; None where it is not one item a line."""
    items = list(_Reading(path, before).items())
    lines = before.decode("utf-8-sig").splitlines(keepends=True)
    indent = _indent([lines[item.start] for item in items])
    if indent is None or not variants:
        return None
    known = _with_leads(items, lines)
    kept = {variant.name for variant in variants}
    text = "".join(lines[: _lead_of(items[0].start, 0, lines)])
    for variant, old in zip_longest(variants, items[: len(variants)]):
        is_renamed = old is not None and variant.name not in known and old.variant.name not in kept
        lead, item = known.get(old.variant.name if is_renamed and old else variant.name, ("", None))
        is_same = item is not None and item.variant == variant
        own = lines[item.start : item.end] if item and is_same else [_spelled(variant, indent)]
        text += lead + _ended("".join(own))
    return (text + "".join(lines[items[-1].end :])).encode()


def _indent(starts: Sequence[str]) -> str | None:
    """What all items of the list have before their dash, where each begins a line."""
    indents = {line[: len(line) - len(line.lstrip())] for line in starts if _ITEM.match(line)}
    return indents.pop() if len(indents) == 1 and all(map(_ITEM.match, starts)) else None


def _with_leads(items: Sequence[_Item], lines: list[str]) -> dict[str, tuple[str, _Item | None]]:
    """Each item by name with the comments and empty lines above it."""
    found: dict[str, tuple[str, _Item | None]] = {}
    last = 0
    for item in items:
        start = _lead_of(item.start, last, lines)
        found[item.variant.name] = (_ended("".join(lines[start : item.start])), item)
        last = item.end
    return found


def _lead_of(start: int, last: int, lines: list[str]) -> int:
    """Where the comments and empty lines right above a line begin."""
    while start > last and (not lines[start - 1].strip() or lines[start - 1].lstrip()[0] == "#"):
        start -= 1
    return start


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else f"{text}\n"


def _spelled(variant: Variant, indent: str) -> str:
    """One item of the list; each text is a short paragraph of its own."""
    lines = [f"- name: {_plain(variant.name)}"]
    if variant.note:
        lines.append(f"  note: {_quoted(variant.note)}")
    if variant.arguments:
        lines.append("  arguments:")
        for name, value in variant.arguments.items():
            lines.append(f"    {_plain(name)}: {'null' if value is None else _quoted(value)}")
    if variant.texts:
        lines.append("  values:")
        for name, text in variant.texts.items():
            lines += _spelled_text(name, text)
    return "".join(f"{indent}{line}\n" for line in lines)


def _spelled_text(name: TextName, text: str) -> list[str]:
    pairs = [("file", _plain(name.file)), (_KEY_OF[name.kind], _plain(name.name))]
    if name.within:
        pairs.append((_WITHIN[name.kind], _plain(name.within)))
    if name.number > 1:
        pairs.append(("number", str(name.number)))
    pairs.append(("text", _quoted(text)))
    return [f"    {'  ' if at else '- '}{key}: {value}" for at, (key, value) in enumerate(pairs)]


def _plain(text: str) -> str:
    return yaml_bytes(text, b"x").decode()


def _quoted(text: str) -> str:
    return yaml_bytes(text, b'""').decode()


class _Reading:
    """One look at a file; every fault names its line."""

    def __init__(self, path: str, data: bytes) -> None:
        self._path, self._data = path, data

    def items(self) -> tuple[_Item, ...]:
        root = self._root()
        if root is None:
            return ()
        top = self._mapping(root, {"version", "variants"})
        version = top.get("version")
        if version is not None and self._text(version) != str(_VERSION):
            raise self._fault(version, "is of another version of the studio")
        listed = top.get("variants")
        if listed is None or _is_null(listed):
            return ()
        if not isinstance(listed, yaml.SequenceNode):
            raise self._fault(listed, "must be a list of variants")
        items = tuple(self._item(node) for node in listed.value)
        if len(items) > VARIANT_LIMIT:
            raise self._fault(listed, f"holds more than {VARIANT_LIMIT} variants")
        self._refuse_twins(listed, [item.variant.name for item in items])
        return items

    def _root(self) -> yaml.Node | None:
        """The parsed file; nothing in it is followed, repeated or constructed."""
        if len(self._data) > SIZE_LIMIT_BYTES:
            limit_mb = SIZE_LIMIT_BYTES >> 20
            raise VariantsFileError(self._path, f"it is larger than {limit_mb} MB")
        try:
            text = self._data.decode("utf-8-sig")
            self._survey(text)
            return yaml.compose(text, _LOADER)
        except UnicodeDecodeError as error:
            raise VariantsFileError(self._path, "it is not UTF-8 text") from error
        except yaml.YAMLError as error:
            raise VariantsFileError(self._path, f"it is no YAML ({_yaml_words(error)})") from error

    def _survey(self, text: str) -> None:
        """Refuse what a list of variants has no use for, before anything is made of it."""
        depth = 0
        for count, event in enumerate(yaml.parse(text, _LOADER)):
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > _DEPTH_LIMIT or count > _EVENT_LIMIT:
                raise self._fault(event, "is nested too deeply or too long")
            if getattr(event, "anchor", None) or getattr(event, "tag", None) not in (None, "!"):
                raise self._fault(event, "has an anchor, alias or tag, which no variant needs")

    def _item(self, node: yaml.Node) -> _Item:
        keys = self._mapping(node, {"name", "note", "arguments", "values"})
        if "name" not in keys:
            raise self._fault(node, "is a variant without a name")
        name = self._text(keys["name"], NAME_LIMIT).strip()
        if not name:
            raise self._fault(keys["name"], "is an empty name")
        variant = Variant(
            name=name,
            note=self._text(keys["note"], NOTE_LIMIT) if "note" in keys else "",
            arguments=self._arguments(keys.get("arguments")),
            texts=self._texts(keys.get("values")),
        )
        return _Item(variant, node.start_mark.line, _last_line(node) + 1)

    def _arguments(self, node: yaml.Node | None) -> dict[str, str | None]:
        if node is None or _is_null(node):
            return {}
        pairs = self._mapping(node, None)
        return {
            name: None if _is_null(value) else self._text(value) for name, value in pairs.items()
        }

    def _texts(self, node: yaml.Node | None) -> dict[TextName, str]:
        if node is None or _is_null(node):
            return {}
        if not isinstance(node, yaml.SequenceNode) or len(node.value) > _ENTRY_LIMIT:
            raise self._fault(node, f"must be a list of at most {_ENTRY_LIMIT} values")
        found: dict[TextName, str] = {}
        for one in node.value:
            name, text = self._named_text(one)
            if name in found:
                raise self._fault(one, f'sets "{name}" a second time')
            found[name] = text
        return found

    def _named_text(self, node: yaml.Node) -> tuple[TextName, str]:
        keys = self._mapping(node, {*_KEYS, *_WITHIN.values(), "file", "number", "text"})
        kinds = [key for key in _KEYS if key in keys]
        if len(kinds) != 1 or "file" not in keys or "text" not in keys:
            what = ", ".join(_KEYS)
            raise self._fault(node, f"needs a file, a text, and one of {what}")
        kind = _KEYS[kinds[0]]
        within = keys.get(_WITHIN.get(kind, ""))
        name = TextName(
            file=self._text(keys["file"], 4096),
            kind=kind,
            name=self._text(keys[kinds[0]], 4096),
            within=self._text(within, 4096) if within is not None else "",
            number=self._number(keys.get("number")),
        )
        return name, self._text(keys["text"])

    def _number(self, node: yaml.Node | None) -> int:
        text = "1" if node is None else self._text(node, 20)
        if not re.fullmatch("[0-9]{1,6}", text) or not 1 <= int(text) <= _NUMBER_LIMIT:
            raise self._fault(node, "is no number from 1 on")
        return int(text)

    def _mapping(self, node: yaml.Node, allowed: set[str] | None) -> dict[str, yaml.Node]:
        """The values by key; `allowed` None: any keys."""
        if not isinstance(node, yaml.MappingNode) or len(node.value) > _ENTRY_LIMIT:
            raise self._fault(node, "must be keys with values")
        pairs = [(self._text(key, 4096), value) for key, value in node.value]
        self._refuse_twins(node, [key for key, _ in pairs])
        unknown = [key for key, _ in pairs if allowed is not None and key not in allowed]
        if unknown:
            raise self._fault(node, f'has the unknown key "{unknown[0]}"')
        return dict(pairs)

    def _text(self, node: yaml.Node, limit: int = _TEXT_LIMIT) -> str:
        if not isinstance(node, yaml.ScalarNode):
            raise self._fault(node, "must be one text")
        text = str(node.value)
        if len(text) > limit:
            raise self._fault(node, f"is longer than {limit:,} characters")
        return text

    def _refuse_twins(self, node: yaml.Node, names: Iterable[str]) -> None:
        seen: set[str] = set()
        for name in names:
            if name in seen:
                raise self._fault(node, f'has "{name}" twice')
            seen.add(name)

    def _fault(self, where: yaml.Node | yaml.Event | None, reason: str) -> VariantsFileError:
        line = where.start_mark.line + 1 if where is not None and where.start_mark else 1
        return VariantsFileError(self._path, f"line {line} {reason}")


def _is_null(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:null"


def _last_line(node: yaml.Node) -> int:
    """The last line that a node has content on; a collection's own end lies behind its comments."""
    match node:
        case yaml.MappingNode() if node.value and not node.flow_style:
            return max(_last_line(part) for pair in node.value for part in pair)
        case yaml.SequenceNode() if node.value and not node.flow_style:
            return max(_last_line(part) for part in node.value)
        case _:
            end = node.end_mark
            return end.line - (end.column == 0 and end.line > node.start_mark.line)


def _yaml_words(error: yaml.YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or "it cannot be parsed"
    return f"line {mark.line + 1}: {problem}" if mark else str(problem)
