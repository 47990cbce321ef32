"""WireSession: a Zenoh session in one ROS domain; how to open one, and to watch its router."""

from __future__ import annotations

import itertools
import json
import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Self

from studio.errors import (
    NoRouterError,
    NotAdmittedError,
    WireError,
    WireSettingsError,
)
from studio.ros.condition import Condition
from studio.ros.types.library import TypeLibrary
from studio.ros.wire.bridges.bridges import Bridges
from studio.ros.wire.endpoints import ProbeResult
from studio.ros.wire.own_router import answer_at, place_for_router, router_of_our_own
from studio.ros.wire.own_tokens import OwnTokens
from studio.ros.wire.router import EmbeddedRouter, RouterChoice, router_choice
from studio.ros.wire.settings import LEASE_MS
from studio.ros.wire.zenoh import (
    Config,
    ReadingThread,
    Session,
    TransportEvent,
    ZError,
    close,
    insert,
    open_zenoh,
    read_config,
    router_change,
    use_few_threads,
    watch_transports,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.profiles import WireProfile
    from studio.ros.wire.settings import WireSettings

SERVICE_TIMEOUT_MS = 600_000
"""rmw_zenoh's limit for the duration of a call."""
_RETRY = {"period_init_ms": 250, "period_max_ms": 1_000, "period_increase_factor": 2}
"""A session finds a router that has come back within a second."""
_RACES_MAX = 5
"""So many times the winner of a race for the endpoint may be gone when we connect."""
_ROUTERS = frozenset({ProbeResult.ZENOH, ProbeResult.TLS})


class WireSession:
    """An open session; `close` it, else the process does not end by a signal.

    Attributes:
        zenoh: The session itself.
        zid: Its id, as tokens carry it.
        types: Of the distribution and of the user, shared by all nodes.
        router: The router of our own that this session was opened with, None when it joined
            one that was there.
        own_tokens: What this session shows of its own nodes.
    """

    def __init__(
        self,
        session: Session,
        settings: WireSettings,
        types: TypeLibrary,
        router: EmbeddedRouter | None = None,
    ) -> None:
        self.zenoh = session
        self.settings = settings
        self.types = types
        self.router = router
        self.zid = str(session.info.zid())
        self.own_tokens = OwnTokens(session)
        self._ids = itertools.count()
        self._lock = threading.Lock()
        self._bridges: Bridges | None = None

    @property
    def domain(self) -> int:
        """The ROS_DOMAIN_ID that begins every key."""
        return self.settings.domain

    @property
    def profile(self) -> WireProfile:
        """The distribution that is spoken."""
        return self.settings.profile

    @property
    def is_connected(self) -> bool:
        """Whether a router is there at this moment; `RouterWatch` reports when that changes."""
        return bool(list(self.zenoh.info.routers_zid()))

    @property
    def bridges(self) -> Bridges:
        """The bridges to DDS, followed from the first time that somebody asks for them."""
        with self._lock:
            if self._bridges is None:
                self._bridges = Bridges(self.zenoh, self.domain)
            return self._bridges

    def next_id(self) -> int:
        """Number a node or endpoint: one counter for all of a session, from 0."""
        return next(self._ids)

    def close(self) -> None:
        """End the session, all that was declared on it, and our router; again is harmless."""
        close(self.zenoh)
        with self._lock:
            bridges = self._bridges
        if bridges is not None:
            bridges.close()
        if self.router is not None:
            self.router.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_session(
    settings: WireSettings,
    types: TypeLibrary | None = None,
    router: EmbeddedRouter | None = None,
) -> WireSession:
    """Join as a client of a router; `open_wire` also starts one where it is missing.

    Args:
        settings: Where the router is, and what is spoken there.
        types: A library that is shared; one of the distribution is made without.
        router: Of our own, closed with the session.

    Raises:
        NoRouterError: None answers at the endpoints.
        WireSettingsError: Zenoh's configuration cannot be read or breaks its rules.
    """
    config = zenoh_config(settings)
    library = types or TypeLibrary(settings.profile.distro)
    try:
        return WireSession(open_zenoh(config), settings, library, router)
    except ZError as error:
        raise NoRouterError(settings.connect, str(error)) from None


def zenoh_config(settings: WireSettings) -> Config:
    """Return Zenoh's configuration of a session: a client without multicast scouting.

    Raises:
        WireSettingsError: A file or value cannot be read.
    """
    try:
        config = _base(settings)
        for key, json5 in settings.overrides.items():
            insert(config, key, json5)
    except (ZError, OSError) as error:
        reason = str(error).split(" at /")[0]
        raise WireSettingsError(f"Zenoh's configuration is refused: {reason}.") from None
    return config


def _base(settings: WireSettings) -> Config:
    config = read_config(settings.config_file)
    if settings.config_file is None:
        insert(config, "mode", '"client"')
        insert(config, "scouting/multicast/enabled", "false")
        insert(config, "timestamping/enabled", "true")
        insert(config, "queries_default_timeout", str(SERVICE_TIMEOUT_MS))
        insert(config, "transport/link/tx/lease", str(LEASE_MS))
        insert(config, "connect/retry", json.dumps(_RETRY))
    if settings.connect:
        insert(config, "connect/endpoints", json.dumps(settings.connect))
    return config


def open_wire(
    settings: WireSettings, router: str = "auto", types: TypeLibrary | None = None
) -> WireSession:
    """Open a session that every node of this process shares; close it.

    Args:
        settings: Where the router is, and what is spoken there.
        router: `auto` starts a router where none answers if only this machine can reach the
            endpoint; `off` starts none; an endpoint is joined, and started where none answers.
        types: A library that is shared; one of the distribution is made without.

    Raises:
        NoRouterError: None answers, and none may be started.
        NotAdmittedError: A router answers and wants another name, password or certificate.
        ForeignEndpointError: Something that is no Zenoh holds the endpoint.
        RouterNotStartedError: None answers, and the endpoint cannot be listened at.
        WireSettingsError: The settings cannot be.
    """
    use_few_threads()
    choice = router_choice(router)
    if choice.endpoint is not None:
        settings = replace(settings, connect=(choice.endpoint.text,))
    for _ in range(_RACES_MAX - 1):
        try:
            return _open_once(settings, choice, types)
        except NoRouterError:
            if place_for_router(settings, choice) is None:
                raise
    return _open_once(settings, choice, types)


def _open_once(
    settings: WireSettings, choice: RouterChoice, types: TypeLibrary | None
) -> WireSession:
    found = answer_at(settings)
    router = router_of_our_own(settings, choice) if found is ProbeResult.NOBODY else None
    try:
        return open_session(settings, types, router)
    except WireError as error:
        if router is not None:
            router.close()
        # A router that ended just now answered, too: it is there no more when asked again.
        refuses = isinstance(error, NoRouterError) and found in _ROUTERS
        if refuses and answer_at(settings) in _ROUTERS:
            raise NotAdmittedError(settings.connect[0]) from None
        raise


class RouterWatch:
    """Follows the links of one session; Zenoh itself mends them, within a second.

    What was declared stands again when a router is back, and so do the tokens of all others.
    """

    def __init__(
        self, wire: WireSession, listener: Callable[[bool], None] = lambda _is_there: None
    ) -> None:
        """Begin to watch.

        Args:
            wire: The session.
            listener: Called with whether a router is there each time that this changes, from a
                thread of this watch; it must be quick.
        """
        self._listener = listener
        self._changed = Condition()
        events = watch_transports(wire.zenoh)
        # Routers that are there come as events, too, but somebody may ask before that.
        self._routers = {str(zid) for zid in wire.zenoh.info.routers_zid()}
        self._thread = ReadingThread("ros-router-watch", events, self._take)

    @property
    def is_connected(self) -> bool:
        """Whether a router is there now."""
        return bool(self._routers)

    def wait_for(self, *, connected: bool, timeout_s: float | None = None) -> bool:
        """Wait until a router is there, or none; False when it is not so in time."""
        with self._changed:
            return self._changed.wait_for(lambda: self.is_connected is connected, timeout_s)

    def close(self) -> None:
        """Stop watching; again is harmless."""
        self._thread.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _take(self, events: list[TransportEvent]) -> None:
        for event in events:
            before = self.is_connected
            with self._changed:
                self._take_one(event)
                self._changed.notify_all()
            if before is not self.is_connected:
                self._listener(self.is_connected)

    def _take_one(self, event: TransportEvent) -> None:
        changed = router_change(event)
        if changed is None:
            return
        zid, is_linked = changed
        (self._routers.add if is_linked else self._routers.discard)(zid)
