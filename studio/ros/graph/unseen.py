"""Processes of ROS that publish at a router, though none of their nodes is seen there."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, cast

from studio.errors import TokenError
from studio.ros.tokens import EndpointToken, parse_token, tokens_of_domain
from studio.ros.wire.zenoh import admin_answers, standing_tokens

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Session

_TIMEOUT_S: Final = 3.0
_DOUBT_S: Final = 1.0
"""So long after its first publisher the tokens of a process that starts may take."""
_ASKED_MAX: Final = 5
_STRANGE: Final = ""


@dataclass(frozen=True, slots=True)
class UnseenNodes:
    """Processes whose tokens a router does not pass on.

    Attributes:
        count: How many, in the domain that was looked at.
        versions: Of Zenoh that they have, such as `1.8.0`; empty where they do not say.
        router_versions: Of Zenoh that the routers have; empty where they do not say.
    """

    count: int
    versions: tuple[str, ...]
    router_versions: tuple[str, ...]


def unseen_nodes(wire: WireSession) -> UnseenNodes | None:
    """Compare who publishes with who shows a token; None when everybody is seen.

    Every process of rmw_zenoh says in Zenoh's admin space what it publishes, and the queries for
    that reach it where its tokens do not get through. Lasts some seconds at most, so in a thread.
    """
    session = wire.zenoh
    publishing = set(_publishing(session, wire.domain))
    unseen = publishing - _shown(session, wire.domain)
    if unseen:
        time.sleep(_DOUBT_S)
        unseen -= _shown(session, wire.domain)
    if not unseen:
        return None
    asked = sorted(unseen)[:_ASKED_MAX]
    return UnseenNodes(
        len(unseen),
        _versions(session, (f"@/{zid}/peer" for zid in asked)),
        router_versions(wire),
    )


def router_versions(wire: WireSession) -> tuple[str, ...]:
    """Versions of Zenoh of the routers that this session is linked with, as far as they say."""
    zids = (str(zid) for zid in wire.zenoh.info.routers_zid())
    return _versions(wire.zenoh, (f"@/{zid}/router" for zid in zids))


def why_unseen(found: UnseenNodes) -> str:
    """Say that nodes are there, why they are not seen, and what to do."""
    who = "1 process publishes" if found.count == 1 else f"{found.count} processes publish"
    theirs = f" (Zenoh {', '.join(found.versions)})" if found.versions else ""
    routers = f" (Zenoh {', '.join(found.router_versions)})" if found.router_versions else ""
    return (
        f"{who}{theirs}, but the router{routers} shows none of the nodes: routers of Zenoh 1.9 and "
        "later refuse to show older nodes that were started before them. Start the nodes again, or "
        "replace the router by one of the studio (studio router) on the nodes' machine, or by "
        "rmw_zenohd."
    )


def _publishing(session: Session, domain: int) -> Iterator[str]:
    """Session ids of those who publish `/rosout`, as each process with a node of ROS does."""
    key = f"@/*/peer/publisher/{domain}/rosout/**"
    return (answered.split("/")[1] for answered, _ in admin_answers(session, key, _TIMEOUT_S))


def _shown(session: Session, domain: int) -> set[str]:
    tokens = standing_tokens(session, tokens_of_domain(domain), _TIMEOUT_S)
    return {_zid(token) for token in tokens}


def _zid(token: str) -> str:
    try:
        parsed = parse_token(token)
    except TokenError:
        return _STRANGE
    return parsed.node.zid if isinstance(parsed, EndpointToken) else parsed.zid


def _versions(session: Session, keys: Iterable[str]) -> tuple[str, ...]:
    found = {_version(said) for key in keys for _, said in admin_answers(session, key, _TIMEOUT_S)}
    return tuple(sorted(found - {_STRANGE}))


def _version(said: bytes) -> str:
    """`1.8.0` of `v1.8.0-2687c51 built with rustc 1.95.0`; empty where it says none."""
    try:
        told: object = json.loads(said)
    except ValueError:
        return _STRANGE
    version = cast("dict[str, object]", told).get("version") if isinstance(told, dict) else None
    if not isinstance(version, str):
        return _STRANGE
    number = version.removeprefix("v").partition(" ")[0].partition("-")[0]
    return number if len(number) <= 20 and number.replace(".", "").isalnum() else _STRANGE
