"""Bridges: the bridges to DDS that a session meets, followed while the session is open."""

from __future__ import annotations

import logging
import threading
import time
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from studio.errors import TokenError
from studio.ros.condition import Condition
from studio.ros.tokens import EndpointKind, gid_of
from studio.ros.wire.bridges.admin import DdsNode, Rules, Settings, Told, read_answers
from studio.ros.wire.bridges.dialect import (
    BRIDGES,
    TOKENS,
    Route,
    RouteKind,
    parse_bridge_token,
    route_ends,
)
from studio.ros.wire.zenoh import (
    ReadingThread,
    Sample,
    ZError,
    admin_answers,
    live_tokens,
    token_change,
    watch_tokens,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.ros.qos import QoSProfile
    from studio.ros.wire.bridges.side import BridgeSide
    from studio.ros.wire.zenoh import Session

_NODE_NAME: Final = "zenoh_bridge_ros2dds"
BRIDGES_MAX: Final = 64
ROUTES_MAX: Final = 20_000
"""Of one bridge; of those beyond none is known."""
ANSWER_TIMEOUT_S: Final = 3.0
_SENDERS_MAX: Final = 100_000
_SETTLE_S: Final = 0.15
"""A robot that starts announces its ends one by one."""
_ASK_EVERY_S: Final = 5.0
"""Nodes that join or leave a topic which others have change no token."""
_REST: Final = 5
"""So many times what the last question took is waited before the next."""

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class BridgedEnd:
    """A publisher, subscription, service or client of a DDS node, as a bridge passes it on.

    Attributes:
        identity: By which it is known; no other end has the same.
        node: Full name of its node, with the bridge's namespace in front.
        participant: The DDS participant; empty: the bridge did not tell whose it is.
        type_hash: Empty where DDS does not tell it, as before Iron and for most services.
    """

    identity: str
    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile
    node: str
    participant: str


@dataclass(frozen=True, slots=True)
class Bridge:
    """A bridge as it is now.

    Attributes:
        zid: Its Zenoh session.
        name: How people tell it from others: its namespace, else the machine of its nodes.
        version: Such as `1.10.0`; empty: it does not tell it.
        settings: How it was started; None: it does not tell.
        hosts: Names of the machines of its DDS nodes, in order.
        nodes: Full names of its nodes, in order.
        ends: What it passes on, without what another bridge shows as well.
        withheld: What its nodes have and it does not pass on: kind and name of each.
        is_used: Whether its domain is that of the session.
        twin: The name of a bridge that shows some of the same nodes; empty: none does.
    """

    zid: str
    name: str
    version: str
    settings: Settings | None
    hosts: tuple[str, ...]
    nodes: tuple[tuple[str, str], ...]
    """Participant and full name."""
    ends: tuple[BridgedEnd, ...]
    withheld: tuple[tuple[RouteKind, str], ...]
    is_used: bool
    twin: str

    @property
    def rules(self) -> Rules | None:
        """Its allow or deny list."""
        return self.settings.rules if self.settings else None


@dataclass(slots=True)
class _Met:
    """What is known of a bridge before it is made a `Bridge`; `asked` when it was."""

    zid: str
    routes: dict[str, Route] = field(default_factory=dict[str, Route])
    told: Told = field(default_factory=Told)
    asked: bool = False


class Sender(NamedTuple):
    """The publisher of a sample: its GID, and the hash of its type as far as DDS told it."""

    gid: bytes
    type_hash: str


class Bridges:
    """Follows bridges: their tokens as they come, and what they tell when asked.

    While one of the session's domain is there, ends of the session have a side for it. Bridges of
    other domains are shown and not used, as nodes of other domains are.
    """

    def __init__(self, zenoh: Session, domain: int) -> None:
        self._zenoh, self._domain = zenoh, domain
        self._own_zid = str(zenoh.info.zid())
        self._changed = Condition()
        self._met: dict[str, _Met] = {}
        self._early: dict[str, dict[str, Route]] = {}
        """Routes by session, of those who have not shown to be a bridge, or are none."""
        self._current: tuple[Bridge, ...] = ()
        self._senders: dict[tuple[str, str], Sender | None] = {}
        self._routed: frozenset[str] = frozenset()
        self._listeners: tuple[Callable[[], None], ...] = ()
        self.malformed = 0
        """How many tokens were none."""
        self._turn = threading.RLock()
        """Held while sides are begun and ended."""
        self._sides: dict[str, dict[BridgeSide[Any], None]] = {}
        """By topic."""
        self.is_used = False
        """Whether a bridge of the session's domain is there."""
        self._due = threading.Event()
        self._closed = threading.Event()
        self._asking: threading.Thread | None = None
        self._reader = ReadingThread("ros-bridges", watch_tokens(zenoh, TOKENS), self._take)

    def close(self) -> None:
        """Stop following; again is harmless."""
        self._closed.set()
        self._due.set()
        self._reader.close()

    @property
    def current(self) -> tuple[Bridge, ...]:
        """Return the bridges that are there and were asked, those that came first in front."""
        return self._current

    def on_change(self, listener: Callable[[], None]) -> Callable[[], None]:
        """Call a listener, which must be quick, after each change; return what ends that."""
        with self._changed:
            self._listeners = (*self._listeners, listener)
        return lambda: self._forget(listener)

    def sender(self, zid: str, topic: str) -> Sender | None:
        """Return who sends a topic through a bridge; None: another bridge brings it as well.

        Where several nodes behind the bridge publish it, nobody knows which of them sent a sample.
        """
        try:
            return self._senders[zid, topic]
        except KeyError:
            found = Sender(gid_of(f"{zid}/{topic}"), "")
            if len(self._senders) < _SENDERS_MAX:
                self._senders[zid, topic] = found
            return found

    def settle(self, timeout_s: float = ANSWER_TIMEOUT_S) -> bool:
        """Wait until all bridges that are alive now were asked; False when that takes too long."""
        end_s = time.monotonic() + timeout_s
        alive = {token.split("/")[1] for token in live_tokens(self._zenoh, BRIDGES, timeout_s)}
        with self._changed:
            return self._changed.wait_for(
                lambda: alive <= {one.zid for one in self._current},
                max(0.0, end_s - time.monotonic()),
            )

    def join(self, side: BridgeSide[Any]) -> None:
        """Begin a side whenever a bridge is there, and end it when none is, until it leaves."""
        with self._turn:
            self._sides.setdefault(side.topic, {})[side] = None
            self._update(side)

    def leave(self, side: BridgeSide[Any]) -> None:
        """End a side; again is harmless."""
        with self._turn:
            same_topic = self._sides.get(side.topic, {})
            same_topic.pop(side, None)
            if not same_topic:
                self._sides.pop(side.topic, None)
            side.update(is_used=False, is_routed=False)

    def _update(self, side: BridgeSide[Any]) -> None:
        side.update(is_used=self.is_used, is_routed=side.topic in self._routed)

    def _forget(self, listener: Callable[[], None]) -> None:
        with self._changed:
            self._listeners = tuple(one for one in self._listeners if one != listener)

    def _take(self, samples: list[Sample]) -> None:
        with self._changed:
            before = {zid: len(met.routes) for zid, met in self._met.items()}
            gone = [one for sample in samples if (one := self._take_one(*token_change(sample)))]
            has_news = bool(self._met) or bool(before)
        if gone:
            self._make_current()
        if has_news:
            self._ask_soon()

    def _take_one(self, token: str, is_alive: bool) -> bool:  # noqa: FBT001
        """Take in a token; whether something is gone. With the lock."""
        try:
            found = parse_bridge_token(token)
        except TokenError as error:
            self.malformed += 1
            if self.malformed == 1:
                _log.warning("A bridge shows what is not understood. %s", error)
            return False
        if isinstance(found, Route):
            return self._take_route(token, found, is_alive=is_alive)
        if found == self._own_zid:
            return False
        if not is_alive:
            return self._met.pop(found, None) is not None
        if found not in self._met and len(self._met) < BRIDGES_MAX:
            self._met[found] = _Met(found, self._early.pop(found, {}))
        return False

    def _take_route(self, token: str, route: Route, *, is_alive: bool) -> bool:
        if route.zid == self._own_zid:
            return False
        met = self._met.get(route.zid)
        if met is not None:
            routes = met.routes
        elif is_alive:
            if route.zid not in self._early and len(self._early) >= BRIDGES_MAX:
                self._early.pop(next(iter(self._early)))
            routes = self._early.setdefault(route.zid, {})
        else:
            routes = self._early.get(route.zid, {})
        if not is_alive:
            return routes.pop(token, None) is not None and met is not None
        if len(routes) < ROUTES_MAX:
            routes[token] = route
        return False

    def _ask_soon(self) -> None:
        with self._changed:
            if self._asking is None and self._met and not self._closed.is_set():
                self._asking = threading.Thread(
                    target=self._ask_on, name="ros-bridges-ask", daemon=True
                )
                self._asking.start()
        self._due.set()

    def _ask_on(self) -> None:
        """Ask all bridges whenever something changed, and now and then, until the end."""
        while not self._closed.wait(_SETTLE_S):
            self._due.clear()
            began_s = time.monotonic()
            try:
                self._ask_all()
            except Exception:  # noqa: BLE001 - what a bridge tells must not end the asking
                if not self._zenoh.is_closed():
                    _log.exception("Bridges could not be asked")
            rest_s = _REST * (time.monotonic() - began_s)
            if self._closed.wait(min(rest_s, _ASK_EVERY_S)):
                return
            self._due.wait(_ASK_EVERY_S if self._met else None)

    def _ask_all(self) -> None:
        for zid in tuple(self._met):
            try:
                told = read_answers(
                    admin_answers(self._zenoh, f"@/{zid}/ros2/**", ANSWER_TIMEOUT_S)
                )
            except ZError:  # the session has ended
                return
            with self._changed:
                met = self._met.get(zid)
                if met is not None:
                    is_silent = told.settings is None and met.told.settings is not None
                    met.told = met.told if is_silent else told
                    met.asked = True
        self._make_current()

    def _make_current(self) -> None:
        """Make values of what is known, update sides, and call listeners."""
        with self._turn:
            with self._changed:
                asked = [one for one in self._met.values() if one.asked]
                current, doubles = _bridges_of(asked, self._domain)
                is_same = current == self._current
                self._current = current
                self._senders = _senders_of(current, doubles)
                self._changed.notify_all()
                listeners = self._listeners
            self._use(current)
        if not is_same:
            for listener in listeners:
                listener()

    def _use(self, current: tuple[Bridge, ...]) -> None:
        if self._closed.is_set():
            return
        used = [one for one in current if one.is_used]
        routed = frozenset(
            end.name for one in used for end in one.ends if end.kind is EndpointKind.PUBLISHER
        )
        is_switched = bool(used) is not self.is_used
        changed = self._sides.keys() if is_switched else routed ^ self._routed
        self.is_used, self._routed = bool(used), routed
        for topic in tuple(changed):
            for side in tuple(self._sides.get(topic, ())):
                self._update(side)


def _senders_of(
    bridges: tuple[Bridge, ...], doubles: Mapping[str, frozenset[str]]
) -> dict[tuple[str, str], Sender | None]:
    """Return publishers by bridge and topic; None where another bridge has it, too."""
    found: dict[tuple[str, str], Sender | None] = {
        (zid, topic): None for zid, topics in doubles.items() for topic in topics
    }
    for bridge in bridges:
        for end in bridge.ends:
            if end.kind is EndpointKind.PUBLISHER:
                place = (bridge.zid, end.name)
                same = found.get(place)
                is_first = place not in found
                name = end.identity if is_first else f"{bridge.zid}/{end.name}"
                told = end.type_hash if is_first or (same and same.type_hash) else ""
                found[place] = Sender(gid_of(name), told)
    return found


def _bridges_of(
    met: list[_Met], domain: int
) -> tuple[tuple[Bridge, ...], dict[str, frozenset[str]]]:
    """Return bridges, and by bridge the topics whose samples another one brings as well.

    Of several bridges in one DDS domain the first shows its nodes. They also see each other as a
    node with everything that they pass on, which is no node of a robot.
    """
    own_nodes = {_NODE_NAME} | {one.told.settings.node_name for one in met if one.told.settings}
    names = _names(met, own_nodes)
    shown: dict[tuple[str, str], str] = {}
    found: list[Bridge] = []
    doubles: dict[str, frozenset[str]] = {}
    for one in met:
        settings = one.told.settings
        prefix = _prefix(settings)
        is_used = settings is None or settings.domain == domain
        nodes = _robot_nodes(one, own_nodes)
        twins = [node for node in nodes if (node.participant, prefix) in shown]
        fresh = [node for node in nodes if (node.participant, prefix) not in shown]
        for node in fresh if is_used else ():
            shown[node.participant, prefix] = names[one.zid]
        ends, doubles[one.zid] = _ends(one, fresh, prefix)
        found.append(
            Bridge(
                zid=one.zid,
                name=names[one.zid],
                version=one.told.version,
                settings=settings,
                hosts=_hosts(one, nodes),
                nodes=tuple(sorted((node.participant, prefix + node.path) for node in fresh)),
                ends=ends,
                withheld=_withheld(one, nodes, prefix),
                is_used=is_used,
                twin=shown[twins[0].participant, prefix] if twins else "",
            )
        )
    return tuple(found), doubles


def _prefix(settings: Settings | None) -> str:
    return "" if settings is None else settings.namespace.rstrip("/")


def _robot_nodes(met: _Met, own_nodes: set[str]) -> list[DdsNode]:
    return [node for node in met.told.nodes if node.path.rpartition("/")[2] not in own_nodes]


def _hosts(met: _Met, nodes: Iterable[DdsNode]) -> tuple[str, ...]:
    return tuple(sorted({met.told.hosts.get(node.participant, "") for node in nodes} - {""}))


def _names(met: list[_Met], own_nodes: set[str]) -> dict[str, str]:
    """Name bridges, each otherwise than the others."""
    plain = {one.zid: _name(one, own_nodes) for one in met}
    often = Counter(plain.values())
    return {zid: name if often[name] == 1 else f"{name} ({zid[:6]})" for zid, name in plain.items()}


def _name(met: _Met, own_nodes: set[str]) -> str:
    if prefix := _prefix(met.told.settings):
        return prefix
    hosts = _hosts(met, _robot_nodes(met, own_nodes))
    return hosts[0] if len(hosts) == 1 else f"bridge {met.zid[:6]}"


def _ends(
    met: _Met, fresh: list[DdsNode], prefix: str
) -> tuple[tuple[BridgedEnd, ...], frozenset[str]]:
    """Return the ends of nodes that no other bridge shows, and topics that only others have."""
    of_route = _nodes_by_route(fresh)
    of_all = _nodes_by_route(met.told.nodes)
    settings = met.told.settings
    own = DdsNode("", f"/{settings.node_name if settings else _NODE_NAME}", ())
    ends: list[BridgedEnd] = []
    doubles: set[str] = set()
    for route in met.routes.values():
        local = route.name.removeprefix(prefix)
        nodes = of_route.get((route.kind, local), [])
        if not nodes and (route.kind, local) in of_all:
            if route.kind is RouteKind.PUBLISHER:
                doubles.add(route.name)
            continue
        for node in nodes or [own]:
            ends += _ends_of(met, route, node, prefix)
    return tuple(sorted(ends, key=lambda end: end.identity)), frozenset(doubles)


def _nodes_by_route(nodes: Iterable[DdsNode]) -> dict[tuple[RouteKind, str], list[DdsNode]]:
    found: dict[tuple[RouteKind, str], list[DdsNode]] = {}
    for node in nodes:
        for kind, name, _ in node.ends:
            found.setdefault((kind, name), []).append(node)
    return found


def _ends_of(met: _Met, route: Route, node: DdsNode, prefix: str) -> Iterable[BridgedEnd]:
    for end in route_ends(route):
        local = end.name.removeprefix(prefix)
        dds = met.told.dds_ends.get((node.participant, RouteKind(end.kind.value), local))
        is_topic = end.kind.value in {"MP", "MS"}
        yield BridgedEnd(
            identity=f"{met.zid}/{node.participant}{node.path}/{end.kind}{end.name}",
            kind=end.kind,
            name=end.name,
            type_name=end.type_name,
            type_hash=(dds.type_hash if dds else "") or end.type_hash,
            qos=dds.qos if dds and is_topic else end.qos,
            node=prefix + node.path,
            participant=node.participant,
        )


def _withheld(met: _Met, nodes: list[DdsNode], prefix: str) -> tuple[tuple[RouteKind, str], ...]:
    """Return what nodes have and no route is for."""
    routed = {(route.kind, route.name) for route in met.routes.values()}
    all_of = {(kind, prefix + name) for node in nodes for kind, name, _ in node.ends}
    return tuple(sorted(all_of - routed))
