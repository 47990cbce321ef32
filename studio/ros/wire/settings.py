"""WireSettings: which domain, router and distribution: options first, then the environment."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

import yaml

from studio.errors import WireSettingsError
from studio.ros.profiles import JAZZY, PROFILES, WireProfile

if TYPE_CHECKING:
    from collections.abc import Mapping

ROUTER_ENDPOINT = "tcp/127.0.0.1:7447"
"""Where rmw_zenoh's router listens, on this machine."""
DOMAIN_MAX = 232
"""The highest ROS_DOMAIN_ID that every middleware of ROS takes."""
LEASE_MS = 60_000
"""rmw_zenoh's limit for a silent peer: a busy machine, or a debugger, ends nobody."""
_CONNECT = "connect/endpoints"
_OVERRIDE = "ZENOH_CONFIG_OVERRIDE"


@dataclass(frozen=True, slots=True)
class WireSettings:
    """How to reach a ROS 2 system.

    Attributes:
        connect: Zenoh endpoints of routers, such as `tcp/127.0.0.1:7447`.
        domain: The ROS_DOMAIN_ID.
        profile: The distribution whose types and keys are used.
        config_file: Of Zenoh, taken whole; the other settings override it.
        overrides: Zenoh's keys, such as `transport/link/tls/root_ca_certificate`, and JSON5.
        router_config_file: Of Zenoh, for a router of our own; its address is set elsewhere.
    """

    connect: tuple[str, ...] = (ROUTER_ENDPOINT,)
    domain: int = 0
    profile: WireProfile = JAZZY
    config_file: str | None = None
    overrides: Mapping[str, str] = field(default_factory=dict[str, str])
    router_config_file: str | None = None


def wire_settings(
    connect: tuple[str, ...] = (),
    domain: int | None = None,
    profile: WireProfile | None = None,
    environment: Mapping[str, str] = os.environ,
) -> WireSettings:
    """Settings as rmw_zenoh finds them; what is given comes before the environment.

    ROS_DISTRO (where it is known, else Jazzy), ROS_DOMAIN_ID, ZENOH_SESSION_CONFIG_URI and
    ZENOH_ROUTER_CONFIG_URI (files), and ZENOH_CONFIG_OVERRIDE (`key=json5;...`; pairs without `=`
    are passed over) are read; routers named in the last are those to connect to.

    Raises:
        WireSettingsError: ROS_DOMAIN_ID is no number of a domain, or the endpoints are no list.
    """
    named = environment.get("ROS_DOMAIN_ID", "").strip()
    config_file = environment.get("ZENOH_SESSION_CONFIG_URI", "").strip() or None
    overrides = _pairs(environment.get(_OVERRIDE, ""))
    routers = _endpoints(overrides.pop(_CONNECT, "[]"))
    return WireSettings(
        connect=connect or routers or (() if config_file else (ROUTER_ENDPOINT,)),
        domain=_domain(named) if domain is None else domain,
        profile=profile or PROFILES.get(environment.get("ROS_DISTRO", "").lower(), JAZZY),
        config_file=config_file,
        overrides=overrides,
        router_config_file=environment.get("ZENOH_ROUTER_CONFIG_URI", "").strip() or None,
    )


def environment_for(
    settings: WireSettings, environment: Mapping[str, str] = os.environ
) -> dict[str, str]:
    """Return an environment in which nodes join the same routers and domain, as the same ROS."""
    routers = f"{_CONNECT}={json.dumps(settings.connect)}"
    override = environment.get(_OVERRIDE, "")
    return {
        **environment,
        "ROS_DOMAIN_ID": str(settings.domain),
        "ROS_DISTRO": settings.profile.distro,
        _OVERRIDE: f"{override};{routers}" if override else routers,
        "PYTHONUNBUFFERED": "1",  # what is printed is seen at once, also through a pipe
    }


def _domain(text: str) -> int:
    if not text:
        return 0
    if not (text.isascii() and text.isdigit() and int(text) <= DOMAIN_MAX):
        raise WireSettingsError(
            f"ROS_DOMAIN_ID is {text!r}: set it to a number from 0 to {DOMAIN_MAX}."
        )
    return int(text)


def _pairs(text: str) -> dict[str, str]:
    split = (pair.partition("=") for pair in text.split(";"))
    return {key.strip(): value.strip() for key, equals, value in split if equals and key.strip()}


def _endpoints(json5: str) -> tuple[str, ...]:
    """Read a list of texts; the commas and quotes that JSON5 allows are YAML's, too."""
    try:
        found: object = yaml.safe_load(json5)
    except yaml.YAMLError:
        found = None
    places = cast("list[object]", found) if isinstance(found, list) else []
    if not isinstance(found, list) or not all(isinstance(place, str) for place in places):
        raise WireSettingsError(
            f"ZENOH_CONFIG_OVERRIDE sets {_CONNECT} to {json5!r}: "
            'write a list such as ["tcp/192.0.2.7:7447"].'
        )
    return tuple(str(place) for place in places)
