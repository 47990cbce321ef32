"""Differences between the distributions of ROS 2 on the wire, one value for each."""

from __future__ import annotations

from dataclasses import dataclass

from studio.errors import RosNameError

NO_HASH = "TypeHashNotSupported"


@dataclass(frozen=True, slots=True)
class WireProfile:
    """A distribution: the store of message types that belongs to it, and whether keys hold hashes.

    `best_available` is whether the graph knows the QoS value of that name.
    """

    distro: str
    has_type_hash: bool
    best_available: bool

    def type_hash(self, computed: str) -> str:
        """Return what a hash of ours is in keys and tokens."""
        return computed if self.has_type_hash else NO_HASH


HUMBLE = WireProfile("humble", has_type_hash=False, best_available=False)
JAZZY = WireProfile("jazzy", has_type_hash=True, best_available=True)
KILTED = WireProfile("kilted", has_type_hash=True, best_available=True)
PROFILES = {profile.distro: profile for profile in (HUMBLE, JAZZY, KILTED)}


def profile_named(distro: str) -> WireProfile:
    """Find the profile of a distribution by its name.

    Raises:
        RosNameError: None of that name is known; those that are, are named.
    """
    found = PROFILES.get(distro.lower())
    if found is None:
        raise RosNameError(distro, f"the distributions known here are {', '.join(PROFILES)}")
    return found
