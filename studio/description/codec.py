"""The messages between the studio and its xacro worker, packed alike at both ends."""

from __future__ import annotations

from studio.description.queries import QUERIES, REPLIES
from studio.description.values import (
    ArgumentsRequest,
    EditRequest,
    Expansion,
    Failure,
    OpenRequest,
    ReloadRequest,
    VerifyRequest,
)
from studio.workers import Codec

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
