"""A Zenoh router inside this process, which stands in for rmw_zenohd."""

from __future__ import annotations

import contextlib
import ipaddress
import json
import logging
import secrets
import signal
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self, cast

from studio.errors import RouterNotStartedError, WireSettingsError
from studio.ros.tokens import ADMIN_SPACE
from studio.ros.wire.endpoints import Endpoint, ProbeResult, parse_endpoint, probe
from studio.ros.wire.settings import LEASE_MS
from studio.ros.wire.zenoh import (
    Config,
    ReadingThread,
    Sample,
    Session,
    ZError,
    close,
    declare_token,
    insert,
    live_tokens,
    open_zenoh,
    read_config,
    token_change,
    watch_tokens,
    watch_transports,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.ros.wire.zenoh import Declaration

_log = logging.getLogger(__name__)

_TOKENS: Final = (f"{ADMIN_SPACE}/**", "**/@adv/**", "@/*/@ros2_lv/**")
"""Tokens of nodes and endpoints, of publishers that keep samples, and of bridges to DDS."""
_USERS: Final = "transport/auth/usrpwd"
_SETTLE_S: Final = 0.5
"""After this the router has every token that it takes from the peers themselves."""
_QUERY_TIMEOUT_S: Final = 3.0
_RETRY: Final = {"period_init_ms": 250, "period_max_ms": 4_000, "period_increase_factor": 2}
_ACCEPT_TIMEOUT_MS = 5_000
"""A peer that begins a handshake and falls silent is let go after this."""
_CHECK_EVERY_S = 0.25
_OF_SESSIONS = frozenset({"mode", "connect", "listen", "scouting", "open"})
"""Keys of an override about how nodes find routers, which do not concern a router here."""


@dataclass(frozen=True, slots=True)
class RouterChoice:
    """The value of `--router`.

    Attributes:
        starts: Whether a router is started where none answers.
        endpoint: Its address; None: the endpoint to connect to.
    """

    starts: bool = True
    endpoint: Endpoint | None = None


def router_choice(text: str) -> RouterChoice:
    """Read `auto`, `off` or an endpoint.

    Raises:
        WireSettingsError: It is none of these.
    """
    if text in {"auto", "off"}:
        return RouterChoice(starts=text == "auto")
    return RouterChoice(endpoint=parse_endpoint(text))


class EmbeddedRouter:
    """A router that listens at one endpoint until it is closed."""

    def __init__(
        self, session: Session, endpoint: Endpoint, relay: TokenRelay | None = None
    ) -> None:
        """Own a session in mode router, and what declares there the tokens that it refused."""
        self._session, self._relay = session, relay
        self.endpoint = endpoint
        self.zid = str(session.info.zid())

    def close(self) -> None:
        """Hang up on everybody; again is harmless."""
        if self._relay is not None:
            self._relay.close()
        close(self._session)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def start_router(
    endpoint: Endpoint,
    overrides: Mapping[str, str] | None = None,
    config_file: str | None = None,
    joins: tuple[str, ...] = (),
) -> EmbeddedRouter:
    """Listen at an endpoint.

    Args:
        endpoint: Where.
        overrides: Keys of Zenoh's configuration and JSON5, such as its TLS keys; those by which
            sessions find routers are passed over.
        config_file: Of Zenoh, taken whole but for where it listens: that is `endpoint` alone.
        joins: Endpoints of routers, of which one is joined whenever it is there.

    Raises:
        RouterNotStartedError: The endpoint is held by another program, or cannot be listened at.
        WireSettingsError: The file cannot be read.
    """
    config = _base(config_file)
    try:
        _complete(config, endpoint, overrides or {})
        if joins:
            _join(config, joins)
        session = open_zenoh(config)
    except ZError as error:
        reason = str(error).split(" at /")[0]
        raise RouterNotStartedError(endpoint.text, reason, held=_is_held(endpoint)) from None
    return EmbeddedRouter(session, endpoint, _relay(session, endpoint, config))


def _relay(session: Session, endpoint: Endpoint, config: Config) -> TokenRelay | None:
    """Show the nodes that are older than the router; without, all others are seen as well."""
    try:
        return TokenRelay(session, endpoint, config)
    except ZError as error:
        _log.warning(
            "Nodes that are older than the router at %s stay unseen: %s", endpoint.text, error
        )
        return None


def run_router(
    listen: str,
    ready: Callable[[str], None],
    overrides: Mapping[str, str] | None = None,
    config_file: str | None = None,
    joins: tuple[str, ...] = (),
) -> None:
    """Run a router until Ctrl-C or SIGTERM; for the main thread of a process.

    Args:
        listen: The endpoint.
        ready: Given the endpoint once others may connect.
        overrides: See `start_router`.
        config_file: See `start_router`.
        joins: See `start_router`.

    Raises:
        WireSettingsError: `listen` is no endpoint, or the file cannot be read.
        RouterNotStartedError: See `start_router`.
    """
    asked_to_end = threading.Event()

    def end(_number: int, _frame: object) -> None:
        asked_to_end.set()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    with start_router(parse_endpoint(listen), overrides, config_file, joins) as router:
        ready(router.endpoint.text)
        # A signal that comes while a wait begins does not end that wait: check again.
        while not asked_to_end.wait(_CHECK_EVERY_S):
            pass


def _is_held(endpoint: Endpoint) -> bool:
    return probe(endpoint) in {ProbeResult.ZENOH, ProbeResult.TLS, ProbeResult.OTHER}


def _base(config_file: str | None) -> Config:
    """Read the user's configuration of routers, or make that of rmw_zenohd."""
    if config_file is not None:
        try:
            return read_config(config_file)
        except (ZError, OSError) as error:
            reason = str(error).split(" at /")[0]
            raise WireSettingsError(
                f"ZENOH_ROUTER_CONFIG_URI names {config_file}, which is refused: {reason}."
            ) from None
    config = read_config()
    # Zenoh would wait half a second for others that it discovers; discovery is off.
    insert(config, "scouting/delay", "0")
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "transport/unicast/accept_timeout", str(_ACCEPT_TIMEOUT_MS))
    # As rmw_zenohd: many nodes, who may be busy, and of whom those in mode peer meet without us.
    insert(config, "transport/unicast/max_sessions", "10000")
    insert(config, "transport/link/tx/lease", str(LEASE_MS))
    insert(config, "routing/router/peers_failover_brokering", "false")
    insert(config, "adminspace/enabled", "true")  # shows the links, to find faults
    return config


def _complete(config: Config, endpoint: Endpoint, overrides: Mapping[str, str]) -> None:
    insert(config, "mode", '"router"')
    insert(config, "listen/endpoints", json.dumps([endpoint.text]))
    for key, json5 in overrides.items():
        if key.partition("/")[0] not in _OF_SESSIONS:
            insert(config, key, json5)


def _join(config: Config, endpoints: tuple[str, ...]) -> None:
    insert(config, "connect/endpoints", json.dumps(endpoints))
    insert(config, "connect/timeout_ms", "0")
    insert(config, "connect/exit_on_failure", "false")
    insert(config, "connect/retry", json.dumps(_RETRY))


class TokenRelay:
    """A session in mode peer beside a router, with links to the peers that the router has.

    When a link to a router comes up, peers of Zenoh 1.8 and older send the tokens that they
    declared before it as the answer to an interest; routers of Zenoh 1.9 and later refuse them.
    So the nodes of Jazzy that are older than the router would be invisible to all clients of the
    router. This session receives the tokens of such peers by its own links to them, and what the
    router does not know is declared there for as long as the peer declares it.

    It does not listen, so it reaches only peers that listen where this machine can connect to:
    rmw_zenoh's nodes on this machine, but not those on others, which listen on their localhost.
    """

    def __init__(self, router: Session, endpoint: Endpoint, config: Config) -> None:
        """Open the session.

        Args:
            router: Where tokens are declared.
            endpoint: Where the router listens.
            config: How a session is admitted there; taken over and completed.

        Raises:
            ZError: The session cannot be opened.
        """
        self._router = router
        self._lock = threading.Lock()
        self._shown: set[str] = set()
        self._declared: dict[str, Declaration] = {}
        self._changed, self._closed = threading.Event(), threading.Event()
        self._session = open_zenoh(_beside(config, endpoint, str(router.info.zid())))
        self._readers = [
            ReadingThread("ros-token-relay", watch_tokens(self._session, key), self._take)
            for key in _TOKENS
        ]
        links = watch_transports(router)
        self._links = ReadingThread("ros-token-relay-links", links, lambda _: self._changed.set())
        self._declaring = threading.Thread(
            target=self._declare, name="ros-token-relay-declare", daemon=True
        )
        self._declaring.start()

    def close(self) -> None:
        """End the session and take back what was declared; again is harmless."""
        self._closed.set()
        self._changed.set()
        for reader in (*self._readers, self._links):
            reader.close()
        close(self._session)

    def _take(self, samples: list[Sample]) -> None:
        with self._lock:
            for sample in samples:
                token, is_alive = token_change(sample)
                if is_alive:
                    self._shown.add(token)
                    self._changed.set()
                else:
                    self._forget(token)

    def _forget(self, token: str) -> None:
        self._shown.discard(token)
        declared = self._declared.pop(token, None)
        if declared is not None:
            with contextlib.suppress(ZError):  # the router has ended
                declared.undeclare()

    def _declare(self) -> None:
        """Compare with what the router knows after each change, until the end."""
        while self._changed.wait() and not self._closed.wait(_SETTLE_S):
            self._changed.clear()
            with contextlib.suppress(ZError):  # the router has ended
                self._declare_refused()

    def _declare_refused(self) -> None:
        known = {
            token for key in _TOKENS for token in live_tokens(self._router, key, _QUERY_TIMEOUT_S)
        }
        with self._lock:
            refused = self._shown - known - self._declared.keys()
            for token in refused:
                self._declared[token] = declare_token(self._router, token)
        if refused:
            _log.debug("The router refused %d tokens, which are declared for them.", len(refused))


def _beside(config: Config, endpoint: Endpoint, router_zid: str) -> Config:
    """Complete the configuration of a peer that takes no token from the router itself.

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
    # Other routers would return what is declared here.
    insert(config, "scouting/gossip/autoconnect", '{"peer": ["peer"]}')
    # rmw_zenoh's nodes expect the peer with the greater id to connect, yet nobody can connect here.
    always = {"peer": {"to_router": "always", "to_peer": "always"}}
    insert(config, "scouting/gossip/autoconnect_strategy", json.dumps(always))
    _take_first_user(config)
    insert(config, "access_control", json.dumps(_no_tokens_from(router_zid)))
    return config


def _take_first_user(config: Config) -> None:
    """Use a name and password that the router accepts, if no user is given."""
    users = cast("Any", config).get_json(f"{_USERS}/dictionary_file")
    file = cast("str | None", json.loads(users))
    if file is None or json.loads(cast("Any", config).get_json(f"{_USERS}/user")) is not None:
        return
    with contextlib.suppress(OSError):  # the router has reported that it cannot read it
        user, _, password = Path(file).read_text().partition("\n")[0].partition(":")
        insert(config, f"{_USERS}/user", json.dumps(user))
        insert(config, f"{_USERS}/password", json.dumps(password))


def _near(endpoint: Endpoint) -> str:
    """Return the address by which this machine reaches a router, which may listen on all."""
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
