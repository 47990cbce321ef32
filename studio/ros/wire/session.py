"""WireSession: one Zenoh session in one ROS domain, which its nodes share."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING, Self

import zenoh

from studio.errors import NoRouterError, WireSettingsError
from studio.ros.types.library import TypeLibrary
from studio.ros.wire.door import close, insert
from studio.ros.wire.settings import LEASE_MS

if TYPE_CHECKING:
    from studio.ros.profiles import WireProfile
    from studio.ros.wire.router import EmbeddedRouter
    from studio.ros.wire.settings import WireSettings

SERVICE_TIMEOUT_MS = 600_000
"""How long rmw_zenoh lets a service take."""
_RETRY = {"period_init_ms": 250, "period_max_ms": 1_000, "period_increase_factor": 2}
"""A session finds a router that has come back within a second."""


class WireSession:
    """An open session; `close` it, else the process does not end by a signal.

    Attributes:
        zenoh: The session itself.
        zid: Its id, as tokens carry it.
        types: Of the distribution and of the user, shared by all nodes.
        router: The router of our own that this session was opened with, None when it joined
            one that was there.
    """

    def __init__(
        self,
        session: zenoh.Session,
        settings: WireSettings,
        types: TypeLibrary,
        router: EmbeddedRouter | None = None,
    ) -> None:
        self.zenoh = session
        self.settings = settings
        self.types = types
        self.router = router
        self.zid = str(session.info.zid())
        self._ids = itertools.count()

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
        """Whether a router is there at this moment; `RouterWatch` tells when that changes."""
        return bool(list(self.zenoh.info.routers_zid()))

    def next_id(self) -> int:
        """Number a node or endpoint: one counter for all of a session, from 0."""
        return next(self._ids)

    def close(self) -> None:
        """End the session, all that was declared on it, and our router; again is harmless."""
        close(self.zenoh)
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
        return WireSession(zenoh.open(config), settings, library, router)
    except zenoh.ZError as error:
        raise NoRouterError(settings.connect, str(error)) from None


def zenoh_config(settings: WireSettings) -> zenoh.Config:
    """Zenoh's configuration of a session: a client that does not look around by multicast.

    Raises:
        WireSettingsError: A file or value cannot be read.
    """
    try:
        config = _base(settings)
        for key, json5 in settings.overrides.items():
            insert(config, key, json5)
    except (zenoh.ZError, OSError) as error:
        reason = str(error).split(" at /")[0]
        raise WireSettingsError(f"Zenoh's configuration is refused: {reason}.") from None
    return config


def _base(settings: WireSettings) -> zenoh.Config:
    if settings.config_file is not None:
        config = zenoh.Config.from_file(settings.config_file)
    else:
        config = zenoh.Config()
        insert(config, "mode", '"client"')
        insert(config, "scouting/multicast/enabled", "false")
        insert(config, "timestamping/enabled", "true")
        insert(config, "queries_default_timeout", str(SERVICE_TIMEOUT_MS))
        insert(config, "transport/link/tx/lease", str(LEASE_MS))
        insert(config, "connect/retry", json.dumps(_RETRY))
    if settings.connect:
        insert(config, "connect/endpoints", json.dumps(settings.connect))
    return config
