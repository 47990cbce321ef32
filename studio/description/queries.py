"""Questions to the xacro worker that change nothing, and its replies.

Every one is answered from the last good run, also while the texts are broken. A new question is a
value here in `QUERIES`, its reply one in `REPLIES`, and an arm in `replies.reply_to`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from studio.description.language import (
    LANGUAGE_QUERIES,
    LANGUAGE_REPLIES,
    LanguageQuery,
    LanguageReply,
)
from studio.description.origin_values import PartOrigin, SiteEffects


@dataclass(frozen=True, slots=True)
class PartOriginQuery:
    """Where does this part come from? `part` is a `Part.key`."""

    part: str


@dataclass(frozen=True, slots=True)
class SiteEffectsQuery:
    """What does this text shape? `site` is a `Site.id`."""

    site: str


@dataclass(frozen=True, slots=True)
class NoReply:
    """The question cannot be answered; `sentence` says why and what to do."""

    sentence: str


Query: TypeAlias = PartOriginQuery | SiteEffectsQuery | LanguageQuery
Reply: TypeAlias = PartOrigin | SiteEffects | NoReply | LanguageReply

QUERIES: Final = (PartOriginQuery, SiteEffectsQuery, *LANGUAGE_QUERIES)
REPLIES: Final = (PartOrigin, SiteEffects, NoReply, *LANGUAGE_REPLIES)
