"""What a bridge tells of itself in Zenoh's admin space: its settings, nodes and DDS ends.

Answers are JSON of another machine: what is not as it should be is passed over.
Source: eclipse-zenoh/zenoh-plugin-ros2dds 1.10, `config.rs`, `node_info.rs`, `dds_discovery.rs`.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias, cast

from studio.errors import RosNameError
from studio.ros.duration import Duration
from studio.ros.names import check_full_name, check_namespace, check_node_name, split_type_name
from studio.ros.wire.bridges.dialect import RouteKind, dds_qos, type_hash_of
from studio.ros.wire.settings import DOMAIN_MAX
from studio.ros.wire.versions import version_number

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.ros.qos import QoSProfile
    from studio.ros.wire.bridges.dialect import Place

ANSWERS_MAX: Final = 50_000
"""Answers of one bridge that are read; a robot with a hundred nodes gives some five thousand."""
_ANSWERS_OF_ALL: Final = 320_000
ENDS_MAX: Final = 100_000
"""Of the nodes of one bridge."""
_ENDS_OF_ALL: Final = 400_000
_TEXT_MAX: Final = 2_000
_ANSWER_BYTES_MAX: Final = 1 << 20
_BYTES_MAX: Final = 64 << 20
_BYTES_OF_ALL: Final = 640 << 20
_HOST_MAX: Final = 60
_RATE: Final = re.compile(r"\d{1,9}(\.\d{1,9})?", re.ASCII)
_LATCHED: Final = frozenset({"TRANSIENT_LOCAL", "TRANSIENT", "PERSISTENT"})
_INFINITE_NS: Final = 2**63 - 1
_LISTS: Final = {
    "publishers": RouteKind.PUBLISHER,
    "subscribers": RouteKind.SUBSCRIPTION,
    "service_servers": RouteKind.SERVICE,
    "service_clients": RouteKind.CLIENT,
    "action_servers": RouteKind.ACTION_SERVER,
    "action_clients": RouteKind.ACTION_CLIENT,
}
_FACING: Final = {
    ("topic", "sub"): RouteKind.PUBLISHER,
    ("topic", "pub"): RouteKind.SUBSCRIPTION,
    ("service", "cli"): RouteKind.SERVICE,
    ("service", "srv"): RouteKind.CLIENT,
    ("action", "cli"): RouteKind.ACTION_SERVER,
    ("action", "srv"): RouteKind.ACTION_CLIENT,
}
"""What a session announces, by where a bridge tells of the route that it makes for it."""
_OF_ROUTES: Final = {kind: name for name, kind in _LISTS.items()}

BRIDGE_NODE: Final = "zenoh_bridge_ros2dds"
"""The name of a bridge's own node, where it was given no other."""
Json: TypeAlias = "dict[str, object]"


@dataclass(frozen=True, slots=True)
class Rules:
    """The allow or deny list of a bridge: regular expressions by kind of route.

    Attributes:
        allows: Whether what is listed is let through, or kept out.
        patterns: By kind of route; a kind that has none is not mentioned.
    """

    allows: bool
    patterns: Mapping[RouteKind, str]

    def texts(self) -> tuple[str, ...]:
        """Return a line for each kind, such as `publishers: /scan|/tf`."""
        return tuple(f"{_OF_ROUTES[kind]}: {text}" for kind, text in self.patterns.items())


@dataclass(frozen=True, slots=True)
class Settings:
    """How a bridge was started.

    Attributes:
        domain: Its ROS_DOMAIN_ID on DDS.
        namespace: In front of all its names; `/` without.
        node_name: Its own node's.
        localhost_only: Whether it meets only DDS nodes of its own machine.
        rules: What it lets through; None: everything.
        slowed: Topics, as regular expressions, each with the most messages a second it passes on.
    """

    domain: int
    namespace: str
    node_name: str
    localhost_only: bool
    rules: Rules | None = None
    slowed: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class DdsNode:
    """A ROS node that a bridge found on DDS.

    Attributes:
        participant: The GUID of its DDS participant, in hex: the same at every bridge.
        path: Without the bridge's namespace.
        ends: Kind, name and type of each, names without the bridge's namespace.
    """

    participant: str
    path: str
    ends: tuple[tuple[RouteKind, str, str], ...]


@dataclass(frozen=True, slots=True)
class DdsEnd:
    """A reader or writer on DDS: the QoS of a topic's, and the hash of a topic's or service's."""

    qos: QoSProfile
    type_hash: str


@dataclass(slots=True)
class Told:
    """Everything that one bridge told.

    Attributes:
        hosts: Names of machines by participant.
        dds_ends: By participant, kind and name.
    """

    version: str = ""
    settings: Settings | None = None
    nodes: list[DdsNode] = field(default_factory=list[DdsNode])
    hosts: dict[str, str] = field(default_factory=dict[str, str])
    dds_ends: dict[tuple[str, RouteKind, str], DdsEnd] = field(
        default_factory=dict[tuple[str, RouteKind, str], DdsEnd]
    )


def admin_key(zid: str, below: str = "**") -> str:
    """Return the key expression of what a bridge tells: of all, or of what lies below a word."""
    return f"@/{zid}/ros2/{below}"


class Bounds(NamedTuple):
    """How much is read of one bridge at once, of what all bridges together may tell.

    Attributes:
        bytes: Of keys and values.
        ends: Of nodes.
    """

    answers: int = ANSWERS_MAX
    bytes: int = _BYTES_MAX
    ends: int = ENDS_MAX

    @classmethod
    def of_each(cls, bridges: int) -> Bounds:
        """Return those of each of so many bridges."""
        count = max(1, bridges)
        return cls(
            min(ANSWERS_MAX, _ANSWERS_OF_ALL // count),
            min(_BYTES_MAX, _BYTES_OF_ALL // count),
            min(ENDS_MAX, _ENDS_OF_ALL // count),
        )


def read_answers(
    answers: Iterable[tuple[str, bytes]], zid: str, ends_max: int = ENDS_MAX
) -> Told | None:
    """Read the answers to `@/ZID/ros2/**`, keys and JSON.

    Args:
        answers: Those of others are passed over.
        zid: The bridge that was asked.
        ends_max: How many ends of nodes are read; those beyond are left out.

    Returns:
        What it told; None: it told nothing.
    """
    told, is_told = Told(), False
    nodes: dict[tuple[str, str], DdsNode] = {}
    for key, data in answers:
        parts = key.split("/")
        is_wanted = parts[1:2] == [zid] and len(parts) > 3 and parts[3] != "route"
        if not is_wanted or len(data) > _ANSWER_BYTES_MAX:
            continue
        try:
            value: object = json.loads(data)
        except (ValueError, RecursionError):
            continue
        is_told = True
        match parts[3:]:
            case ["node", participant, *path] if path and isinstance(value, dict):
                node = _node(participant, "/" + "/".join(path), cast("Json", value), ends_max)
                if node is not None:
                    nodes.setdefault((node.participant, node.path), node)
                    ends_max -= len(node.ends)
            case other:
                _read_one(told, other, value)
    told.nodes = list(nodes.values())
    return told if is_told else None


def read_routes(answers: Iterable[tuple[str, bytes]], zid: str) -> frozenset[Place]:
    """Read the answers to `@/BRIDGE/ros2/route/**`: what of a session it passes on now.

    Args:
        answers: Keys and JSON.
        zid: The session.

    Returns:
        Kind and full name of each end, as the session announced them.
    """
    found: set[Place] = set()
    for count, (key, data) in enumerate(answers):
        parts = key.split("/")[3:]
        if count >= ANSWERS_MAX:
            break
        if len(parts) < 4 or parts[0] != "route" or len(data) > _ANSWER_BYTES_MAX:
            continue
        kind = _FACING.get((parts[1], parts[2]))
        name = "/".join(parts[3:])
        try:
            value: object = json.loads(data)
        except (ValueError, RecursionError):
            continue
        if kind is None or not isinstance(value, dict):
            continue
        if _is_passing(kind, cast("Json", value), f"{zid}:{name}"):
            found.add((kind, f"/{name}"))
    return frozenset(found)


def _is_passing(kind: RouteKind, route: Json, remote: str) -> bool:
    """Whether a route serves a session; of subscriptions, which are not announced, any."""
    if kind is RouteKind.SUBSCRIPTION:
        return route.get("dds_reader") != ""
    served = route.get("remote_routes")
    is_served = isinstance(served, list) and remote in cast("list[object]", served)
    return is_served and route.get("is_active") is not False


def _read_one(told: Told, parts: list[str], value: object) -> None:
    match parts:
        case ["version"] if isinstance(value, str):
            told.version = version_number(value)
        case ["config"] if isinstance(value, dict):
            told.settings = _settings(cast("Json", value))
        case ["dds", participant] if isinstance(value, dict):
            properties = _of(_of(cast("Json", value), "qos"), "properties")
            if host := _text(properties.get("__Hostname")):
                told.hosts[participant] = host[:_HOST_MAX]
        case ["dds", participant, "reader" | "writer" as side, _, *topic] if topic:
            _read_end(told, participant, side, "/".join(topic), value)
        case _:
            pass


def _settings(value: Json) -> Settings | None:
    domain = value.get("domain")
    if not isinstance(domain, int) or isinstance(domain, bool) or not 0 <= domain <= DOMAIN_MAX:
        return None
    return Settings(
        domain=domain,
        namespace=_checked(check_namespace, value.get("namespace"), "/"),
        node_name=_checked(check_node_name, value.get("nodename"), BRIDGE_NODE),
        localhost_only=value.get("ros_localhost_only") is True
        or value.get("ros_automatic_discovery_range") == "LOCALHOST",
        rules=_rules(value),
        slowed=_slowed(value.get("pub_max_frequencies")),
    )


def _checked(check: Callable[[str], str], value: object, default: str) -> str:
    """Return a name that follows ROS's rules, else the default."""
    try:
        return check(_text(value))
    except RosNameError:
        return default


def _rules(value: Json) -> Rules | None:
    for word in ("allow", "deny"):
        found = value.get(word)
        if isinstance(found, dict):
            patterns = {
                kind: text
                for name, kind in _LISTS.items()
                if (text := _text(cast("Json", found).get(name)))
            }
            return Rules(word == "allow", patterns)
    return None


def _slowed(value: object) -> tuple[tuple[str, float], ...]:
    """Read lines such as `/scan=5`, where the last `=` divides."""
    lines = cast("list[object]", value) if isinstance(value, list) else []
    found: list[tuple[str, float]] = []
    for line in lines[:100]:
        topic, _, rate = _text(line).rpartition("=")
        if topic and _RATE.fullmatch(rate):
            found.append((topic, float(rate)))
    return tuple(found)


def _node(participant: str, path: str, value: Json, ends_max: int) -> DdsNode | None:
    try:
        check_full_name(path)
    except RosNameError:
        return None
    ends: dict[tuple[RouteKind, str, str], None] = {}
    for word, kind in _LISTS.items():
        found = value.get(word)
        for one in cast("list[object]", found) if isinstance(found, list) else []:
            if not isinstance(one, dict) or len(ends) >= ends_max:
                continue
            name = _text(cast("Json", one).get("name"))
            type_name = _text(cast("Json", one).get("type"))
            try:
                check_full_name(name)
                split_type_name(type_name)
            except RosNameError:
                continue
            ends[kind, name, type_name] = None
    return DdsNode(participant[:_TEXT_MAX], path, tuple(ends))


def _read_end(told: Told, participant: str, side: str, topic: str, value: object) -> None:
    """Keep a reader or writer: of a topic (`rt/`), or that of a service's requests (`rq/`)."""
    prefix, _, rest = topic.partition("/")
    is_writer = side == "writer"
    if prefix == "rt":
        kind = RouteKind.PUBLISHER if is_writer else RouteKind.SUBSCRIPTION
    elif prefix == "rq" and rest.endswith("Request"):
        kind = RouteKind.CLIENT if is_writer else RouteKind.SERVICE
        rest = rest.removesuffix("Request")
    else:
        return
    if isinstance(value, dict):
        qos = _of(cast("Json", value), "qos")
        end = DdsEnd(_profile(qos, is_writer=is_writer), type_hash_of(_bytes(qos.get("user_data"))))
        told.dds_ends[participant, kind, f"/{rest}"] = end


def _profile(qos: Json, *, is_writer: bool) -> QoSProfile:
    """Read a QoS; what is not there has the default of DDS."""
    reliability = _of(qos, "reliability").get("kind", "RELIABLE" if is_writer else "BEST_EFFORT")
    history = _of(qos, "history")
    depth = history.get("depth", 1)
    found = dds_qos(
        reliable=reliability == "RELIABLE",
        latched=_text(_of(qos, "durability").get("kind")) in _LATCHED,
        keep_all=history.get("kind") == "KEEP_ALL",
        depth=depth if isinstance(depth, int) else 1,
    )
    return replace(
        found,
        deadline=_duration(_of(qos, "deadline").get("period")),
        lifespan=_duration(_of(qos, "lifespan").get("duration")),
        liveliness_lease_duration=_duration(_of(qos, "liveliness").get("lease_duration")),
    )


def _duration(value: object) -> Duration:
    if not isinstance(value, int) or not 0 < value < _INFINITE_NS:
        return Duration()
    return Duration(nanoseconds=value)


def _of(value: Json, name: str) -> Json:
    found = value.get(name)
    return cast("Json", found) if isinstance(found, dict) else {}


def _text(value: object) -> str:
    """Return a text that can be shown and sent: what would steer a terminal is a mark in it."""
    if not isinstance(value, str) or len(value) > _TEXT_MAX:
        return ""
    return value if value.isprintable() else "".join(map(_shown, value))


def _shown(letter: str) -> str:
    return letter if letter.isprintable() else "\ufffd"


def _bytes(value: object) -> str:
    """Read user data, a list of the numbers of its bytes."""
    numbers = cast("list[object]", value) if isinstance(value, list) else []
    return "".join(chr(one) for one in numbers[:1_000] if isinstance(one, int) and 0 < one < 128)
