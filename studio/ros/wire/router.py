"""The router of our own: a Zenoh router inside this process, where rmw_zenohd would run."""

from __future__ import annotations

import json
import logging
import signal
import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import zenoh

from studio.errors import RouterNotStartedError, WireSettingsError
from studio.ros.wire.door import close, insert
from studio.ros.wire.endpoints import Endpoint, parse_endpoint
from studio.ros.wire.probing import Answer, probe
from studio.ros.wire.refused_tokens import TokenRelay
from studio.ros.wire.settings import LEASE_MS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_log = logging.getLogger(__name__)

_ACCEPT_TIMEOUT_MS = 5_000
"""A peer that begins a handshake and falls silent is let go after this."""
_LOOK_AGAIN_S = 0.25
_OF_SESSIONS = frozenset({"mode", "connect", "listen", "scouting", "open"})
"""Keys of an override that say how nodes find routers, which is no affair of a router here."""


@dataclass(frozen=True, slots=True)
class RouterChoice:
    """What `--router` says.

    Attributes:
        starts: Whether a router is started where none answers.
        endpoint: Where, None for the endpoint that is connected to.
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
        self, session: zenoh.Session, endpoint: Endpoint, relay: TokenRelay | None = None
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
) -> EmbeddedRouter:
    """Listen at an endpoint.

    Args:
        endpoint: Where.
        overrides: Keys of Zenoh's configuration and JSON5, such as its TLS keys; those by which
            sessions find routers are passed over.
        config_file: Of Zenoh, taken whole but for where it listens: that is `endpoint` alone.

    Raises:
        RouterNotStartedError: The endpoint is held by another program, or cannot be listened at.
        WireSettingsError: The file cannot be read.
    """
    config = _base(config_file)
    try:
        _complete(config, endpoint, overrides or {})
        session = zenoh.open(config)
    except zenoh.ZError as error:
        reason = str(error).split(" at /")[0]
        raise RouterNotStartedError(endpoint.text, reason, held=_is_held(endpoint)) from None
    return EmbeddedRouter(session, endpoint, _relay(session, endpoint, config))


def _relay(session: zenoh.Session, endpoint: Endpoint, config: zenoh.Config) -> TokenRelay | None:
    """Show the nodes that are older than the router; without, all others are seen as well."""
    try:
        return TokenRelay(session, endpoint, config)
    except zenoh.ZError as error:
        _log.warning(
            "Nodes that are older than the router at %s stay unseen: %s", endpoint.text, error
        )
        return None


def run_router(
    listen: str,
    ready: Callable[[str], None],
    overrides: Mapping[str, str] | None = None,
    config_file: str | None = None,
) -> None:
    """Run a router until Ctrl-C or SIGTERM; for the main thread of a process.

    Args:
        listen: The endpoint.
        ready: Given the endpoint once others may connect.
        overrides: See `start_router`.
        config_file: See `start_router`.

    Raises:
        WireSettingsError: `listen` is no endpoint, or the file cannot be read.
        RouterNotStartedError: See `start_router`.
    """
    asked_to_end = threading.Event()

    def end(_number: int, _frame: object) -> None:
        asked_to_end.set()

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, end)
    with start_router(parse_endpoint(listen), overrides, config_file) as router:
        ready(router.endpoint.text)
        # A signal that comes while a wait begins does not end that wait: look again.
        while not asked_to_end.wait(_LOOK_AGAIN_S):
            pass


def _is_held(endpoint: Endpoint) -> bool:
    return probe(endpoint) in {Answer.ZENOH, Answer.TLS, Answer.OTHER}


def _base(config_file: str | None) -> zenoh.Config:
    """Read the user's configuration of routers, or make that of rmw_zenohd."""
    if config_file is not None:
        try:
            return zenoh.Config.from_file(config_file)
        except (zenoh.ZError, OSError) as error:
            reason = str(error).split(" at /")[0]
            raise WireSettingsError(
                f"ZENOH_ROUTER_CONFIG_URI names {config_file}, which is refused: {reason}."
            ) from None
    config = zenoh.Config()
    # Zenoh would wait half a second for others that it finds by itself; nobody is to find it.
    insert(config, "scouting/delay", "0")
    insert(config, "scouting/multicast/enabled", "false")
    insert(config, "transport/unicast/accept_timeout", str(_ACCEPT_TIMEOUT_MS))
    # As rmw_zenohd: many nodes, who may be busy, and of whom those in mode peer meet without us.
    insert(config, "transport/unicast/max_sessions", "10000")
    insert(config, "transport/link/tx/lease", str(LEASE_MS))
    insert(config, "routing/router/peers_failover_brokering", "false")
    insert(config, "adminspace/enabled", "true")  # who is linked, for those who look for faults
    return config


def _complete(config: zenoh.Config, endpoint: Endpoint, overrides: Mapping[str, str]) -> None:
    insert(config, "mode", '"router"')
    insert(config, "listen/endpoints", json.dumps([endpoint.text]))
    for key, json5 in overrides.items():
        if key.partition("/")[0] not in _OF_SESSIONS:
            insert(config, key, json5)
