"""Why nobody is seen or heard, in sentences that say what to do: for the doctor and the dialog."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.errors import InterfaceError
from studio.ros.profiles import PROFILES
from studio.ros.types.library import TypeLibrary
from studio.ros.wire.endpoints import ProbeResult

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.profiles import WireProfile

_NAMED_MAX = 3


@dataclass(frozen=True, slots=True)
class ForeignHashes:
    """Types that others have in another form than the distribution that is spoken.

    Attributes:
        types: Their names, in order.
        distros: Of which each of these forms is, as far as is known; empty when of none.
    """

    types: tuple[str, ...]
    distros: tuple[str, ...]


def why_no_router(endpoint: str, answer: ProbeResult) -> str | None:
    """Say why there is no router at an endpoint; None when one is there, or may be."""
    if answer is ProbeResult.NOBODY:
        return (
            f"Nobody answers at {endpoint}: start a router there (studio router, or ros2 run "
            "rmw_zenoh_cpp rmw_zenohd), or name another with --connect."
        )
    if answer is ProbeResult.OTHER:
        return (
            f"Something that is no Zenoh router holds {endpoint}: end it, or name another place "
            "with --connect."
        )
    return None


def why_nobody(endpoint: str, domain: int, nodes_by_domain: Mapping[int, int]) -> str | None:
    """Say why no node is seen at a router that is there; None when some are in the domain."""
    if nodes_by_domain.get(domain):
        return None
    others = {other: count for other, count in nodes_by_domain.items() if count}
    if not others:
        return (
            f"The router at {endpoint} is there, but no node is: start one, with "
            "RMW_IMPLEMENTATION=rmw_zenoh_cpp if it is one of ROS 2."
        )
    places = ", ".join(f"{_nodes(count)} in domain {other}" for other, count in others.items())
    return f"No node is in domain {domain}, but {places}: choose --domain {min(others)}."


def foreign_hashes(
    endpoints: Iterable[GraphEndpoint],
    profile: WireProfile,
    hash_of: Callable[[str, str], str | None],
    distros: Iterable[str] = tuple(PROFILES),
) -> list[ForeignHashes]:
    """Find the types that others have in another form, by the distributions that have that form.

    Args:
        endpoints: Of others.
        profile: The distribution that is spoken.
        hash_of: Gives the hash that stands in keys for a distribution and the name of a type;
            None where that knows no such type, as a `DistroHashes` does.
        distros: The names of distributions that may be meant.
    """
    known = list(distros)
    by_distros: dict[tuple[str, ...], set[str]] = {}
    for type_name, type_hash in sorted({(one.type_name, one.type_hash) for one in endpoints}):
        ours = hash_of(profile.distro, type_name)
        if ours in {None, type_hash}:
            continue
        same = tuple(one for one in known if hash_of(one, type_name) == type_hash)
        by_distros.setdefault(same, set()).add(type_name)
    return [
        ForeignHashes(tuple(sorted(types)), distros_of)
        for distros_of, types in sorted(by_distros.items())
    ]


class DistroHashes:
    """The hashes of types as every known distribution has them, each read when it is asked for."""

    def __init__(self, own: TypeLibrary) -> None:
        self._libraries = {own.distro: own}

    def __call__(self, distro: str, type_name: str) -> str | None:
        """Give what stands in keys; None for a type that the distribution does not know."""
        if distro not in self._libraries:
            self._libraries[distro] = TypeLibrary(distro)
        try:
            computed = self._libraries[distro].hash_of(type_name)
        except InterfaceError:
            return None
        return PROFILES[distro].type_hash(computed)


def why_not_heard(found: ForeignHashes, profile: WireProfile) -> str:
    """Say what keeps those apart who have other forms of the same types."""
    named = ", ".join(found.types[:_NAMED_MAX])
    more = len(found.types) - _NAMED_MAX
    types = named + (f" and {more} more" if more > 0 else "")
    if found.distros:
        which = " or ".join(found.distros)
        return (
            f"Others have {types} as of {which}, where {profile.distro} is spoken, and neither "
            f"hears the other: choose --distro {found.distros[0]}."
        )
    return (
        f"Others have another form of {types} than {profile.distro}, and neither hears the "
        "other: give their packages with --interfaces."
    )


def _nodes(count: int) -> str:
    return "1 node is" if count == 1 else f"{count} nodes are"
