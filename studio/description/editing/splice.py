"""The one edit primitive: some bytes of a file replaced by others, everything else untouched."""

from __future__ import annotations

from typing import TYPE_CHECKING, AnyStr

from studio.description.evaluator.param_spans import param_bytes, param_text
from studio.description.syntax.attribute_spans import (
    attribute_bytes,
    attribute_text,
    text_encoding,
    writing_encoding,
)
from studio.description.syntax.yaml_text import yaml_bytes, yaml_text
from studio.description.values import Edit, Span
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable

_XML_QUOTES = {"param": '"', "param'": "'"}


def decode(data: bytes, span: Span) -> str:
    """The text that stands at `span`: quotes off, references and escapes resolved.

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
    """Spell `text` for `span` in the style it has; as it is now when it says that already.

    Raises:
        EditError: The place cannot hold the text.
    """
    raw = data[span.start : span.end]
    if text == decode(data, span):
        return raw
    if span.syntax == "yaml":
        return yaml_bytes(text, raw)
    if span.syntax in _XML_QUOTES:
        like = attribute_text(raw, text_encoding(data))
        return param_bytes(text, like, _XML_QUOTES[span.syntax], writing_encoding(data))
    return attribute_bytes(text, span.syntax, writing_encoding(data))


def edit_at(file: str, data: bytes, span: Span, text: str) -> Edit:
    """The edit that writes `text` at `span` of `file`, whose bytes now are `data`.

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
    """The edit that takes `edit`, applied to `data`, back."""
    old = data[edit.start : edit.end]
    return Edit(edit.file, edit.start, edit.start + len(edit.new), old)


def difference(file: str, old: bytes, new: bytes) -> Edit | None:
    """The shortest single edit from `old` to `new`; None when they are equal."""
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
