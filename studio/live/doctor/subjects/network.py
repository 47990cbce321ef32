"""This machine's network: rmw_zenoh needs a way to its router, and no multicast."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import StudioError
from studio.live.doctor.seen import Looked, listed, short
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.doctor import Finding
from studio.ros.wire.bridges.dialect import PROGRAM
from studio.ros.wire.endpoints import parse_endpoint

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.live.doctor.seen import Interface, Seen
    from studio.protocol.doctor import SubjectName

SUBJECT: Final[SubjectName] = "network"
_ZENOH: Final = "rmw_zenoh_cpp"
_OF_DDS: Final = (
    "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "ROS_LOCALHOST_ONLY",
    "ROS_DISCOVERY_SERVER", "FASTRTPS_DEFAULT_PROFILES_FILE", "CYCLONEDDS_URI",
)  # fmt: skip
"""Variables that say to DDS how nodes find each other."""
NAMES: Final = ("RMW_IMPLEMENTATION", "ROS_DOMAIN_ID", "ROS_DISTRO", *_OF_DDS)
"""All variables that are looked at, here and in other subjects."""


def looked_at(seen: Seen) -> Looked:
    """The interfaces, each with what it can do."""
    interfaces = seen.here.interfaces
    return Looked(len(interfaces), "; ".join(map(_described, interfaces[:8])))


def findings(seen: Seen) -> Iterator[Finding]:
    """Find what keeps this machine from others, and settings that mean nothing here."""
    others = [one for one in seen.here.interfaces if not one.is_loopback]
    is_here_only = _is_here_only(seen)
    if seen.here.interfaces and not any(one.is_up for one in others):
        yield Finding(
            code="no-network",
            level="note" if is_here_only else "warn",
            subject=SUBJECT,
            sentence=(
                "No network interface of this machine is up: it meets only nodes that run on it."
            ),
            evidence=tuple(map(_described, seen.here.interfaces[:8])),
            about=(CONNECTION,),
        )
    elif others and not any(one.has_multicast for one in others if one.is_up):
        yield Finding(
            code="no-multicast",
            level="note",
            subject=SUBJECT,
            sentence=(
                "No network interface has multicast. rmw_zenoh needs none, for its nodes find each "
                "other by the router; nodes on DDS would not, nor would a bridge to DDS find them."
            ),
            evidence=tuple(map(_described, others[:8])),
            about=(CONNECTION,),
        )
    if is_here_only:
        yield Finding(
            code="router-of-this-machine",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"The router is reached at {_endpoint(seen)}, by which every machine means itself: "
                "nodes elsewhere connect to this machine's address in the network."
            ),
            evidence=(f"the router's address is {_endpoint(seen)}",),
            about=(CONNECTION,),
        )
    yield from _of_variables(seen)


def _of_variables(seen: Seen) -> Iterator[Finding]:
    variables = seen.here.variables
    rmw = variables.get("RMW_IMPLEMENTATION", "")
    is_bridged = seen.system is not None and any(one.is_used for one in seen.system.bridges)
    if rmw and rmw != _ZENOH:
        yield Finding(
            code="other-rmw",
            level="note" if is_bridged else "warn",
            subject=SUBJECT,
            sentence=(
                f"RMW_IMPLEMENTATION is {short(rmw)} where the studio was started: nodes that are "
                f"started there speak that, and {_ZENOH} nodes do not hear them. The studio meets "
                + (
                    "those on DDS through the bridge that is there."
                    if is_bridged
                    else f"those on DDS through {PROGRAM}, which is to be started beside them."
                )
            ),
            evidence=(f"RMW_IMPLEMENTATION={short(rmw)}",),
            line=f"export RMW_IMPLEMENTATION={_ZENOH}",
            about=(CONNECTION,),
        )
    idle = [name for name in _OF_DDS if variables.get(name)]
    if idle:
        yield Finding(
            code="settings-of-dds",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"{listed(idle)} {'is' if len(idle) == 1 else 'are'} set, which rmw_zenoh does not "
                "read: its nodes are found by the router alone. A bridge to DDS that is started "
                "here, and nodes on DDS, do read such settings"
                + (" and meet only nodes of this machine then." if _is_local(variables) else ".")
            ),
            evidence=tuple(f"{name} is set" for name in idle),
            about=(CONNECTION,),
        )


def _is_local(variables: Mapping[str, str]) -> bool:
    """Whether DDS is to stay on this machine."""
    ranged = variables.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    return variables.get("ROS_LOCALHOST_ONLY") == "1" or ranged in {"LOCALHOST", "OFF"}


def _is_here_only(seen: Seen) -> bool:
    try:
        return parse_endpoint(_endpoint(seen)).is_loopback
    except StudioError:
        return False


def _endpoint(seen: Seen) -> str:
    if seen.system is not None:
        return seen.system.endpoint
    return seen.place.endpoint if seen.place else ""


def _described(interface: Interface) -> str:
    if interface.is_up is None:
        return interface.name
    state = "up" if interface.is_up else "down"
    kind = "this machine only" if interface.is_loopback else (
        "multicast" if interface.has_multicast else "no multicast"
    )  # fmt: skip
    return f"{interface.name} {state}, {kind}"
