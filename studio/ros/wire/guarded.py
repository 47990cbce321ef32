"""A router that lets in only who has a certificate, and each only into their own ROS domains."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import RouterNotStartedError
from studio.ros.tokens import ADMIN_SPACE
from studio.ros.wire.endpoints import ProbeResult, probe
from studio.ros.wire.router import EmbeddedRouter
from studio.ros.wire.settings import LEASE_MS
from studio.ros.wire.zenoh import ZError, insert, open_zenoh, read_config

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.ros.wire.credentials import Credentials
    from studio.ros.wire.endpoints import Endpoint
    from studio.ros.wire.zenoh import Config

_EVERYTHING: Final = (
    *("put", "delete", "declare_subscriber"),
    *("query", "reply", "declare_queryable"),
    *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
)
"""All that Zenoh's rules tell apart."""
_HANDSHAKE_MS: Final = 5_000
"""Who begins a handshake and falls silent is let go after this."""
_HANDSHAKES_MAX: Final = 100
_SESSIONS_MAX: Final = 1_000
_BLOCKING_US: Final = 200_000
"""So long a sample that must not be lost may wait for a slow reader, whose link ends then."""


@dataclass(frozen=True, slots=True)
class DomainUser:
    """The common name of a certificate, and the ROS domains that are all its holder reaches."""

    name: str
    domains: tuple[int, ...]


def start_guarded_router(
    endpoint: Endpoint, credentials: Credentials, users: Sequence[DomainUser]
) -> EmbeddedRouter:
    """Listen by TLS; who may do what is fixed until it is closed, for Zenoh reads it at the start.

    Two users who share no domain see nothing of each other: neither topics, services and their
    values, nor the graph.

    Args:
        endpoint: Where, as `tls/127.0.0.1:7448`.
        credentials: The router's, and the authority that signed those of the users.
        users: Who may join; whoever else the authority knows reaches nothing.

    Raises:
        RouterNotStartedError: The endpoint is held by another program, or cannot be listened at.
    """
    try:
        session = open_zenoh(_config(endpoint, credentials, users))
    except ZError as error:
        reason = str(error).split(" at /")[0]
        held = probe(endpoint) is not ProbeResult.NOBODY
        raise RouterNotStartedError(endpoint.text, reason, held=held) from None
    return EmbeddedRouter(session, endpoint)


def _config(endpoint: Endpoint, credentials: Credentials, users: Sequence[DomainUser]) -> Config:
    config = read_config()
    insert(config, "mode", '"router"')
    insert(config, "listen/endpoints", json.dumps([endpoint.text]))
    insert(config, "scouting/delay", "0")
    insert(config, "scouting/multicast/enabled", "false")
    # Peers that hear of each other would link without us, where no rule holds.
    insert(config, "scouting/gossip/enabled", "false")
    insert(config, "transport/unicast/accept_timeout", str(_HANDSHAKE_MS))
    insert(config, "transport/unicast/accept_pending", str(_HANDSHAKES_MAX))
    insert(config, "transport/unicast/max_sessions", str(_SESSIONS_MAX))
    insert(config, "transport/link/tx/lease", str(LEASE_MS))
    waits = "transport/link/tx/queue/congestion_control/block/wait_before_close"
    insert(config, waits, str(_BLOCKING_US))
    for key, json5 in credentials.of_router().items():
        insert(config, key, json5)
    insert(config, "access_control", json.dumps(_rules(users)))
    return config


def _rules(users: Sequence[DomainUser]) -> dict[str, object]:
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [_rule(one) for one in users],
        "subjects": [{"id": one.name, "cert_common_names": [one.name]} for one in users],
        "policies": [{"rules": [one.name], "subjects": [one.name]} for one in users],
    }


def _rule(user: DomainUser) -> dict[str, object]:
    return {
        "id": user.name,
        "permission": "allow",
        "flows": ["ingress", "egress"],
        "messages": list(_EVERYTHING),
        "key_exprs": [key for domain in user.domains for key in _keys(domain)],
    }


def _keys(domain: int) -> tuple[str, ...]:
    """Return all keys of a domain; `**` leaves out parts that begin with an @."""
    return f"{domain}/**", f"{domain}/**/@adv/**", f"{ADMIN_SPACE}/{domain}/**"
