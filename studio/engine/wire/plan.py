"""What the command line and the environment of ROS say of the wire, before anything is opened."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.ros.profiles import JAZZY, PROFILES
from studio.ros.wire.settings import WireSettings, wire_settings

if TYPE_CHECKING:
    from studio.settings import WireChoice


def planned_wire(choice: WireChoice) -> WireSettings:
    """Where the router is looked for, in which domain, and what is spoken there.

    Raises:
        WireSettingsError: The environment says what cannot be.
    """
    profile = PROFILES.get(os.environ.get("ROS_DISTRO", "").lower(), JAZZY)
    settings = wire_settings(choice.connect, choice.domain, profile)
    if choice.router in {"auto", "off"}:
        return settings
    return replace(settings, connect=(choice.router,))
