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
from studio.description.syntax.named_list import (
    SIZE_LIMIT_BYTES,
    VERSION,
    ListKind,
    NamedList,
    is_null,
    lines_of,
)
from studio.description.syntax.yaml_text import yaml_bytes
from studio.description.values import SiteKind
from studio.errors import VariantsFileError

if TYPE_CHECKING:
    from collections.abc import Sequence

VARIANT_LIMIT: Final = 200
NOTE_LIMIT: Final = 2000
_TEXT_LIMIT: Final = 100_000
_ENTRY_LIMIT: Final = 5000
"""Arguments, or texts, of one variant."""
_NUMBER_LIMIT: Final = 100_000
_KIND: Final = ListKind(
    noun="variant",
    error=VariantsFileError,
    item_limit=VARIANT_LIMIT,
    entry_limit=_ENTRY_LIMIT,
    depth_limit=12,
)
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
    f"version: {VERSION}\n"
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
        self._list = NamedList(path, data, _KIND)

    def items(self) -> tuple[_Item, ...]:
        return tuple(map(self._item, self._list.items()))

    def _item(self, node: yaml.Node) -> _Item:
        keys = self._list.mapping(node, {"name", "note", "arguments", "values"})
        variant = Variant(
            name=self._list.name(node),
            note=self._list.text(keys["note"], NOTE_LIMIT) if "note" in keys else "",
            arguments=self._arguments(keys.get("arguments")),
            texts=self._texts(keys.get("values")),
        )
        return _Item(variant, *lines_of(node))

    def _arguments(self, node: yaml.Node | None) -> dict[str, str | None]:
        if node is None or is_null(node):
            return {}
        pairs = self._list.mapping(node, None)
        return {
            name: None if is_null(value) else self._list.text(value, _TEXT_LIMIT)
            for name, value in pairs.items()
        }

    def _texts(self, node: yaml.Node | None) -> dict[TextName, str]:
        if node is None or is_null(node):
            return {}
        if not isinstance(node, yaml.SequenceNode) or len(node.value) > _ENTRY_LIMIT:
            raise self._list.fault(node, f"must be a list of at most {_ENTRY_LIMIT} values")
        found: dict[TextName, str] = {}
        for one in node.value:
            name, text = self._named_text(one)
            if name in found:
                raise self._list.fault(one, f'sets "{name}" a second time')
            found[name] = text
        return found

    def _named_text(self, node: yaml.Node) -> tuple[TextName, str]:
        keys = self._list.mapping(node, {*_KEYS, *_WITHIN.values(), "file", "number", "text"})
        kinds = [key for key in _KEYS if key in keys]
        if len(kinds) != 1 or "file" not in keys or "text" not in keys:
            what = ", ".join(_KEYS)
            raise self._list.fault(node, f"needs a file, a text, and one of {what}")
        kind = _KEYS[kinds[0]]
        within = keys.get(_WITHIN.get(kind, ""))
        name = TextName(
            file=self._list.text(keys["file"]),
            kind=kind,
            name=self._list.text(keys[kinds[0]]),
            within=self._list.text(within) if within is not None else "",
            number=self._number(keys.get("number")),
        )
        return name, self._list.text(keys["text"], _TEXT_LIMIT)

    def _number(self, node: yaml.Node | None) -> int:
        text = "1" if node is None else self._list.text(node, 20)
        if not re.fullmatch("[0-9]{1,6}", text) or not 1 <= int(text) <= _NUMBER_LIMIT:
            raise self._list.fault(node, "is no number from 1 on")
        return int(text)
