"""TokenRelay: tokens that a router refuses of older nodes, declared there for them."""

from __future__ import annotations

import contextlib
import ipaddress
import json
import logging
import secrets
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import zenoh

from studio.ros.tokens import ADMIN_SPACE
from studio.ros.wire.door import (
    close,
    declare_token,
    insert,
    standing_tokens,
    watch_tokens,
    watch_transports,
)
from studio.ros.wire.reading import ReadingThread

if TYPE_CHECKING:
    from studio.ros.wire.door import Declared
    from studio.ros.wire.endpoints import Endpoint

_log = logging.getLogger(__name__)

_TOKENS: Final = (f"{ADMIN_SPACE}/**", "**/@adv/**", "@/*/@ros2_lv/**")
"""Of nodes and endpoints, of publishers that keep samples, and of bridges to DDS."""
_USERS: Final = "transport/auth/usrpwd"
_SETTLE_S: Final = 0.5
"""After this the router has every token that it takes from the peers themselves."""
_LOOK_TIMEOUT_S: Final = 3.0
_RETRY: Final = {"period_init_ms": 250, "period_max_ms": 4_000, "period_increase_factor": 2}


class TokenRelay:
    """A session in mode peer beside a router, with links to the peers that the router has.

    When a link to a router comes up, peers of Zenoh 1.8 and older send the tokens that they
    declared before it as the answer to an interest; routers of Zenoh 1.9 and later refuse them.
    So the nodes of Jazzy that are older than the router would be seen by nobody who looks by way
    of the router. This session hears the tokens of such peers by its own links to them, and what
    the router does not know is declared there for as long as the peer shows it.

    It listens nowhere, so it reaches those peers that listen where this machine can connect to:
    rmw_zenoh's nodes on this machine, but not those on others, which listen on their localhost.
    """

    def __init__(self, router: zenoh.Session, endpoint: Endpoint, config: zenoh.Config) -> None:
        """Open the session.

        Args:
            router: Where tokens are declared.
            endpoint: Where the router listens.
            config: How a session is admitted there; taken over and completed.

        Raises:
            zenoh.ZError: The session cannot be opened.
        """
        self._router = router
        self._lock = threading.Lock()
        self._shown: set[str] = set()
        self._declared: dict[str, Declared] = {}
        self._doubted, self._closed = threading.Event(), threading.Event()
        self._session = zenoh.open(_beside(config, endpoint, str(router.info.zid())))
        self._readers = [
            ReadingThread("ros-token-relay", watch_tokens(self._session, key), self._take)
            for key in _TOKENS
        ]
        links = watch_transports(router)
        self._links = ReadingThread("ros-token-relay-links", links, lambda _: self._doubted.set())
        self._declaring = threading.Thread(
            target=self._declare, name="ros-token-relay-declare", daemon=True
        )
        self._declaring.start()

    def close(self) -> None:
        """End the session and take back what was declared; again is harmless."""
        self._closed.set()
        self._doubted.set()
        for reader in (*self._readers, self._links):
            reader.close()
        close(self._session)

    def _take(self, samples: list[zenoh.Sample]) -> None:
        with self._lock:
            for sample in samples:
                token = str(sample.key_expr)
                if sample.kind == zenoh.SampleKind.DELETE:
                    self._forget(token)
                else:
                    self._shown.add(token)
                    self._doubted.set()

    def _forget(self, token: str) -> None:
        self._shown.discard(token)
        declared = self._declared.pop(token, None)
        if declared is not None:
            with contextlib.suppress(zenoh.ZError):  # the router has ended
                declared.undeclare()

    def _declare(self) -> None:
        """Compare with what the router knows after each change, until the end."""
        while self._doubted.wait() and not self._closed.wait(_SETTLE_S):
            self._doubted.clear()
            with contextlib.suppress(zenoh.ZError):  # the router has ended
                self._declare_refused()

    def _declare_refused(self) -> None:
        known = {
            token
            for key in _TOKENS
            for token in standing_tokens(self._router, key, _LOOK_TIMEOUT_S)
        }
        with self._lock:
            refused = self._shown - known - self._declared.keys()
            for token in refused:
                self._declared[token] = declare_token(self._router, token)
        if refused:
            _log.debug("The router refused %d tokens, which are declared for them.", len(refused))


def _beside(config: zenoh.Config, endpoint: Endpoint, router_zid: str) -> zenoh.Config:
    """Complete the configuration of a peer that hears no token from the router itself.

    Else what it declares there would come back and stand for ever.
    """
    insert(config, "id", json.dumps(f"a{secrets.token_hex(15)}"))  # a file may name the router's
    insert(config, "mode", '"peer"')
    insert(config, "adminspace/enabled", "false")
    insert(config, "connect/endpoints", json.dumps([_near(endpoint)]))
    insert(config, "connect/retry", json.dumps(_RETRY))
    insert(config, "listen/endpoints", "[]")
    insert(config, "scouting/delay", "0")
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "scouting/gossip/enabled", "true")
    # Other routers would give back what is declared here.
    insert(config, "scouting/gossip/autoconnect", '{"peer": ["peer"]}')
    # rmw_zenoh's nodes expect the peer with the greater id to connect, yet nobody can connect here.
    always = {"peer": {"to_router": "always", "to_peer": "always"}}
    insert(config, "scouting/gossip/autoconnect_strategy", json.dumps(always))
    _take_first_user(config)
    insert(config, "access_control", json.dumps(_no_tokens_from(router_zid)))
    return config


def _take_first_user(config: zenoh.Config) -> None:
    """Be one of those whom the router admits by name and password, if no user is given."""
    users = cast("Any", config).get_json(f"{_USERS}/dictionary_file")
    file = cast("str | None", json.loads(users))
    if file is None or json.loads(cast("Any", config).get_json(f"{_USERS}/user")) is not None:
        return
    with contextlib.suppress(OSError):  # the router has said that it cannot read it
        user, _, password = Path(file).read_text().partition("\n")[0].partition(":")
        insert(config, f"{_USERS}/user", json.dumps(user))
        insert(config, f"{_USERS}/password", json.dumps(password))


def _near(endpoint: Endpoint) -> str:
    """Where this machine finds a router that listens at an endpoint, which may be all addresses."""
    try:
        address = ipaddress.ip_address(endpoint.host)
    except ValueError:
        return endpoint.text
    if not address.is_unspecified:
        return endpoint.text
    host = "127.0.0.1" if address.version == 4 else "[::1]"
    return f"{endpoint.protocol}/{host}:{endpoint.port}"


def _no_tokens_from(zid: str) -> dict[str, object]:
    return {
        "enabled": True,
        "default_permission": "allow",
        "rules": [
            {
                "id": "tokens",
                "permission": "deny",
                "messages": ["liveliness_token"],
                "flows": ["ingress"],
                "key_exprs": ["**", *_TOKENS],
            }
        ],
        "subjects": [{"id": "router", "zids": [zid]}],
        "policies": [{"rules": ["tokens"], "subjects": ["router"]}],
    }
