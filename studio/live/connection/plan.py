"""The settings of a connection: what was chosen, and ROS's environment for the rest."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.errors import WireSettingsError
from studio.ros.profiles import JAZZY, PROFILES
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.settings import WireSettings, wire_settings

if TYPE_CHECKING:
    from studio.protocol.connection import WirePlace
    from studio.settings import WireChoice

_USUAL_PORT = 7447


def planned_wire(choice: WireChoice) -> WireSettings:
    """Return the router, the domain and the distribution to use.

    Raises:
        WireSettingsError: A variable of the environment has no valid value.
    """
    named = choice.distro or os.environ.get("ROS_DISTRO", "").lower()
    profile = PROFILES.get(named, JAZZY)
    settings = wire_settings(choice.connect, choice.domain, profile)
    if choice.router in {"auto", "off"}:
        return settings
    return replace(settings, connect=(choice.router,))


def chosen_wire(before: WireChoice, place: WirePlace) -> WireChoice:
    """Return `before` with what a person chose on the page in its place.

    Raises:
        WireSettingsError: The address is not valid.
    """
    chosen = before
    if place.address.strip():
        address = _endpoint(place.address.strip())
        # Even if a router was to be started before: now only this one is used.
        router = "off" if before.router == "off" else "auto"
        chosen = replace(chosen, connect=(address,), router=router)
    if place.domain is not None:
        chosen = replace(chosen, domain=place.domain)
    return replace(chosen, distro=place.distro or chosen.distro)


def _endpoint(text: str) -> str:
    """Return the endpoint that is meant by `robot.local`, `10.0.0.7:7447` or `tls/robot:7447`."""
    protocol, slash, rest = text.partition("/")
    if not slash:
        protocol, rest = "tcp", text
    has_port = rest.rpartition("]")[2].count(":") == 1
    if protocol in {"tcp", "udp", "tls", "quic"} and not has_port:
        host = f"[{rest}]" if ":" in rest and not rest.startswith("[") else rest
        rest = f"{host}:{_USUAL_PORT}"
    if any(one.isspace() for one in text):
        raise WireSettingsError(f'"{text}" is no address: write one such as robot.local:7447.')
    return parse_endpoint(f"{protocol}/{rest}").text
