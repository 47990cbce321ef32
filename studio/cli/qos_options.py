"""Quality of service out of options, and the one that suits what others offer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import SettingsError
from studio.ros.duration import Duration
from studio.ros.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    as_profile,
    qos_profile_best_available,
    qos_profile_parameters,
    qos_profile_sensor_data,
    qos_profile_services_default,
    qos_profile_system_default,
)

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence
    from enum import IntEnum

_LEASE_MAX_S = 1e9
_PROFILES = {
    "unknown": QoSProfile(depth=10),
    "default": QoSProfile(depth=10),
    "system_default": qos_profile_system_default,
    "sensor_data": qos_profile_sensor_data,
    "services_default": qos_profile_services_default,
    "parameters": qos_profile_parameters,
    "best_available": qos_profile_best_available,
}
_POLICIES: dict[str, type[IntEnum]] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}


def add_qos_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of quality of service, named as ros2 names them."""
    parser.add_argument("--qos-profile", choices=sorted(_PROFILES), help="a profile by its name")
    parser.add_argument("--qos-depth", type=int, metavar="N", help="how many samples wait")
    parser.add_argument(
        "--qos-liveliness-lease-duration-seconds", type=float, metavar="SECONDS",
        help="how long a publisher may be silent",
    )  # fmt: skip
    for name, policies in _POLICIES.items():
        choices = [policy.name.lower() for policy in policies if policy.name != "UNKNOWN"]
        parser.add_argument(f"--qos-{name}", choices=choices, help=f"{name} alone")


def is_given(options: argparse.Namespace) -> bool:
    """Return whether an option sets a policy; the name of a profile does not count."""
    names = ("depth", "liveliness_lease_duration_seconds", *_POLICIES)
    return any(getattr(options, f"qos_{name}") is not None for name in names)


def given_profile(options: argparse.Namespace, base: QoSProfile) -> QoSProfile:
    """Return the profile of the options, based on a named one or else on `base`.

    Raises:
        SettingsError: The depth, or a time, is less than 0.
    """
    profile = _base(options, base)
    if options.qos_depth is not None:
        if options.qos_depth < 0:
            raise SettingsError(f"--qos-depth {options.qos_depth}: give 0 or more.")
        profile.depth = options.qos_depth
    lease_s = options.qos_liveliness_lease_duration_seconds
    if lease_s is not None:
        if not 0 <= lease_s < _LEASE_MAX_S:
            raise SettingsError(
                f"--qos-liveliness-lease-duration-seconds {lease_s}: give 0 or more."
            )
        profile.liveliness_lease_duration = Duration(seconds=lease_s)
    for name, policies in _POLICIES.items():
        choice = getattr(options, f"qos_{name}")
        if choice is not None:
            setattr(profile, name, policies[choice.upper()])
    return profile


def listening_profile(options: argparse.Namespace, offered: Sequence[QoSProfile]) -> QoSProfile:
    """Choose how to listen to those who offer a topic, as ros2 does.

    Policies that are given change the named profile, `sensor_data` where none is. Without any,
    the named profile becomes as reliable and lasting as all who offer allow.

    Raises:
        SettingsError: The depth, or a time, is less than 0.
    """
    if is_given(options):
        return given_profile(options, qos_profile_sensor_data)
    profile = _base(options, qos_profile_sensor_data)
    if offered:
        _match(profile, offered)
    return profile


def _base(options: argparse.Namespace, unnamed: QoSProfile) -> QoSProfile:
    named = options.qos_profile
    return as_profile(unnamed if named is None else _PROFILES[named])


def _match(profile: QoSProfile, offered: Sequence[QoSProfile]) -> None:
    """Make a profile as reliable and lasting as the least of those that are offered."""
    reliable = all(one.reliability is not ReliabilityPolicy.BEST_EFFORT for one in offered)
    lasting = all(one.durability is DurabilityPolicy.TRANSIENT_LOCAL for one in offered)
    profile.reliability = ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT
    profile.durability = DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE
