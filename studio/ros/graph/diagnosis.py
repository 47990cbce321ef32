"""Finds out why no node is seen or no message arrives, in sentences with what to do."""

from __future__ import annotations

import json
import time
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, cast

from studio.errors import InterfaceError, TokenError
from studio.ros.profiles import PROFILES
from studio.ros.tokens import (
    EndpointToken,
    NodeToken,
    nodes_of_domain,
    parse_token,
    tokens_of_domain,
)
from studio.ros.types.library import TypeLibrary
from studio.ros.wire.bridges.dialect import PROGRAM
from studio.ros.wire.versions import version_number
from studio.ros.wire.zenoh import admin_answers, live_tokens

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.profiles import WireProfile
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Session

_NAMED_MAX = 3
_ADMIN_TIMEOUT_S: Final = 3.0
_STARTING_S: Final = 1.0
"""Tokens of a process that starts may come so much later than its first publisher."""
_LOOKS: Final = 4
_ASKED_MAX: Final = 5
_SESSIONS_MAX: Final = 1_000
_STRANGE: Final = ""
QUERY_TIMEOUT_S = 3.0


@dataclass(frozen=True, slots=True)
class ForeignHashes:
    """Types that others have in another form than the distribution that is spoken.

    Attributes:
        types: Their names, in order.
        distros: Of which each of these forms is, as far as is known; empty when of none.
    """

    types: tuple[str, ...]
    distros: tuple[str, ...]


def why_nobody(endpoint: str, domain: int, nodes_by_domain: Mapping[int, int]) -> str | None:
    """Return why no node is seen at a router that is there; None when some are in the domain."""
    if nodes_by_domain.get(domain):
        return None
    others = {other: count for other, count in nodes_by_domain.items() if count}
    if not others:
        return (
            f"The router at {endpoint} is there, but no node is: start one, with "
            f"RMW_IMPLEMENTATION=rmw_zenoh_cpp if it is one of ROS 2, or {PROGRAM} "
            "beside nodes that use DDS."
        )
    places = ", ".join(f"{_nodes(count)} in domain {other}" for other, count in others.items())
    return f"No node is in domain {domain}, but {places}: choose --domain {min(others)}."


def foreign_hashes(
    endpoints: Iterable[GraphEndpoint],
    profile: WireProfile,
    hash_of: Callable[[str, str], str | None],
    distros: Iterable[str] = tuple(PROFILES),
) -> list[ForeignHashes]:
    """Find the types that others have in another form, by the distributions that have that form.

    Args:
        endpoints: Of others.
        profile: The distribution that is spoken.
        hash_of: Gives the hash that stands in keys for a distribution and the name of a type;
            None where that knows no such type, as a `DistroHashes` does.
        distros: The names of distributions that may be meant.
    """
    known = list(distros)
    by_distros: dict[tuple[str, ...], set[str]] = {}
    told = {(one.type_name, one.type_hash) for one in endpoints if one.type_hash}
    for type_name, type_hash in sorted(told):
        ours = hash_of(profile.distro, type_name)
        if ours in {None, type_hash}:
            continue
        same = tuple(one for one in known if hash_of(one, type_name) == type_hash)
        by_distros.setdefault(same, set()).add(type_name)
    return [
        ForeignHashes(tuple(sorted(types)), distros_of)
        for distros_of, types in sorted(by_distros.items())
    ]


class DistroHashes:
    """The hashes of types as every known distribution has them, each read when it is asked for."""

    def __init__(self, own: TypeLibrary) -> None:
        self._libraries = {own.distro: own}

    def __call__(self, distro: str, type_name: str) -> str | None:
        """Return the hash in keys; None for a type that the distribution does not know."""
        computed = self.form_of(distro, type_name)
        return None if computed is None else PROFILES[distro].type_hash(computed)

    def form_of(self, distro: str, type_name: str) -> str | None:
        """Return the same as computed, also where keys of the distribution hold none."""
        if distro not in self._libraries:
            self._libraries[distro] = TypeLibrary(distro)
        try:
            return self._libraries[distro].hash_of(type_name)
        except InterfaceError:
            return None


def why_not_received(found: ForeignHashes, profile: WireProfile) -> str:
    """Return a sentence with the types that differ, and what to do."""
    named = ", ".join(found.types[:_NAMED_MAX])
    more = len(found.types) - _NAMED_MAX
    types = named + (f" and {more} more" if more > 0 else "")
    if found.distros:
        which = " or ".join(found.distros)
        return (
            f"Others have {types} as of {which}, where {profile.distro} is spoken, and neither "
            f"receives the other: choose --distro {found.distros[0]}."
        )
    return (
        f"Others have another form of {types} than {profile.distro}, and neither receives the "
        "other: give their packages with --interfaces."
    )


def _nodes(count: int) -> str:
    return "1 node is" if count == 1 else f"{count} nodes are"


@dataclass(frozen=True, slots=True)
class UnseenNodes:
    """Processes whose tokens a router does not pass on.

    Attributes:
        count: Their number, in the domain examined.
        versions: Their versions of Zenoh, such as `1.8.0`; empty if not reported.
        router_versions: Versions of Zenoh of the routers; empty if not reported.
    """

    count: int
    versions: tuple[str, ...]
    router_versions: tuple[str, ...]


def unseen_nodes(wire: WireSession) -> UnseenNodes | None:
    """Compare publishers with liveliness tokens; None when all nodes are seen.

    Every process of rmw_zenoh lists in Zenoh's admin space what it publishes, and queries for that
    reach it even if its tokens do not get through. Takes some seconds: call it in a thread.
    """
    session = wire.zenoh
    publishing = set(_publishing(session, wire.domain))
    # Nodes first: with thousands of endpoints their tokens take seconds.
    unseen = publishing - _shown(session, nodes_of_domain(str(wire.domain)))
    for _ in range(_LOOKS):
        if not unseen:
            return None
        # A router answers with a part of its tokens, or none, now and then.
        time.sleep(_STARTING_S / _LOOKS)
        unseen -= _shown(session, tokens_of_domain(wire.domain))
    if not unseen:
        return None
    asked = sorted(unseen)[:_ASKED_MAX]
    return UnseenNodes(
        len(unseen),
        _versions(session, (f"@/{zid}/peer" for zid in asked)),
        router_versions(wire),
    )


def why_unseen(found: UnseenNodes) -> str:
    """Return a sentence on why nodes are not seen, and what to do."""
    who = "1 process publishes" if found.count == 1 else f"{found.count} processes publish"
    theirs = f" (Zenoh {', '.join(found.versions)})" if found.versions else ""
    routers = f" (Zenoh {', '.join(found.router_versions)})" if found.router_versions else ""
    return (
        f"{who}{theirs}, but the router{routers} shows none of the nodes: routers of Zenoh 1.9 and "
        "later refuse to show older nodes that were started before them. Start the nodes again, or "
        "replace the router by one of the studio (studio router) on the nodes' machine, or by "
        "rmw_zenohd."
    )


def router_versions(wire: WireSession) -> tuple[str, ...]:
    """Return the versions of Zenoh of the routers of this session, as far as reported."""
    zids = (str(zid) for zid in wire.zenoh.info.routers_zid())
    return _versions(wire.zenoh, (f"@/{zid}/router" for zid in zids))


def versions_by_session(wire: WireSession, whatami: str) -> dict[str, str]:
    """Return Zenoh's version of every router (`router`) or process (`peer`) that tells it, by id.

    Processes of rmw_zenoh do, and routers; lasts some seconds where somebody does not answer.
    """
    found: dict[str, str] = {}
    for answered, data in admin_answers(wire.zenoh, f"@/*/{whatami}", _ADMIN_TIMEOUT_S):
        if len(found) < _SESSIONS_MAX and (version := _version(data)):
            found[answered.split("/")[1]] = version
    return found


def _publishing(session: Session, domain: int) -> Iterator[str]:
    """Session ids of those who publish `/rosout`, as each process with a node of ROS does."""
    key = f"@/*/peer/publisher/{domain}/rosout/**"
    return (answered.split("/")[1] for answered, _ in admin_answers(session, key, _ADMIN_TIMEOUT_S))


def _shown(session: Session, key: str) -> set[str]:
    tokens = live_tokens(session, key, _ADMIN_TIMEOUT_S)
    return {_zid(token) for token in tokens}


def _zid(token: str) -> str:
    try:
        parsed = parse_token(token)
    except TokenError:
        return _STRANGE
    return parsed.node.zid if isinstance(parsed, EndpointToken) else parsed.zid


def _versions(session: Session, keys: Iterable[str]) -> tuple[str, ...]:
    found = {
        _version(data) for key in keys for _, data in admin_answers(session, key, _ADMIN_TIMEOUT_S)
    }
    return tuple(sorted(found - {_STRANGE}))


def _version(data: bytes) -> str:
    """Return the number that an answer of the admin space tells; empty if there is none."""
    try:
        answer: object = json.loads(data)
    except ValueError:
        return _STRANGE
    version = cast("dict[str, object]", answer).get("version") if isinstance(answer, dict) else None
    return version_number(version) if isinstance(version, str) else _STRANGE


def nodes_by_domain(
    wire: WireSession, timeout_s: float = QUERY_TIMEOUT_S, own: Collection[str] = ()
) -> dict[int, int]:
    """Ask the router for the nodes of every domain, once; lasts `timeout_s` at most.

    Args:
        wire: The session.
        timeout_s: See above.
        own: Sessions whose nodes do not count.
    """
    return count_nodes(live_tokens(wire.zenoh, nodes_of_domain("*"), timeout_s), own)


def count_nodes(tokens: Iterable[str], own: Collection[str] = ()) -> dict[int, int]:
    """Count the nodes of each domain, in the order of their numbers; a token counts once."""
    nodes = (node for token in set(tokens) if (node := _node(token)) is not None)
    domains = Counter(node.domain for node in nodes if node.zid not in own)
    return dict(sorted(domains.items()))


def _node(token: str) -> NodeToken | None:
    try:
        parsed = parse_token(token)
    except TokenError:
        return None
    return parsed if isinstance(parsed, NodeToken) else None
