"""Bridges to DDS: what keeps their nodes from the studio, is kept back, or comes twice."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import NAME_MAX, Looked, called, listed, short
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.displays import Mend
from studio.protocol.doctor import Concern, Finding, Talk
from studio.ros.qos import DurabilityPolicy
from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.admin import admin_key
from studio.ros.wire.bridges.dialect import PROGRAM, RouteKind, route_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.live.doctor.seen import Answers, Ends, Seen, System, Unrouted
    from studio.protocol.doctor import ConcernKind, SubjectName
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.wire.bridges.bridge import Bridge

SUBJECT: Final[SubjectName] = "bridges"
_CYCLONE: Final = "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp"
_LOCALHOST: Final = (
    "ROS_LOCALHOST_ONLY=1 (Humble) or ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST (Iron and later)"
)
"""What nodes need for a bridge with --ros-localhost-only, which finds no others of its machine."""
_DEBUG: Final = f"RUST_LOG=zenoh_plugin_ros2dds=debug {PROGRAM}"
_KEEPS_LATCHED: Final = (1, 5, 1)
"""From this version on a bridge keeps transient local messages as rmw_zenoh does."""
_SENT_BY: Final = {
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.SERVICE: EndpointKind.CLIENT,
}
"""What takes messages and requests in, and by what they are sent."""
_OF_ROS: Final = frozenset({"/rosout", "/parameter_events"})
"""Every node has these; that a list keeps them back is meant."""
_BRIDGES_MAX: Final = 8
_CONCERNS: Final[dict[RouteKind, ConcernKind]] = {
    RouteKind.PUBLISHER: "topic",
    RouteKind.SUBSCRIPTION: "topic",
    RouteKind.SERVICE: "service",
    RouteKind.CLIENT: "service",
    RouteKind.ACTION_SERVER: "action",
    RouteKind.ACTION_CLIENT: "action",
}
_MANY: Final = {
    RouteKind.PUBLISHER: "publishers",
    RouteKind.SUBSCRIPTION: "subscriptions",
    RouteKind.SERVICE: "services",
    RouteKind.CLIENT: "clients",
    RouteKind.ACTION_SERVER: "action servers",
    RouteKind.ACTION_CLIENT: "action clients",
}
_DOES: Final = {
    RouteKind.PUBLISHER: "the studio publishes and {other} subscribes to",
    RouteKind.SUBSCRIPTION: "{other} publishes and the studio subscribes to",
    RouteKind.SERVICE: "the studio serves and {other} calls",
    RouteKind.CLIENT: "{other} serves and the studio calls",
    RouteKind.ACTION_SERVER: "the studio serves and {other} sends goals to",
    RouteKind.ACTION_CLIENT: "{other} serves and the studio sends goals to",
}


def looked_at(seen: Seen) -> Looked | None:
    """The bridges, each with its version and nodes."""
    if seen.system is None:
        return None
    bridges = seen.system.bridges
    return Looked(len(bridges), "; ".join(map(_described, bridges[:_BRIDGES_MAX])))


def findings(seen: Seen) -> Iterator[Finding]:
    """Find what of DDS does not come, and what comes otherwise than it seems."""
    system, answers = seen.system, seen.answers
    if system is None:
        return
    for one in system.bridges:
        lost = answers.lost if answers else frozenset[str]()
        if one.zid in lost:
            yield _dead(one)
        elif one.settings is None:
            yield _silent(one)
        elif not one.is_used:
            yield _other_domain(one, one.settings.domain, system)
        else:
            yield from _of_used(one, system)
    yield from _shared_nodes([one for one in system.bridges if one.is_used])
    if answers is not None:
        yield from (_no_route(one, system) for one in answers.unrouted if _is_still(one, system))
        yield from _two_worlds(system, answers)


def _described(bridge: Bridge) -> str:
    version = bridge.version or "of an unknown version"
    domain = "" if bridge.settings is None else f", domain {bridge.settings.domain}"
    return f"{short(bridge.name)} {version}{domain}, {_nodes(len(bridge.nodes))}"


def _nodes(count: int) -> str:
    return "1 node" if count == 1 else f"{count} nodes"


def _dead(bridge: Bridge) -> Finding:
    return Finding(
        code="dead-bridge",
        level="error",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} answers nobody any more: it was killed or cut off, and its "
            "nodes are still listed for a while. Start it again."
        ),
        evidence=(f"session {bridge.zid[:8]} told its version before, and does no more",),
        about=(CONNECTION,),
    )


def _silent(bridge: Bridge) -> Finding:
    return Finding(
        code="bridge-silent",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} tells nothing of itself, so its nodes have no names here, and "
            "its domain is not known. Mostly a router on the way has access rules that keep its "
            "answers back."
        ),
        evidence=(f"no answer to {admin_key(bridge.zid)}",),
        about=(CONNECTION,),
    )


def _other_domain(bridge: Bridge, domain: int, system: System) -> Finding:
    reached = _reached(bridge, system)
    if reached:
        return _two_domains(bridge, domain, system, reached)
    is_alone = not system.others and bool(bridge.nodes)
    nodes = listed(path for _, path in bridge.nodes)
    command: dict[str, bool | int | float | str] = {"type": "connect_wire", "domain": domain}
    return Finding(
        code="bridge-domain",
        level="warn" if is_alone else "note",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} passes on domain {domain} of DDS, and the studio is in domain "
            f"{system.domain}, so its nodes are not shown: choose domain {domain}, or start it "
            f"with -d {system.domain}, if the robot is in that one (ROS_DOMAIN_ID)."
        ),
        evidence=(
            f"it was started for domain {domain}",
            f"its nodes: {nodes}" if nodes else "it found no node there",
        ),
        mend=Mend(label=f"Join domain {domain}", command=command),
        line=f"{PROGRAM} -d {system.domain}",
        about=(CONNECTION,),
    )


def _reached(bridge: Bridge, system: System) -> list[tuple[RouteKind, str]]:
    """Return by what its nodes are reached from the studio's domain, too: its keys name no domain.

    While no bridge is used, nothing is sent to any.
    """
    used = [one for one in system.bridges if one.is_used]
    if not used:
        return []
    sent = {(_SENT_BY.get(end.kind, end.kind), end.name) for one in used for end in one.ends}
    for kind, named in (
        (EndpointKind.PUBLISHER, {name: one.senders for name, one in system.topics.items()}),
        (EndpointKind.CLIENT, {name: one.receivers for name, one in system.services.items()}),
    ):
        sent |= {(kind, name) for name, ends in named.items() if any(map(system.is_own, ends))}
    taken = {
        route_of(end.kind, end.name)
        for end in bridge.ends
        if (_SENT_BY.get(end.kind), end.name) in sent and end.name not in _OF_ROS
    }
    return sorted(taken, key=lambda one: (one[0] is RouteKind.SERVICE, one))


def _two_domains(
    bridge: Bridge, domain: int, system: System, reached: list[tuple[RouteKind, str]]
) -> Finding:
    return Finding(
        code="bridge-domain",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} passes on domain {domain} of DDS, and the studio is in domain "
            f"{system.domain}, so its nodes are not shown. Yet what is sent here to "
            f"{listed(name for _, name in reached)} reaches them, too, because bridges do not "
            "tell their domain in what they pass on. Give each bridge a namespace of its own (-n)."
        ),
        evidence=(f"it was started for domain {domain}", *_by_kind(reached)),
        line=f"{PROGRAM} -d {domain} -n /NAME",
        about=(CONNECTION, *_concerns(reached)),
    )


def _of_used(bridge: Bridge, system: System) -> Iterator[Finding]:
    if not bridge.nodes and not bridge.ends and not bridge.twin:
        yield _empty(bridge)
    yield from _version(bridge, system)
    yield from _withheld(bridge, system)
    if bridge.settings is not None and bridge.settings.slowed:
        yield _slowed(bridge, bridge.settings.slowed)
    if bridge.fast_dds_nodes:
        yield _fast_dds(bridge)
    if bridge.twin:
        yield _twin(bridge)


def _empty(bridge: Bridge) -> Finding:
    settings = bridge.settings
    domain = settings.domain if settings else 0
    is_here_only = settings is not None and settings.localhost_only
    where = (
        "It meets only nodes of its own machine (ROS_LOCALHOST_ONLY or --ros-localhost-only): "
        f"run it on the robot, and the robot's nodes with {_LOCALHOST}, or start it without."
        if is_here_only
        else "On another machine than the robot it needs a network with multicast, and no "
        "ROS_LOCALHOST_ONLY on the robot."
    )
    return Finding(
        code="bridge-empty",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} is there, and finds no node on DDS in domain {domain}: start "
            f"the robot's nodes, with ROS_DOMAIN_ID={domain}. {where}"
        ),
        evidence=(
            f"it was started for domain {domain}",
            "it meets only nodes of its own machine" if is_here_only else "it meets other machines",
            "it tells of no node",
        ),
        line=f"ROS_DOMAIN_ID={domain} ros2 node list --no-daemon",
        about=(CONNECTION,),
    )


def _version(bridge: Bridge, system: System) -> Iterator[Finding]:
    version, here = _numbers(bridge.version), _numbers(system.zenoh)
    latched = [
        one.name
        for one in bridge.ends
        if one.kind is EndpointKind.PUBLISHER
        and one.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    ]
    such = f" ({listed(latched, 3)})" if latched else ""
    evidence = (
        f"the {called(bridge)} is {bridge.version or 'of an unknown version'}",
        f"Zenoh here is {system.zenoh}",
    )
    if version and version < _KEEPS_LATCHED:
        yield Finding(
            code="bridge-old",
            level="warn" if latched else "note",
            subject=SUBJECT,
            sentence=(
                f"The {called(bridge)} is {bridge.version}, which keeps transient local messages "
                f"in an old form: what was sent before the studio listened{such} may not come. "
                "Bring it up to date (1.5.1 or later)."
            ),
            evidence=evidence,
            line=f"{PROGRAM} --version",
            about=(CONNECTION, *(Concern(kind="topic", name=one) for one in latched[:3])),
        )
    elif not version or version[:2] < here[:2]:
        what = (
            f"is {bridge.version}, and Zenoh here {system.zenoh}: within 1.x they understand each "
            "other. Bring it up to date when something does not come."
            if version
            else "does not tell its version: any 1.x will do, and 1.5.1 or later is better."
        )
        yield Finding(
            code="bridge-version",
            level="note",
            subject=SUBJECT,
            sentence=f"The {called(bridge)} {what}",
            evidence=evidence,
            line=f"{PROGRAM} --version",
            about=(CONNECTION,),
        )


def _numbers(version: str) -> tuple[int, ...]:
    """Return the numbers of `1.10.0`; empty where it is none."""
    parts = version.split(".")
    return tuple(map(int, parts)) if all(one.isascii() and one.isdigit() for one in parts) else ()


def _withheld(bridge: Bridge, system: System) -> Iterator[Finding]:
    """What its nodes have and it has no route for: by its list, or though no list is against it."""
    kept = [(kind, name) for kind, name in bridge.withheld if name not in _OF_ROS]
    by_list = [one for one in kept if _has_rule(bridge, one[0])]
    others = [one for one in kept if not _has_rule(bridge, one[0])]
    if by_list and bridge.rules is not None:
        wanted = sorted({name for kind, name in by_list if _studio_wants(kind, name, system)})
        rule = "allow" if bridge.rules.allows else "deny"
        waits = f" The studio waits for {listed(wanted)}." if wanted else ""
        yield Finding(
            code="bridge-withholds",
            level="warn" if wanted else "note",
            subject=SUBJECT,
            sentence=(
                f"The {called(bridge)} keeps back what its {rule} list says: "
                f"{listed(name for _, name in by_list)}.{waits} Change that list in its "
                "configuration to have them."
            ),
            evidence=(
                *(f"{rule}: {short(one, 300)}" for one in bridge.rules.texts()),
                *_by_kind(by_list),
            ),
            about=(CONNECTION, *_concerns(by_list)),
        )
    if others:
        yield Finding(
            code="bridge-unrouted",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"The {called(bridge)} found {listed(name for _, name in others)} on DDS and "
                "passes it on to nobody, though no list is against it: its node may not have told "
                "DDS all of itself yet. If it stays so, start node and bridge again; its log says "
                "why."
            ),
            evidence=_by_kind(others),
            line=_DEBUG,
            about=(CONNECTION, *_concerns(others)),
        )


def _has_rule(bridge: Bridge, kind: RouteKind) -> bool:
    """Whether its list may keep back ends of a kind: one to allow is against all it does not name.

    Its expressions are not tried here: they are another machine's, in another program's form.
    """
    rules = bridge.rules
    return rules is not None and (rules.allows or kind in rules.patterns)


def _studio_wants(kind: RouteKind, name: str, system: System) -> bool:
    ends = (system.topics if _CONCERNS[kind] == "topic" else system.services).get(name)
    if ends is None:
        return False
    is_sender = kind in {RouteKind.PUBLISHER, RouteKind.SERVICE, RouteKind.ACTION_SERVER}
    return any(map(system.is_own, ends.receivers if is_sender else ends.senders))


def _by_kind(kept: Iterable[tuple[RouteKind, str]]) -> tuple[str, ...]:
    names: dict[RouteKind, list[str]] = defaultdict(list)
    for kind, name in kept:
        names[kind].append(name)
    return tuple(f"{_MANY[kind]}: {listed(some)}" for kind, some in names.items())


def _concerns(kept: Iterable[tuple[RouteKind, str]]) -> tuple[Concern, ...]:
    found = [Concern(kind=_CONCERNS[kind], name=name) for kind, name in kept]
    return tuple(one for one in found if len(one.name) <= NAME_MAX)[:3]


def _slowed(bridge: Bridge, slowed: tuple[tuple[str, float], ...]) -> Finding:
    told = "; ".join(f"{short(topic)}: {rate:g}" for topic, rate in slowed[:6])
    return Finding(
        code="bridge-slows",
        level="note",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge)} passes on some topics at most so many times a second ({told}): "
            "they come more slowly here than they are published."
        ),
        evidence=tuple(f"pub_max_frequencies: {short(topic)}={rate:g}" for topic, rate in slowed),
        about=(CONNECTION,),
    )


def _fast_dds(bridge: Bridge) -> Finding:
    nodes = bridge.fast_dds_nodes
    return Finding(
        code="fast-dds",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"{listed(nodes)} {'is' if len(nodes) == 1 else 'are'} on Fast DDS, of which the "
            f"{called(bridge)} brings topics, and no answer of services, actions and parameters. "
            f"Start {'it' if len(nodes) == 1 else 'them'} with {_CYCLONE}, if they matter."
        ),
        evidence=(
            f"nodes on Fast DDS: {len(nodes)} of {len(bridge.nodes)}",
            "the bridge writes the headers of requests as Cyclone DDS does",
        ),
        line=f"export {_CYCLONE}",
        about=tuple(Concern(kind="node", name=one) for one in nodes[:3]),
    )


def _twin(bridge: Bridge) -> Finding:
    settings = bridge.settings
    return Finding(
        code="two-bridges",
        level="error",
        subject=SUBJECT,
        sentence=(
            f"The {called(bridge.twin)} and another one ({bridge.zid[:6]}) pass on the same nodes "
            "on DDS, and each passes on what the other brings: one message or call can go round "
            "without end, and a service runs again and again. Stop one."
        ),
        evidence=(
            f"both are in domain {settings.domain}" if settings else "both show the same nodes",
            f"session {bridge.zid[:8]} of version {bridge.version or 'unknown'}",
        ),
        about=(CONNECTION,),
    )


def _shared_nodes(bridges: list[Bridge]) -> Iterator[Finding]:
    """Bridges with namespaces of their own that all found the same nodes."""
    by_participant: dict[str, dict[str, str]] = defaultdict(dict)
    for bridge in bridges:
        for participant, path in bridge.nodes:
            by_participant[participant].setdefault(bridge.name, path)
    together: dict[tuple[str, ...], tuple[str, ...]] = {}
    for names in by_participant.values():
        if len(names) > 1:
            together.setdefault(tuple(names), tuple(names.values()))
    for names, paths in together.items():
        yield Finding(
            code="shared-domain",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"The bridges {listed(names)} found the same nodes on DDS, so each robot is here "
                f"under several names ({listed(paths, 3)}), and what one bridge brings the other "
                "passes on again, without end. Start each bridge on its robot with "
                f"--ros-localhost-only, and the robot's nodes with {_LOCALHOST}."
            ),
            evidence=tuple(
                f"{short(name)} shows it as {short(path)}"
                for name, path in zip(names[:_BRIDGES_MAX], paths, strict=False)
            ),
            line=f"{PROGRAM} -n {_namespace(bridges, names)} --ros-localhost-only",
            about=(CONNECTION, *(Concern(kind="node", name=one) for one in paths[:3])),
        )


def _namespace(bridges: list[Bridge], names: tuple[str, ...]) -> str:
    """Return a namespace of bridges; their names may be those of machines, which hold anything."""
    found = (one.settings.namespace for one in bridges if one.name in names and one.settings)
    return next((one for one in found if one != "/"), "/ROBOT")


def _is_still(one: Unrouted, system: System) -> bool:
    """Whether both ends of what was asked for are there yet."""
    named = system.topics if _CONCERNS[one.kind] == "topic" else system.services
    ends = named.get(one.own.name)
    there = {end.token for end in (*ends.senders, *ends.receivers)} if ends else set[str]()
    return {one.own.token, one.other.token} <= there


def _no_route(one: Unrouted, system: System) -> Finding:
    other, name = short(one.other.node.path), short(one.name)
    does = _DOES[one.kind].format(other=other)
    studio = short(one.own.node.path)
    from_here = one.kind in {RouteKind.PUBLISHER, RouteKind.SERVICE, RouteKind.ACTION_SERVER}
    return Finding(
        code="no-route",
        level="error",
        subject=SUBJECT,
        sentence=(
            f"The {called(one.other.node.bridge)} has no route for {name}, which {does}: nothing "
            "comes through. Start the bridge again; its log says why it made none."
        ),
        evidence=(
            f"{studio} announces {name} as {short(one.own.type_name)}",
            f"no route of session {one.other.node.zid[:8]} serves session {one.own.node.zid[:8]}",
            f"{len(system.bridges)} bridges are there",
        ),
        line=_DEBUG,
        about=(Concern(kind=_CONCERNS[one.kind], name=one.name), CONNECTION),
        talk=Talk(
            sources=(studio if from_here else other,),
            name=name,
            targets=(other if from_here else studio,),
            meets=False,
        ),
    )


def _two_worlds(system: System, answers: Answers) -> Iterator[Finding]:
    """Nodes on DDS and nodes of rmw_zenoh that share a name: bridges have other keys than these."""
    apart: dict[str, tuple[GraphEndpoint, GraphEndpoint]] = {}
    kinds: dict[str, ConcernKind] = {}
    named: tuple[tuple[ConcernKind, Mapping[str, Ends]], ...] = (
        ("topic", system.topics),
        ("service", system.services),
    )
    for kind, ends_by_name in named:
        for name, ends in ends_by_name.items():
            pair = None if name in _OF_ROS else _apart(ends, system, answers)
            if pair is not None:
                apart[name], kinds[name] = pair, kind
    if not apart:
        return
    first = next(iter(apart))
    yield Finding(
        code="two-worlds",
        level="warn",
        subject=SUBJECT,
        sentence=(
            f"Nodes on DDS and nodes of rmw_zenoh both have {listed(apart)}, and do not meet: the "
            "bridge uses other keys than rmw_zenoh. The studio hears both. Start the others with "
            "the RMW_IMPLEMENTATION of the robot, or the robot's with rmw_zenoh_cpp."
        ),
        evidence=tuple(
            f"{short(name)}: {short(one.node.path)} to {short(other.node.path)}, "
            f"{short((one if one.node.bridge else other).node.path)} is on DDS"
            for name, (one, other) in list(apart.items())[:8]
        ),
        about=tuple(Concern(kind=kinds[one], name=one) for one in list(apart)[:3]),
        talk=Talk(
            sources=(short(apart[first][0].node.path),),
            name=short(first),
            targets=(short(apart[first][1].node.path),),
            meets=False,
        ),
    )


def _apart(
    ends: Ends, system: System, answers: Answers
) -> tuple[GraphEndpoint, GraphEndpoint] | None:
    """Return sender and receiver of which one is on DDS, and the other does not announce itself."""

    def is_zenoh_only(end: GraphEndpoint) -> bool:
        is_met = system.is_own(end) or end.node.zid in answers.announcing
        return not end.node.bridge and not is_met

    for near, far in ((ends.senders, ends.receivers), (ends.receivers, ends.senders)):
        on_dds = next((one for one in near if one.node.bridge), None)
        other = next(filter(is_zenoh_only, far), None)
        if on_dds is not None and other is not None:
            return (on_dds, other) if near is ends.senders else (other, on_dds)
    return None
