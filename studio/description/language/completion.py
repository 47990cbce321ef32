"""What may be typed at a cursor, by where in the markup it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.language.name_offers import (
    expression_offers,
    substitution_offers,
    word_around,
)
from studio.description.language.offers import chosen
from studio.description.language.questions import Completions
from studio.description.language.tag_offers import attribute_offers, closing_offers, tag_offers
from studio.description.language.token_at import Where
from studio.description.language.value_offers import value_offers

if TYPE_CHECKING:
    from studio.description.language.cursor import Cursor
    from studio.description.language.token_at import Segment


def completions_at(cursor: Cursor) -> Completions:
    """What may be typed at a cursor; nothing inside of comments and the like."""
    token = cursor.token
    match token.where:
        case Where.SILENT:
            return _nothing(cursor)
        case Where.TAG_NAME:
            return chosen(tag_offers(cursor), cursor, token.start, token.end)
        case Where.CLOSING:
            return chosen(closing_offers(cursor), cursor, token.start, token.end)
        case Where.ATTRIBUTE_NAME if token.tag is not None:
            offers = attribute_offers(cursor, token.tag)
            return chosen(offers, cursor, token.start, token.end)
        case _:
            return _in_text(cursor)


def _in_text(cursor: Cursor) -> Completions:
    """In a value, or between tags."""
    token = cursor.token
    if cursor.segment is not None:
        return _in_segment(cursor, cursor.segment)
    if token.tag is not None and token.attribute is not None:
        offers, start, end = value_offers(cursor, token.tag, token.attribute)
        return chosen(offers, cursor, start, end)
    if token.where is Where.CONTENT and not cursor.text[token.start : cursor.index].strip():
        return chosen(tag_offers(cursor, opening="<"), cursor, cursor.index, cursor.index)
    return _nothing(cursor)


def _in_segment(cursor: Cursor, segment: Segment) -> Completions:
    if not segment.is_expression:
        offers, start, end = substitution_offers(cursor, segment)
        return chosen(offers, cursor, start, end)
    start, end = word_around(cursor)
    return chosen(expression_offers(cursor, segment), cursor, start, min(end, segment.end))


def _nothing(cursor: Cursor) -> Completions:
    here, _ = cursor.offsets(cursor.index, cursor.index)
    return Completions(here, here)
