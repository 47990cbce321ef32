# PyYAML's nodes and events are untyped.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""Variants of a description: named sets of arguments and texts, and the file that holds them.

A text goes by what a person would call it, and is found again in changed files: a name outlives
edits elsewhere, which byte offsets and element counts do not. All that is asked of a file is its
bytes: a variant can be applied to files that the last run did not read.

The file is a small YAML beside the robot's, read as hostile, written for people. What a person
wrote stays: variants that did not change keep their lines, comments above each one and around the
list included. A text that reads back as anything else than what was to be written is written again
as a whole.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

import yaml

from studio.description.editing.edits import apply, edit_at
from studio.description.sites.file_sites import FileSites, xml_sites, yaml_sites
from studio.description.syntax.named_list import (
    SIZE_LIMIT_BYTES,
    VERSION,
    ListKind,
    NamedList,
    is_null,
    lines_of,
)
from studio.description.syntax.source_tree import SourceError, parse_source
from studio.description.syntax.yaml_spans import yaml_bytes
from studio.description.values import Edit, SiteKind
from studio.errors import EditError, VariantsFileError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.description.sites.file_sites import FileSite

_YAML_ENDINGS = (".yaml", ".yml")
_BOM = b"\xef\xbb\xbf"
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


@dataclass(frozen=True, slots=True, order=True)
class TextName:
    """Names a text of a description."""

    file: str
    """Relative to the folder of the entry file with `/` between, or `package://<name>/<path>`."""
    kind: SiteKind
    name: str
    """As `Site.name`: of a property or argument, a key path, an element path with its attribute."""
    within: str = ""
    """The macro of a parameter default; the link, joint or macro around a plain number."""
    number: int = 1
    """Counts the texts of the file that are called the same."""

    def __str__(self) -> str:
        shown = f"{self.within} {self.name}" if self.within else self.name
        return f"{shown} ({self.number})" if self.number > 1 else shown


@dataclass(frozen=True, slots=True)
class Variant:
    """A named set of arguments and texts, on top of what the files say."""

    name: str
    note: str = ""
    arguments: dict[str, str | None] = field(default_factory=dict[str, "str | None"])
    """Passed to xacro; None takes back one that the document was opened with."""
    texts: dict[TextName, str] = field(default_factory=dict[TextName, str])


@dataclass(frozen=True, slots=True)
class Placed:
    """Edits for texts in one file, the last place first, and the texts without a place."""

    edits: tuple[Edit, ...]
    left_out: tuple[str, ...] = ()


class NamedTexts:
    """The editable texts of one file as the disk has it, by name.

    Args:
        file: As in `TextName.file`.
        path: Where it lies.
        disk: Its bytes there.
    """

    def __init__(self, file: str, path: str, disk: bytes) -> None:
        self.file, self.path, self.disk = file, path, disk
        self._saved = _sites_of(path, disk, None)
        self._now = self._saved
        self._names: dict[bytes, dict[TextName, FileSite]] = {disk: _named(file, self._saved)}

    def has_read(self, now: bytes) -> bool:
        """Whether the texts of these bytes are known, so that asking for them takes no time."""
        return now in self._names

    def read(self, now: bytes) -> None:
        """Read the texts of these bytes, if they are not known."""
        self._at(now)

    def saved_text(self, name: TextName) -> str | None:
        """Return a text on disk; None when there is none of that name."""
        found = self._names[self.disk].get(name)
        return found.text if found else None

    def line_of(self, name: TextName) -> int:
        """Return the line (from 1) where the disk has a text; 0 when it has none."""
        found = self._names[self.disk].get(name)
        return found.place.line if found else 0

    def differing(self, now: bytes) -> dict[TextName, str]:
        """Return the texts of an edited file that differ from those on disk."""
        saved = self._names[self.disk]
        return {
            name: site.text
            for name, site in self._at(now).items()
            if name in saved and saved[name].text != site.text
        }

    def edits_to(self, now: bytes, texts: Mapping[TextName, str]) -> Placed:
        """Return edits that give an edited file these texts, and all others those on disk."""
        here, edits, left_out = self._at(now), list[Edit](), list[str]()
        saved = {name: site.text for name, site in self._names[self.disk].items()}
        wanted = {**saved, **texts}
        for name, text in wanted.items():
            site = here.get(name)
            if site is None:
                if name in texts:
                    left_out.append(f"{self.file} has no {_label(name)} any more.")
            elif site.text != text:
                try:
                    edits.append(edit_at(self.path, now, site.span, text))
                except EditError as error:
                    left_out.append(f"{self.file}, {_label(name)}: {error}")
        edits.sort(key=lambda edit: edit.start, reverse=True)
        return Placed(tuple(edits), tuple(left_out))

    def with_texts(self, texts: Mapping[TextName, str]) -> tuple[bytes, tuple[str, ...]]:
        """Return the disk's bytes with these texts in them, and what found no place."""
        placed = self.edits_to(self.disk, texts)
        return apply(self.disk, placed.edits), placed.left_out

    def _at(self, now: bytes) -> dict[TextName, FileSite]:
        """Return the texts of other bytes; those of the disk's and of the last ones are kept."""
        known = self._names.get(now)
        if known is None:
            known = _named(self.file, _sites_of(self.path, now, self._saved))
            self._names = {self.disk: self._names[self.disk], now: known}
        return known


def differing_names(one: Mapping[TextName, str], other: Mapping[TextName, str]) -> list[TextName]:
    """Return names of texts that two sets do not both have alike, in order."""
    return sorted(name for name in {**one, **other} if one.get(name) != other.get(name))


def _sites_of(path: str, data: bytes, before: FileSites | None) -> FileSites:
    """Return the texts of a file; none while it cannot be read as what it is."""
    if path.lower().endswith(_YAML_ENDINGS):
        return yaml_sites(path, data)
    try:
        return xml_sites(parse_source(path, data), before)
    except SourceError:
        is_markup = data.removeprefix(_BOM).lstrip().startswith(b"<")
        return FileSites(data, ()) if is_markup else yaml_sites(path, data)


def _named(file: str, sites: FileSites) -> dict[TextName, FileSite]:
    seen: Counter[tuple[SiteKind, str, str]] = Counter()
    found: dict[TextName, FileSite] = {}
    for site in sites.sites:
        around = site.kind in (SiteKind.LITERAL, SiteKind.PARAM_DEFAULT)
        key = (site.kind, site.name, site.group if around else "")
        seen[key] += 1
        found[TextName(file, *key, seen[key])] = site
    return found


def _label(name: TextName) -> str:
    kinds = {
        SiteKind.ARG: "argument",
        SiteKind.PROPERTY: "property",
        SiteKind.YAML: "key",
        SiteKind.PARAM_DEFAULT: "parameter",
        SiteKind.LITERAL: "number",
    }
    return f"{kinds[name.kind]} {name}"


def texts_by_file(texts: Mapping[TextName, str]) -> dict[str, dict[TextName, str]]:
    """Return the same, file by file."""
    found: dict[str, dict[TextName, str]] = {}
    for name, text in texts.items():
        found.setdefault(name.file, {})[name] = text
    return found


@dataclass(frozen=True, slots=True)
class _Item:
    """One variant of a file and its lines [start, end) there."""

    variant: Variant
    start: int
    end: int


def read_variants(path: str, data: bytes) -> tuple[Variant, ...]:
    """Return the variants of a file, in its order; an empty file has none.

    Raises:
        VariantsFileError: It is no YAML, too large, or has something that no variant can have.
    """
    return tuple(item.variant for item in _Reading(path, data).items())


def write_variants(path: str, entry: str, before: bytes, variants: Sequence[Variant]) -> bytes:
    """Return the bytes of a file with these variants, otherwise unchanged as far as possible.

    Args:
        path: Path of the file, for errors.
        entry: Name of the entry file, for a new file's first line.
        before: The present content; empty for none.
        variants: All of them, in order.

    Raises:
        VariantsFileError: The present file, or the new one, cannot be read.
    """
    written = _woven(path, before, variants) if before.strip() else None
    if written is None or not _reads_as(path, written, variants):
        written = _HEAD.format(entry=entry.replace("\n", " ")).encode() + _whole(variants)
    if len(written) > SIZE_LIMIT_BYTES:
        raise VariantsFileError(path, "the variants are too many for one file; delete some")
    if not _reads_as(path, written, variants):
        raise VariantsFileError(path, _unwritable(path, variants))
    return written


def _unwritable(path: str, variants: Sequence[Variant]) -> str:
    """Why variants do not read back as they are: which one, where it is one."""
    alone = (one for one in variants if not _reads_as(path, _whole([one]), [one]))
    found = next(alone, None)
    if found is None:
        return "a file cannot hold these variants together; delete one, or give it another name"
    return f'"{found.name}" has a name or a text that a file cannot hold; make it shorter'


def _reads_as(path: str, written: bytes, variants: Sequence[Variant]) -> bool:
    try:
        return read_variants(path, written) == tuple(variants)
    except VariantsFileError:
        return False


def _whole(variants: Sequence[Variant]) -> bytes:
    if not variants:
        return b"variants: []\n"
    return ("variants:\n" + "".join(_spelled(one, "  ") for one in variants)).encode()


def _woven(path: str, before: bytes, variants: Sequence[Variant]) -> bytes | None:
    """Return the old text with the items exchanged; None where it is not one item a line."""
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
    """Return the indent of all items of the list, where each begins a line."""
    indents = {line[: len(line) - len(line.lstrip())] for line in starts if _ITEM.match(line)}
    return indents.pop() if len(indents) == 1 and all(map(_ITEM.match, starts)) else None


def _with_leads(items: Sequence[_Item], lines: list[str]) -> dict[str, tuple[str, _Item | None]]:
    """Return each item by name with the comments and empty lines above it."""
    found: dict[str, tuple[str, _Item | None]] = {}
    last = 0
    for item in items:
        start = _lead_of(item.start, last, lines)
        found[item.variant.name] = (_ended("".join(lines[start : item.start])), item)
        last = item.end
    return found


def _lead_of(start: int, last: int, lines: list[str]) -> int:
    """Return where the comments and empty lines right above a line begin."""
    while start > last and (not lines[start - 1].strip() or lines[start - 1].lstrip()[0] == "#"):
        start -= 1
    return start


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else f"{text}\n"


def _spelled(variant: Variant, indent: str) -> str:
    """Return one item of the list; each text is a short paragraph of its own."""
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
    """Reads a file once; every fault names its line."""

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
