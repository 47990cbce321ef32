"""Real Zenoh on free ports of this machine: a router, sessions, and waiting for what they say."""

from __future__ import annotations

import secrets
import socket
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

from studio.ros.profiles import profile_named
from studio.ros.qos import QoSProfile
from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import start_router
from studio.ros.wire.session import open_session
from studio.ros.wire.settings import WireSettings
from studio.ros.wire.zenoh import declare_token

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.router import EmbeddedRouter
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Declaration

PATIENCE_S = 60.0
_POLL_S = 0.005
_PORTS = range(15_000, 32_000)
"""Below those that systems lend to whoever connects to somebody."""


class ConditionNotMetError(AssertionError):
    """Something awaited did not come in time."""


def wait_until(what: str, condition: Callable[[], bool], patience_s: float = PATIENCE_S) -> None:
    """Ask again and again until it holds."""
    end_s = time.monotonic() + patience_s
    while not condition():
        if time.monotonic() > end_s:
            raise ConditionNotMetError(what)
        time.sleep(_POLL_S)


def free_endpoint(protocol: str = "tcp") -> str:
    """An endpoint of this machine at which nobody listens; never the one of rmw_zenoh."""
    return f"{protocol}/127.0.0.1:{free_port()}"


def free_port() -> int:
    """A port of this machine that nobody holds, and that nobody is lent before a test binds it."""
    while True:
        port = secrets.choice(_PORTS)
        with socket.socket() as found:
            try:
                found.bind(("127.0.0.1", port))
            except OSError:
                continue
            return port


@contextmanager
def running_router() -> Generator[str]:
    """A router in this process, for as long as the block; gives its endpoint."""
    with router_at(free_endpoint()) as router:
        yield router.endpoint.text


def router_at(endpoint: str) -> EmbeddedRouter:
    """A router that is closed by hand or by `with`, to kill it and start it anew."""
    return start_router(parse_endpoint(endpoint))


def open_test_session(
    endpoint: str, domain: int = 0, distro: str = "jazzy", types: TypeLibrary | None = None
) -> WireSession:
    """A session of one's own at a router; close it, or use `with`."""
    settings = WireSettings(connect=(endpoint,), domain=domain, profile=profile_named(distro))
    return open_session(settings, types)


@contextmanager
def session_pair(
    domain: int = 0, distro: str = "jazzy"
) -> Generator[tuple[WireSession, WireSession]]:
    """Two sessions at a router of their own, as two processes would have."""
    with (
        running_router() as endpoint,
        open_test_session(endpoint, domain, distro) as one,
        open_test_session(endpoint, domain, distro, one.types) as other,
    ):
        yield one, other


def show_endpoints(wire: WireSession, count: int, name: str = "many") -> list[Declaration]:
    """One node with so many publishers, each on a topic of its own; keep what is given back."""
    node = NodeToken(wire.domain, wire.zid, wire.next_id(), "/", name)
    publishers = (
        EndpointToken(
            node,
            wire.next_id(),
            EndpointKind.PUBLISHER,
            f"/{name}/topic_{at}",
            "std_msgs/msg/String",
            wire.profile.type_hash(wire.types.hash_of("std_msgs/msg/String")),
            QoSProfile(depth=10),
        )
        for at in range(count)
    )
    return [declare_token(wire.zenoh, str(token)) for token in (node, *publishers)]
