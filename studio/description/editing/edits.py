"""Edits of bytes: how a text is spelled at a span, how edits apply, and what a fix comes to."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import TYPE_CHECKING, AnyStr, Final

from studio.description.syntax.attribute_spans import (
    attribute_bytes,
    attribute_text,
    text_encoding,
    writing_encoding,
)
from studio.description.syntax.params import param_bytes, param_text
from studio.description.syntax.yaml_spans import yaml_bytes, yaml_text
from studio.description.values import Edit, Span
from studio.errors import EditError, StaleTextError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.problems import Replacement

_XML_QUOTES = {"param": '"', "param'": "'"}
_QUOTES: Final = frozenset({'"', "'"})
_PLAIN: Final = re.compile(rb"[ !#-%(-;=-~]*")
"""Printable ASCII without `"`, `&`, `'` and `<`: in an attribute it stands for itself."""


def decode(data: bytes, span: Span) -> str:
    """Return the text that stands at `span`: quotes off, references and escapes resolved.

    Raises:
        EditError: The bytes there are not of the file's encoding.
    """
    raw = data[span.start : span.end]
    if span.syntax == "yaml":
        return yaml_text(raw)
    if span.syntax in _XML_QUOTES:
        return param_text(raw, text_encoding(data))
    return attribute_text(raw, text_encoding(data))


def encode(text: str, data: bytes, span: Span) -> bytes:
    """Spell `text` for `span` in the style it has; unchanged if it has that text already.

    Raises:
        EditError: The place cannot hold the text.
    """
    raw = data[span.start : span.end]
    if span.syntax in _QUOTES and text.isascii() and _PLAIN.fullmatch(raw):
        written = text.encode()
        if _PLAIN.fullmatch(written):
            return written  # a number, mostly: then the file need not be read for its encoding
    if text == decode(data, span):
        return raw
    if span.syntax == "yaml":
        return yaml_bytes(text, raw)
    if span.syntax in _XML_QUOTES:
        like = attribute_text(raw, text_encoding(data))
        return param_bytes(text, like, _XML_QUOTES[span.syntax], writing_encoding(data))
    return attribute_bytes(text, span.syntax, writing_encoding(data))


def edit_at(file: str, data: bytes, span: Span, text: str) -> Edit:
    """Return the edit that writes `text` at `span` of `file`, whose bytes now are `data`.

    Raises:
        EditError: The place cannot hold the text.
    """
    return Edit(file, span.start, span.end, encode(text, data, span))


def apply(data: bytes, edits: Iterable[Edit]) -> bytes:
    """Apply edits one after the other; each one's offsets are in the result of those before it.

    Raises:
        EditError: An edit lies outside the bytes.
    """
    text = bytearray(data)
    for edit in edits:
        apply_to(text, edit)
    return bytes(text)


def apply_to(text: bytearray, edit: Edit) -> bytes:
    """Apply an edit in place, which of thousands copies no whole text; the bytes that it took.

    Raises:
        EditError: It lies outside the bytes.
    """
    if not 0 <= edit.start <= edit.end <= len(text):
        raise EditError(f"{edit.file}: bytes {edit.start}-{edit.end} are not in the file.")
    taken = bytes(text[edit.start : edit.end])
    text[edit.start : edit.end] = edit.new
    return taken


def inverse(data: bytes, edit: Edit) -> Edit:
    """Return the edit that takes `edit`, applied to `data`, back."""
    old = data[edit.start : edit.end]
    return Edit(edit.file, edit.start, edit.start + len(edit.new), old)


def difference(file: str, old: bytes, new: bytes) -> Edit | None:
    """Return the shortest single edit from `old` to `new`; None when they are equal."""
    if old == new:
        return None
    start = common_start(old, new)
    end = common_start(old[start:][::-1], new[start:][::-1])
    return Edit(file, start, len(old) - end, new[start : len(new) - end])


def common_start(one: AnyStr, other: AnyStr) -> int:
    """Length of what two texts begin with, by halving: slices compare at the speed of memory."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low


def edits_of(
    replacements: Iterable[Replacement], text_of: Callable[[str], bytes]
) -> tuple[Edit, ...]:
    """Return the edits of the replacements, file by file, the last place first: so offsets hold.

    Of two insertions at the same place, the first one's text comes first.

    Raises:
        StaleTextError: Other bytes are there by now, or two want the same place.
        PackageError: A file cannot be read.
    """
    by_file: dict[str, list[Edit]] = {}
    for one in replacements:
        by_file.setdefault(one.file, []).append(_trimmed(one, text_of(one.file)))
    return tuple(edit for edits in by_file.values() for edit in _from_the_end(edits))


def apart(fixes: Iterable[Sequence[Replacement]]) -> list[Replacement]:
    """Return the replacements of all fixes that want a place of their own, the earlier fix first.

    Fixes that repeat the same text beside what they put in do not hinder one another.
    """
    taken: list[Replacement] = []
    for edits in fixes:
        if not any(_collide(one, other) for one in edits for other in taken):
            taken += edits
    return taken


def _trimmed(one: Replacement, data: bytes) -> Edit:
    """Only what changes, without what is repeated for the sake of its place."""
    encoding = text_encoding(data)
    before = one.before.encode(encoding, "xmlcharrefreplace")
    if not before or data[one.start : one.end] != before:
        raise StaleTextError(one.file)
    text = one.text.encode(encoding, "xmlcharrefreplace")
    head = common_start(before, text)
    tail = common_start(before[head:][::-1], text[head:][::-1])
    return Edit(one.file, one.start + head, one.end - tail, text[head : len(text) - tail])


def _from_the_end(edits: Sequence[Edit]) -> list[Edit]:
    ordered = sorted(enumerate(edits), key=lambda row: (row[1].start, row[1].end, row[0]))
    found = [edit for _, edit in ordered]
    for one, later in pairwise(found):
        if one.end > later.start:
            raise StaleTextError(one.file)
    return found[::-1]


def _collide(one: Replacement, other: Replacement) -> bool:
    """Whether both change the same bytes; to put in at the same place is no collision."""
    if one.file != other.file:
        return False
    (start, end), (begin, stop) = _changed(one), _changed(other)
    return (start < stop and begin < end) or (one == other)


def _changed(one: Replacement) -> tuple[int, int]:
    """Return the bytes that really change, in the file, as far as letters of one byte go."""
    head = common_start(one.before, one.text)
    tail = common_start(one.before[head:][::-1], one.text[head:][::-1])
    lead = len(one.before[:head].encode())
    return one.start + lead, one.end - len(one.before[len(one.before) - tail :].encode())
