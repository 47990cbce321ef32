"""Questions to the xacro worker that change nothing, and its replies.

Every one is answered from the last good run, also while the texts are broken. A new question is a
value here in `QUERIES`, its reply one in `REPLIES`, and an arm in `replies.reply_to`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from studio.problems import MacroCall, Place  # noqa: TC001 - msgspec reads them


@dataclass(frozen=True, slots=True)
class PartOriginQuery:
    """Where does this part come from? `part` is a `Part.key`."""

    part: str


@dataclass(frozen=True, slots=True)
class NoReply:
    """The question cannot be answered; `sentence` says why and what to do."""

    sentence: str


@dataclass(frozen=True, slots=True)
class PartOrigin:
    """Where a part was written and the macro calls that led there, the outermost first."""

    part: str
    place: Place
    calls: tuple[MacroCall, ...]


Query: TypeAlias = PartOriginQuery
Reply: TypeAlias = PartOrigin | NoReply

QUERIES: Final = (PartOriginQuery,)
REPLIES: Final = (PartOrigin, NoReply)
