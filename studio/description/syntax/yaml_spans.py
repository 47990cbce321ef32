# pyright: reportUnknownMemberType=false
r"""Spans of the scalars of a YAML document in the bytes of a file, and how a scalar is written.

The parser's events are read one by one, never composed or constructed: aliases are not followed,
so a text of nested aliases costs no more than its own length. The parser's marks count characters;
spans count bytes.

Source: YAML 1.1 as PyYAML reads it. A scalar is plain (`1.5`), in single quotes (`'it''s'`) or in
double quotes (`"a\tb"`); tags and anchors before it are no part of it.
"""

from __future__ import annotations

import bisect
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import yaml

from studio.description.syntax.annotations import Comment
from studio.description.syntax.yaml_reading import is_bulky
from studio.description.values import Span
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterator

KeyPath: TypeAlias = tuple[str | int, ...]
"""Path of a YAML value: mapping keys as text and list indices, outermost first."""
_ESCAPE = re.compile(r"\\(?:x([0-9A-Fa-f]{2})|u([0-9A-Fa-f]{4})|U([0-9A-Fa-f]{8})|(.))")
_MEANING = {
    "0": "\0", "a": "\a", "b": "\b", "t": "\t", "n": "\n", "v": "\v", "f": "\f", "r": "\r",
    "e": "\x1b", "N": "\x85", "_": "\xa0", "L": "\u2028", "P": "\u2029",
}  # fmt: skip
_SPELLING = {character: f"\\{letter}" for letter, character in _MEANING.items()} | {
    '"': '\\"',
    "\\": "\\\\",
}
_PRINTABLE = re.compile(
    "[\x20-\x7e\xa0-\u2027\u202a-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]*"
)
_PLAIN = re.compile(r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-(?=\S))(?:.*\S)?")
_NOT_PLAIN = re.compile(r"[,\[\]{}]|:(?:[\s?]|$)|\s#")
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_UNNAMED = "?"
_DEPTH_LIMIT = 100
_EVENT_LIMIT = 200_000
_PROPERTIES = re.compile(r"\s*(?:[!&]\S*\s+)*")
_COMMENT = re.compile(r"(?:^|(?<=\s))#([^\r\n]*)", re.MULTILINE)
_SIMPLE_KEY = re.compile(r"[^\s.\[\]\"']+")


def yaml_text(raw: bytes) -> str:
    """Return the text of a scalar from its bytes.

    Raises:
        EditError: The bytes are not UTF-8.
    """
    try:
        written = raw.decode()
    except UnicodeDecodeError as error:
        raise EditError("A YAML value is not UTF-8 text.") from error
    if len(written) >= 2 and written[0] == written[-1] == "'":
        return written[1:-1].replace("''", "'")
    if len(written) >= 2 and written[0] == written[-1] == '"':
        return _ESCAPE.sub(_meant, written[1:-1])
    return written


def _meant(escape: re.Match[str]) -> str:
    code = escape[1] or escape[2] or escape[3]
    if not code:
        return _MEANING.get(escape[4], escape[4])
    number = int(code, 16)
    return chr(number) if number < 0x110000 else "\ufffd"


def yaml_bytes(text: str, like: bytes) -> bytes:
    """Spell `text` as a scalar in the style of `like`, quoted when it could not be read otherwise.

    A plain scalar stays plain when it can, so that the type follows the text as in an editor.

    Raises:
        EditError: The text holds half a surrogate pair.
    """
    if any("\ud800" <= character <= "\udfff" for character in text):
        raise EditError("The text holds half a character: leave it out.")
    printable = _PRINTABLE.fullmatch(text) is not None
    if like[:1] == b'"' or not printable:
        return f'"{_escaped(text)}"'.encode()
    if like[:1] == b"'" or not _can_be_plain(text):
        return "'{}'".format(text.replace("'", "''")).encode()
    return text.encode()


def _can_be_plain(text: str) -> bool:
    """Whether a plain scalar may be this text, also between brackets and at the line's start."""
    return (
        _PLAIN.fullmatch(text) is not None
        and _NOT_PLAIN.search(text) is None
        and not text.startswith(("---", "..."))
    )


def _escaped(text: str) -> str:
    return "".join(_spelled(character) for character in text)


def _spelled(character: str) -> str:
    if character in _SPELLING:
        return _SPELLING[character]
    if _PRINTABLE.fullmatch(character):
        return character
    return f"\\x{ord(character):02x}" if ord(character) < 0x100 else f"\\u{ord(character):04x}"


@dataclass(frozen=True, slots=True)
class YamlScalar:
    """One value on one line. `line` and `column` are 1-based; `text` has no quotes and no tag."""

    path: KeyPath
    span: Span
    text: str
    line: int
    column: int
    tag: str = ""
    """As written, e.g. `!degrees`; empty without one."""


@dataclass(frozen=True, slots=True)
class YamlDocument:
    """The first document of a file: its editable scalars in file order, comments, and aliases.

    `aliases` maps the key path of each `*alias` to the path of what it stands for; the scalars
    there are listed once, where they are written.
    """

    scalars: tuple[YamlScalar, ...] = ()
    comments: tuple[Comment, ...] = ()
    aliases: tuple[tuple[KeyPath, KeyPath], ...] = ()
    headings: tuple[int, ...] = ()
    """Line (1-based) of each key that opens a mapping or a list over several lines."""


def key_path_text(path: KeyPath) -> str:
    """Write a key path, e.g. `joint_limits.shoulder_pan.max_position` or `offsets[0].x`."""
    written = ""
    for part in path:
        if isinstance(part, int):
            written += f"[{part}]"
        elif _SIMPLE_KEY.fullmatch(part):
            written += f".{part}" if written else part
        else:
            quoted = part.replace("\\", "\\\\").replace('"', '\\"')
            written += f'["{quoted}"]'
    return written


def read_yaml_document(data: bytes) -> YamlDocument:
    """Find every scalar of the first document; a text that no run reads has none.

    A key that occurs twice counts where YAML takes it from: the last time. Scalars over several
    lines, empty ones and those of non-scalar keys are left out.
    """
    if is_bulky(data):
        return YamlDocument()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return YamlDocument()
    reader = _Reader(text, len(data) - len(data.removeprefix(b"\xef\xbb\xbf")))
    try:
        reader.read()
    except yaml.YAMLError:
        return YamlDocument()
    return reader.document()


@dataclass(slots=True)
class _Container:
    """A mapping or list that is open: `key` is the pending key, or the index of the next item."""

    path: KeyPath
    key: str | int | None = None
    keys: set[str] = field(default_factory=set[str])
    """All keys so far."""


@dataclass(slots=True)
class _Reader:
    """One pass over the events of a text; `bom` is the length of the bytes before it."""

    text: str
    bom: int
    open: list[_Container] = field(default_factory=list[_Container])
    scalars: list[tuple[int, YamlScalar]] = field(default_factory=list[tuple[int, YamlScalar]])
    repeated: dict[KeyPath, int] = field(default_factory=dict["KeyPath", int])
    """Keys that occur again in their mapping: where the last one stands, in characters."""
    aliases: list[tuple[KeyPath, KeyPath]] = field(
        default_factory=list[tuple["KeyPath", "KeyPath"]]
    )
    headings: list[int] = field(default_factory=list[int])
    anchors: dict[str, KeyPath] = field(default_factory=dict[str, "KeyPath"])
    covered: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])
    key_line: int = 0
    _offset: tuple[int, int] = (0, 0)

    def read(self) -> None:
        """Take the events of the first document, up to the limits."""
        for count, event in enumerate(_events(self.text)):
            too_much = len(self.open) > _DEPTH_LIMIT or count > _EVENT_LIMIT
            if too_much or isinstance(event, yaml.DocumentEndEvent):
                return
            self._take(event)

    def document(self) -> YamlDocument:
        """Return what was found."""
        scalars = tuple(one for at, one in self.scalars if not self._is_overruled(one, at))
        return YamlDocument(
            scalars, tuple(self._comments()), tuple(self.aliases), tuple(self.headings)
        )

    def _take(self, event: yaml.Event) -> None:
        if isinstance(event, yaml.ScalarEvent):
            self._take_scalar(event)
        elif isinstance(event, yaml.AliasEvent):
            self._take_alias(event)
        elif isinstance(event, yaml.CollectionStartEvent):
            self._open(event)
        elif isinstance(event, yaml.CollectionEndEvent):
            self.open.pop()

    def _take_scalar(self, event: yaml.ScalarEvent) -> None:
        start, end = event.start_mark.index, event.end_mark.index
        self.covered.append((start, end))
        if self._is_key():
            self._take_key(event)
            return
        path = self._next_path()
        self._remember_anchor(event, path)
        properties = _PROPERTIES.match(self.text, start, end)
        start = properties.end() if properties else start
        raw = self.text[start:end]
        if raw and _UNNAMED not in path and _is_written_as(raw, event.value):
            self.scalars.append((start, self._scalar(path, start, raw, event)))

    def _take_key(self, event: yaml.ScalarEvent) -> None:
        container = self.open[-1]
        if event.value in container.keys:
            self.repeated[(*container.path, event.value)] = event.start_mark.index
        container.keys.add(event.value)
        container.key = event.value
        self.key_line = event.end_mark.line + 1

    def _is_overruled(self, scalar: YamlScalar, index: int) -> bool:
        """Whether it, or a container of it, comes again further down under the same key."""
        if not self.repeated:
            return False
        prefixes = (scalar.path[:size] for size in range(1, len(scalar.path) + 1))
        return any(index < self.repeated.get(prefix, 0) for prefix in prefixes)

    def _scalar(self, path: KeyPath, start: int, raw: str, event: yaml.ScalarEvent) -> YamlScalar:
        first = self._byte_offset(start)
        span = Span(first, first + len(raw.encode()), "yaml")
        line, column = event.end_mark.line + 1, event.end_mark.column - len(raw) + 1
        return YamlScalar(path, span, event.value, line, column, event.tag or "")

    def _take_alias(self, event: yaml.AliasEvent) -> None:
        if self._is_key():
            self.open[-1].key = f"*{event.anchor}"
            return
        path = self._next_path()
        target = self.anchors.get(event.anchor)
        if target is not None:
            self.aliases.append((path, target))

    def _open(self, event: yaml.CollectionStartEvent) -> None:
        if self._is_key():  # a list or mapping as a key: nothing in it can be named
            self.open[-1].key = _UNNAMED
            path: KeyPath = (*self.open[-1].path, _UNNAMED)
        else:
            path = self._next_path()
        self._remember_anchor(event, path)
        if path and not event.flow_style and isinstance(path[-1], str):
            self.headings.append(self.key_line)
        is_list = isinstance(event, yaml.SequenceStartEvent)
        self.open.append(_Container(path, 0 if is_list else None))

    def _remember_anchor(
        self, event: yaml.ScalarEvent | yaml.CollectionStartEvent, path: KeyPath
    ) -> None:
        if event.anchor:
            self.anchors[event.anchor] = path

    def _is_key(self) -> bool:
        """Whether the next node is a mapping's key."""
        return bool(self.open) and self.open[-1].key is None

    def _next_path(self) -> KeyPath:
        """Return the path of the value that comes now; the container moves on."""
        if not self.open:
            return ()
        container = self.open[-1]
        key = container.key
        assert key is not None
        container.key = key + 1 if isinstance(key, int) else None
        return (*container.path, key)

    def _byte_offset(self, index: int) -> int:
        """Byte offset of a character; scalars come in file order, so each text is encoded once."""
        if self.text.isascii():
            return self.bom + index
        last_index, last_byte = self._offset
        last_byte += len(self.text[last_index:index].encode())
        self._offset = (index, last_byte)
        return self.bom + last_byte

    def _comments(self) -> Iterator[Comment]:
        """Comments outside of scalars; in file order."""
        line, position = 1, 0
        while (found := _COMMENT.search(self.text, position)) is not None:
            line += self.text.count("\n", position, found.start())
            position = self._end_of_scalar_at(found.start())
            if position is None:
                line_start = self.text.rfind("\n", 0, found.start()) + 1
                own_line = not self.text[line_start : found.start()].strip()
                yield Comment(found[1], line, line, own_line=own_line)
            else:
                line += self.text.count("\n", found.start(), position)
            position = position or found.end()

    def _end_of_scalar_at(self, index: int) -> int | None:
        """Return the end of the scalar that has a character; None when none has."""
        near = bisect.bisect_right(self.covered, (index, len(self.text))) - 1
        if near < 0 or index >= self.covered[near][1]:
            return None
        return self.covered[near][1]


def _events(text: str) -> Iterator[yaml.Event]:
    yield from yaml.parse(text, Loader=_LOADER)


def _is_written_as(raw: str, value: str) -> bool:
    """Whether the text between the marks is this scalar on one line, so that it can be replaced."""
    if "\n" in raw or "\r" in raw:
        return False
    try:
        return yaml_text(raw.encode()) == value
    except EditError:
        return False
