"""Nodes and endpoints by their tokens, and GraphTable, which keeps those alive; no I/O."""

from __future__ import annotations

import zlib
from collections import OrderedDict
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import TYPE_CHECKING

from studio.errors import TokenError
from studio.ros.tokens import EndpointKind, NodeToken, gid_of, parse_token

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.qos import QoSProfile
    from studio.ros.tokens import EndpointToken
    from studio.ros.wire.bridges.bridge import Bridge, BridgedEnd

TOKENS_MAX = 200_000
"""Limit: more is an attack and no robot; tokens beyond it are counted."""
_REMEMBERED_MAX = 10_000
_Key = tuple[str, int, str]
"""Session, number and path: foreign peers number all their nodes alike."""


@dataclass(frozen=True, slots=True)
class GraphNode:
    """A node; two of one name are two values.

    Attributes:
        zid: Its Zenoh session, that is its process, or the bridge's.
        nid: Its number therein.
        bridge: The name of the bridge to DDS that it is behind; empty: it speaks rmw_zenoh.
    """

    zid: str
    nid: int
    namespace: str
    name: str
    enclave: str
    path: str
    bridge: str = ""

    @classmethod
    def of(cls, token: NodeToken) -> GraphNode:
        """Make one of its token."""
        return cls(token.zid, token.nid, token.namespace, token.name, token.enclave, token.path)

    @classmethod
    def behind(cls, bridge: Bridge, participant: str, path: str) -> GraphNode:
        """Make one of a node on DDS that a bridge shows."""
        namespace, _, name = path.rpartition("/")
        number = zlib.crc32(f"{participant}{path}".encode())
        return cls(bridge.zid, number, namespace or "/", name, "/", path, bridge.name)


@dataclass(frozen=True, slots=True)
class GraphEndpoint:
    """A publisher, subscription, service or client that is there.

    Attributes:
        token: Its whole token, by which it is known.
        name: Fully qualified.
        type_hash: As keys carry it: copy it from here rather than guess it. Empty where a node on
            DDS does not tell it.
        extra: Chunks after the QoS; `backends:...` marks a buffer-aware topic of Lyrical.
    """

    token: str
    node: GraphNode
    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile
    extra: tuple[str, ...] = ()

    @property
    def gid(self) -> bytes:
        """The 16 bytes by which its samples and requests name it."""
        return gid_of(self.token)

    @property
    def node_name(self) -> str:
        """The name of its node; this and the next five are of rclpy's TopicEndpointInfo."""
        return self.node.name

    @property
    def node_namespace(self) -> str:
        """The namespace of its node."""
        return self.node.namespace

    @property
    def topic_type(self) -> str:
        """Such as `std_msgs/msg/String`."""
        return self.type_name

    @property
    def topic_type_hash(self) -> str:
        """Such as `RIHS01_df66...`."""
        return self.type_hash

    @property
    def endpoint_gid(self) -> list[int]:
        """The GID, in rclpy's form."""
        return list(self.gid)

    @property
    def qos_profile(self) -> QoSProfile:
        """The QoS that it offers or requests."""
        return self.qos

    @classmethod
    def behind(cls, end: BridgedEnd, node: GraphNode) -> GraphEndpoint:
        """Make one of an end of a DDS node that a bridge passes on."""
        return cls(end.identity, node, end.kind, end.name, end.type_name, end.type_hash, end.qos)

    @classmethod
    def of(cls, text: str, token: EndpointToken, node: GraphNode) -> GraphEndpoint:
        """Make one of its token, read and as it stood."""
        return cls(
            token=text,
            node=node,
            kind=token.kind,
            name=token.name,
            type_name=token.type_name,
            type_hash=token.type_hash,
            qos=token.qos,
            extra=token.extra,
        )


class Taken(Enum):
    """What became of a token."""

    CHANGED = auto()
    KNOWN = auto()
    REFUSED = auto()
    """It is no token of ROS, or beyond the limit."""
    UNCERTAIN = auto()
    """Its end came before it: find out whether it is there, and call `settle`."""


@dataclass(slots=True)
class _NodeEntry:
    """A node with its endpoints; `own_tokens` are its own tokens, of which it may have none."""

    node: GraphNode
    own_tokens: set[str] = field(default_factory=set[str])
    endpoints: dict[str, GraphEndpoint] = field(default_factory=dict[str, GraphEndpoint])


class GraphTable:
    """Nodes are known by session and number, endpoints by their whole token.

    Attributes:
        malformed: How many tokens were none.
        left_out: How many were more than the table takes.
        last_malformed: What was wrong with the last of them.
    """

    def __init__(self) -> None:
        self.malformed = self.left_out = 0
        self.last_malformed: str | None = None
        self._entries: dict[_Key, _NodeEntry] = {}
        self._named: dict[EndpointKind, dict[str, dict[str, GraphEndpoint]]] = {
            kind: {} for kind in EndpointKind
        }
        self._by_gid: dict[bytes, GraphEndpoint] = {}
        self._tokens: dict[str, _Key] = {}
        self._gone: OrderedDict[str, None] = OrderedDict()
        self._gone_first: OrderedDict[str, None] = OrderedDict()
        self._refused: OrderedDict[str, None] = OrderedDict()
        self._bridged: dict[_Key, _NodeEntry] = {}

    def __contains__(self, token: str) -> bool:
        return token in self._tokens

    def __len__(self) -> int:
        return len(self._tokens)

    def put(self, token: str, *, sure: bool = False) -> Taken:
        """Add a token; again is harmless, and its content is not trusted."""
        if token in self._tokens or token in self._refused:
            return Taken.KNOWN
        if token in self._gone_first and not sure:
            return Taken.UNCERTAIN
        self._gone_first.pop(token, None)
        self._gone.pop(token, None)
        try:
            parsed = parse_token(token)
        except TokenError as error:
            self.malformed += 1
            self.last_malformed = str(error)
            _remember(self._refused, token)
            return Taken.REFUSED
        if len(self._tokens) >= TOKENS_MAX:
            self.left_out += 1
            _remember(self._refused, token)
            return Taken.REFUSED
        if isinstance(parsed, NodeToken):
            self._put_node(token, parsed)
        else:
            self._put_endpoint(token, parsed)
        return Taken.CHANGED

    def delete(self, token: str) -> Taken:
        """Forget a token; of a node, with its endpoints."""
        key = self._tokens.pop(token, None)
        if key is None:
            if token in self._refused:
                del self._refused[token]
                _remember(self._gone, token)
            elif token not in self._gone:
                _remember(self._gone_first, token)
            return Taken.KNOWN
        _remember(self._gone, token)
        entry = self._entries[key]
        endpoint = entry.endpoints.pop(token, None)
        if endpoint is not None:
            self._forget(endpoint)
        else:
            entry.own_tokens.discard(token)
            if not entry.own_tokens:
                self._forget_all(entry)
        if not (entry.own_tokens or entry.endpoints):
            del self._entries[key]
        return Taken.CHANGED

    def set_bridged(self, bridges: Iterable[Bridge]) -> None:
        """Replace all nodes on DDS by those that bridges show now.

        Of a node that several show the ends of all belong to that of the first.
        """
        for entry in self._bridged.values():
            for endpoint in entry.endpoints.values():
                self._forget(endpoint)
        self._bridged = {}
        homes: dict[tuple[str, str], Bridge] = {}
        for bridge in bridges:
            for place in bridge.nodes:
                self._bridged_entry(homes.setdefault(place, bridge), *place)
            for end in bridge.ends:
                place = (end.participant, end.node)
                entry = self._bridged_entry(homes.get(place, bridge), *place)
                endpoint = GraphEndpoint.behind(end, entry.node)
                entry.endpoints[endpoint.token] = endpoint
                self._remember_endpoint(endpoint)

    def _bridged_entry(self, bridge: Bridge, participant: str, path: str) -> _NodeEntry:
        node = GraphNode.behind(bridge, participant, path)
        return self._bridged.setdefault((node.zid, node.nid, node.path), _NodeEntry(node))

    def was_seen(self, token: str) -> bool:
        """Whether a token came, whatever became of it, or went recently."""
        return any(
            token in known for known in (self._tokens, self._gone, self._gone_first, self._refused)
        )

    def settle(self, token: str, *, is_alive: bool) -> None:
        """Note whether an uncertain token is alive."""
        if is_alive:
            self.put(token, sure=True)
        elif token in self._gone_first:
            del self._gone_first[token]
            _remember(self._gone, token)

    def nodes(self) -> list[GraphNode]:
        """Return every node, in the order of their paths, then sessions and numbers."""
        found = (entry.node for entry in (*self._entries.values(), *self._bridged.values()))
        return sorted(found, key=lambda node: (node.path, node.zid, node.nid))

    def endpoints_of(self, node: GraphNode) -> list[GraphEndpoint]:
        """Return the endpoints of a node, in the order of their names."""
        key = (node.zid, node.nid, node.path)
        entry = (self._bridged if node.bridge else self._entries).get(key)
        return _by_name(entry.endpoints.values()) if entry else []

    def named(self, kind: EndpointKind) -> Mapping[str, Mapping[str, GraphEndpoint]]:
        """Return all endpoints of a kind, by name and token."""
        return self._named[kind]

    def endpoints(self, kind: EndpointKind, name: str) -> list[GraphEndpoint]:
        """Return the endpoints of a kind with that name, in the order of their nodes."""
        return _by_name(self._named[kind].get(name, {}).values())

    def count(self, kind: EndpointKind, name: str) -> int:
        """Count the endpoints of a kind with that name."""
        return len(self._named[kind].get(name, ()))

    def endpoint_of_gid(self, gid: bytes) -> GraphEndpoint | None:
        """Return the endpoint that has a GID, None when none is known."""
        return self._by_gid.get(gid)

    def _put_node(self, text: str, token: NodeToken) -> None:
        entry = self._entry_of(token)
        entry.own_tokens.add(text)
        self._tokens[text] = _key(token)

    def _put_endpoint(self, text: str, token: EndpointToken) -> None:
        entry = self._entry_of(token.node)
        endpoint = GraphEndpoint.of(text, token, entry.node)
        entry.endpoints[text] = endpoint
        self._tokens[text] = _key(token.node)
        self._remember_endpoint(endpoint)

    def _remember_endpoint(self, endpoint: GraphEndpoint) -> None:
        self._named[endpoint.kind].setdefault(endpoint.name, {})[endpoint.token] = endpoint
        self._by_gid[gid_of(endpoint.token)] = endpoint

    def _entry_of(self, token: NodeToken) -> _NodeEntry:
        key = _key(token)
        if key not in self._entries:
            self._entries[key] = _NodeEntry(GraphNode.of(token))
        return self._entries[key]

    def _forget_all(self, entry: _NodeEntry) -> None:
        for token, endpoint in entry.endpoints.items():
            self._forget(endpoint)
            del self._tokens[token]
            _remember(self._gone, token)
        entry.endpoints.clear()

    def _forget(self, endpoint: GraphEndpoint) -> None:
        same_name = self._named[endpoint.kind][endpoint.name]
        del same_name[endpoint.token]
        if not same_name:
            del self._named[endpoint.kind][endpoint.name]
        self._by_gid.pop(gid_of(endpoint.token), None)


def _key(token: NodeToken) -> _Key:
    return (token.zid, token.nid, token.path)


def _remember(tokens: OrderedDict[str, None], token: str) -> None:
    tokens[token] = None
    if len(tokens) > _REMEMBERED_MAX:
        tokens.popitem(last=False)


def _by_name(found: Iterable[GraphEndpoint]) -> list[GraphEndpoint]:
    return sorted(found, key=lambda one: (one.name, one.node.path, one.token))
