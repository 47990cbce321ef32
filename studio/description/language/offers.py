"""Things that may be typed at a cursor: written as snippets, chosen and ranked by what is typed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.language.questions import Completion, Completions, SubjectKind

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.description.language.cursor import Cursor

OFFERS_SHOWN: Final = 200


@dataclass(frozen=True, slots=True)
class Offer:
    """One completion; those of a lower `group` are likelier."""

    group: int
    completion: Completion


class Snippet:
    """A text to insert, with places that the cursor visits; lengths in UTF-16 code units."""

    def __init__(self) -> None:
        self.text = ""
        self.stops: list[tuple[int, int]] = []

    def write(self, text: str) -> Snippet:
        """Add plain text."""
        self.text += text
        return self

    def stop(self, text: str = "") -> Snippet:
        """Add a place to visit, with the text that it first holds."""
        start = _units(self.text)
        self.text += text
        self.stops.append((start, _units(self.text)))
        return self

    def attribute(self, name: str, text: str = "") -> Snippet:
        """Add ` name="text"`, the text to be typed over."""
        return self.write(f' {name}="').stop(text).write('"')


def _units(text: str) -> int:
    return len(text) if text.isascii() else len(text.encode("utf-16-le")) // 2


def plain(
    group: int, kind: SubjectKind, label: str, *, insert: str | None = None, detail: str = "",
    doc: str = "",
) -> Offer:  # fmt: skip
    """Return an offer of a text without places to visit."""
    text = label if insert is None else insert
    return Offer(group, Completion(label, kind, text, detail=detail, doc=doc))


def written(
    group: int, kind: SubjectKind, label: str, snippet: Snippet, *, detail: str = "", doc: str = ""
) -> Offer:
    """Return an offer of a snippet."""
    stops = tuple(snippet.stops)
    return Offer(group, Completion(label, kind, snippet.text, stops, detail=detail, doc=doc))


def chosen(offers: Iterable[Offer], cursor: Cursor, start: int, end: int) -> Completions:
    """Return the offers that fit what is typed between `start` and the cursor, the likeliest first.

    Args:
        offers: In any order; of several with one label the likeliest stays.
        cursor: Where they may be typed.
        start: Where the typed name begins, in characters of the text.
        end: Where it ends, at or behind the cursor.
    """
    typed = cursor.text[start : cursor.index].lower()
    ranked: dict[str, tuple[tuple[int, int, str], Completion]] = {}
    for offer in offers:
        label = offer.completion.label
        match = _match(label.lower(), typed)
        if match is None:
            continue
        rank = (match, offer.group, label.lower())
        if label not in ranked or rank < ranked[label][0]:
            ranked[label] = rank, offer.completion
    ordered = sorted(ranked.values(), key=lambda one: one[0])
    items = tuple(completion for _, completion in ordered[:OFFERS_SHOWN])
    first, last = cursor.offsets(start, end)
    return Completions(first, last, items, is_whole=len(ordered) <= OFFERS_SHOWN)


def _match(label: str, typed: str) -> int | None:
    """0: begins with it, 1: a part of it does, 2: holds it, None: does not."""
    if label.startswith(typed):
        return 0
    at = label.find(typed)
    if at < 0:
        return None
    return 1 if label[at - 1] in "_:/.-" else 2
