"""The edits that a fix comes to in the texts as they are now, or that its place is gone."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from studio.description.editing.splice import common_start
from studio.description.syntax.attribute_spans import text_encoding
from studio.description.values import Edit
from studio.errors import StaleTextError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from studio.problems import Replacement


def edits_of(
    replacements: Iterable[Replacement], text_of: Callable[[str], bytes]
) -> tuple[Edit, ...]:
    """What the replacements change, file by file, the last place first: so each one's bytes hold.

    Of two that put something in at the same place, the first one's text comes first.

    Raises:
        StaleTextError: Other bytes stand there by now, or two want the same place.
        PackageError: A file cannot be read.
    """
    by_file: dict[str, list[Edit]] = {}
    for one in replacements:
        by_file.setdefault(one.file, []).append(_trimmed(one, text_of(one.file)))
    return tuple(edit for edits in by_file.values() for edit in _from_the_end(edits))


def apart(fixes: Iterable[Sequence[Replacement]]) -> list[Replacement]:
    """The replacements of all fixes that want a place of their own, the earlier fix first.

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
    """The bytes that really change, in the file, as far as letters of one byte go."""
    head = common_start(one.before, one.text)
    tail = common_start(one.before[head:][::-1], one.text[head:][::-1])
    lead = len(one.before[:head].encode())
    return one.start + lead, one.end - len(one.before[len(one.before) - tail :].encode())
