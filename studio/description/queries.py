"""Questions to the xacro worker that change nothing, and its replies.

Every one is answered from the last good run, also while the texts are broken. A new question is a
value here in `QUERIES`, its reply one in `REPLIES`, and an arm in `replies.reply_to`.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from studio.description.checks.check_values import Checked, CheckQuery
from studio.description.language.questions import (
    LANGUAGE_QUERIES,
    LANGUAGE_REPLIES,
    LanguageQuery,
    LanguageReply,
)
from studio.description.origins.origin_values import (
    PartOrigin,
    PartOriginQuery,
    SiteEffects,
    SiteEffectsQuery,
)
from studio.description.values import NoReply

Query: TypeAlias = PartOriginQuery | SiteEffectsQuery | CheckQuery | LanguageQuery
Reply: TypeAlias = PartOrigin | SiteEffects | Checked | NoReply | LanguageReply

QUERIES: Final = (PartOriginQuery, SiteEffectsQuery, CheckQuery, *LANGUAGE_QUERIES)
REPLIES: Final = (PartOrigin, SiteEffects, Checked, NoReply, *LANGUAGE_REPLIES)
