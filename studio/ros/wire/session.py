"""WireSession: one Zenoh session in one ROS domain, which its nodes share."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING, Any, cast

import zenoh

from studio.errors import NoRouterError, WireSettingsError
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from studio.ros.profiles import WireProfile
    from studio.ros.wire.settings import WireSettings

SERVICE_TIMEOUT_MS = 600_000
"""How long rmw_zenoh lets a service take."""


class WireSession:
    """An open session; `close` it, else the process does not end by a signal.

    Attributes:
        zenoh: The session itself.
        zid: Its id, as tokens carry it.
        types: Of the distribution and of the user, shared by all nodes.
    """

    def __init__(self, session: zenoh.Session, settings: WireSettings, types: TypeLibrary) -> None:
        self.zenoh = session
        self.settings = settings
        self.types = types
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

    def next_id(self) -> int:
        """Number a node or endpoint: one counter for all of a session, from 0."""
        return next(self._ids)

    def close(self) -> None:
        """End the session and all that was declared on it; again is harmless."""
        if not self.zenoh.is_closed():
            cast("Any", self.zenoh).close()


def open_session(settings: WireSettings, types: TypeLibrary | None = None) -> WireSession:
    """Join as a client of a router.

    Raises:
        NoRouterError: None answers at the endpoints.
        WireSettingsError: Zenoh's configuration cannot be read or breaks its rules.
    """
    config = zenoh_config(settings)
    library = types or TypeLibrary(settings.profile.distro)
    try:
        return WireSession(zenoh.open(config), settings, library)
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
            _set(config, key, json5)
    except (zenoh.ZError, OSError) as error:
        reason = str(error).split(" at /")[0]
        raise WireSettingsError(f"Zenoh's configuration is refused: {reason}.") from None
    return config


def _base(settings: WireSettings) -> zenoh.Config:
    if settings.config_file is not None:
        config = zenoh.Config.from_file(settings.config_file)
    else:
        config = zenoh.Config()
        _set(config, "mode", '"client"')
        _set(config, "scouting/multicast/enabled", "false")
        _set(config, "timestamping/enabled", "true")
        _set(config, "queries_default_timeout", str(SERVICE_TIMEOUT_MS))
    if settings.connect:
        _set(config, "connect/endpoints", json.dumps(settings.connect))
    return config


def _set(config: zenoh.Config, key: str, json5: str) -> None:
    cast("Any", config).insert_json5(key, json5)  # which says nothing of what it returns
