"""The router that nodes meet at: whether it is there, is one, and lets the studio in."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Seen
    from studio.protocol.connection import Verdict, WireReport
    from studio.protocol.doctor import Level, SubjectName

SUBJECT: Final[SubjectName] = "router"
CONNECT: Final = Mend(label="Connect", command={"type": "connect_wire"})
CONNECTION: Final = Concern(kind="connection", name="")
_START: Final = "ros2 run rmw_zenoh_cpp rmw_zenohd"


def looked_at(seen: Seen) -> Looked | None:
    """The router, and its version where it tells it."""
    if seen.system is not None:
        versions = sorted(set(seen.answers.routers.values())) if seen.answers else []
        zenoh = f", Zenoh {', '.join(versions)}" if versions else ""
        return Looked(1, f"{seen.system.endpoint}{zenoh}")
    return Looked(1, seen.place.endpoint) if seen.place else None


def findings(seen: Seen) -> Iterator[Finding]:
    """Find why the router cannot be used."""
    if seen.place is not None and seen.system is None:
        yield from _of_place(seen.place)
    if seen.system is not None and not seen.system.is_connected:
        yield Finding(
            code="router-gone",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"The router at {seen.system.endpoint} went away: it is joined again once it runs."
            ),
            evidence=(f"{seen.system.endpoint} does not answer",),
            line=_START,
            about=(CONNECTION,),
        )
    routers = routers_alone(seen)
    if len(routers) > 1:
        yield Finding(
            code="several-routers",
            level="note",
            subject=SUBJECT,
            sentence=(
                f"{len(routers)} routers are connected with each other: nodes of all of them meet."
            ),
            evidence=tuple(f"{zid}: Zenoh {version}" for zid, version in list(routers.items())[:8]),
            about=(CONNECTION,),
        )


def routers_alone(seen: Seen) -> dict[str, str]:
    """Return Zenoh's version of routers by their ids, but not of bridges, which are some, too."""
    bridges = {one.zid for one in seen.system.bridges} if seen.system else set[str]()
    routers = seen.answers.routers.items() if seen.answers else ()
    return {zid: version for zid, version in routers if zid not in bridges}


def _of_place(place: WireReport) -> Iterator[Finding]:
    """What a look at the place said while the studio is not connected."""
    sentence, level = _SENTENCES.get(place.verdict, ("", "note"))
    if not sentence:
        return
    if place.verdict == "no_router" and place.starts_router:
        sentence, level = _STARTS, "warn"
    yield Finding(
        code=_CODES.get(place.verdict, "not-connected"),
        level=level,
        subject=SUBJECT,
        sentence=sentence.format(endpoint=place.endpoint),
        evidence=_evidence(place),
        mend=CONNECT if place.verdict not in {"foreign", "not_admitted"} else None,
        line=_START if place.verdict == "no_router" else "",
        about=(CONNECTION,),
    )


def _evidence(place: WireReport) -> tuple[str, ...]:
    domains = ", ".join(f"{one.nodes} in domain {one.domain}" for one in place.domains[:6])
    looked = f"{place.endpoint}: {_SAID.get(place.verdict, 'a router of Zenoh answers')}"
    return (looked, f"nodes there: {domains}") if domains else (looked,)


_SAID: Final[dict[Verdict, str]] = {
    "no_router": "nothing answers",
    "foreign": "something answers that is not Zenoh",
    "not_admitted": "a router refuses the studio",
    "bridge": "a bridge to DDS is there, and no node",
}
_CODES: Final[dict[Verdict, str]] = {
    "no_router": "no-router",
    "foreign": "no-zenoh",
    "not_admitted": "not-admitted",
    "bridge": "only-a-bridge",
}
_STARTS: Final = (
    "No router runs at {endpoint} yet: the studio starts one when it connects, or start rmw_zenohd."
)
_CONNECTABLE: Final = (
    "A router is at {endpoint}, and the studio is not connected with it: connect to see its nodes."
)
_SENTENCES: Final[dict[Verdict, tuple[str, Level]]] = {
    "no_router": (
        "No router answers at {endpoint}: start rmw_zenohd there, or choose another address.",
        "error",
    ),
    "foreign": (
        "What answers at {endpoint} is no router of Zenoh: another program holds the port. "
        "End it, or give the router another one.",
        "error",
    ),
    "not_admitted": (
        "The router at {endpoint} lets nobody in without its name and password or certificate: "
        "give them in ZENOH_CONFIG_OVERRIDE.",
        "error",
    ),
    "bridge": (
        "A bridge to DDS is at {endpoint}, and no node is seen behind it: start the robot's nodes "
        "in its ROS_DOMAIN_ID, and see that it can reach them: ROS_LOCALHOST_ONLY keeps a bridge "
        "and a robot to their own machines, and between machines DDS needs multicast.",
        "warn",
    ),
    "fine": (_CONNECTABLE, "warn"),
    "alone": (_CONNECTABLE, "warn"),
    "other_domain": (_CONNECTABLE, "warn"),
    "other_distro": (_CONNECTABLE, "warn"),
    "unseen": (_CONNECTABLE, "warn"),
}
