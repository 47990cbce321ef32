"""Messages between the studio and its xacro worker, packed alike at both ends.

Queries change nothing; every one is answered from the last good run, also while the texts are
broken. A new question is a value in `QUERIES`, its reply one in `REPLIES`, and an arm in
`Session.query`.
"""

from __future__ import annotations

from typing import Final, TypeAlias

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
from studio.description.values import (
    ArgumentsRequest,
    Checked,
    CheckQuery,
    EditRequest,
    Expansion,
    Failure,
    NoReply,
    OpenRequest,
    ReloadRequest,
    VerifyRequest,
)
from studio.worker_process import Codec

Query: TypeAlias = PartOriginQuery | SiteEffectsQuery | CheckQuery | LanguageQuery
Reply: TypeAlias = PartOrigin | SiteEffects | Checked | NoReply | LanguageReply
QUERIES: Final = (PartOriginQuery, SiteEffectsQuery, CheckQuery, *LANGUAGE_QUERIES)
REPLIES: Final = (PartOrigin, SiteEffects, Checked, NoReply, *LANGUAGE_REPLIES)
SHARED: Final = "shared"
"""Argument of a worker that many documents share."""
CODEC = Codec(
    OpenRequest,
    EditRequest,
    ArgumentsRequest,
    ReloadRequest,
    VerifyRequest,
    Expansion,
    Failure,
    *QUERIES,
    *REPLIES,
)
