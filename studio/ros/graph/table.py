"""GraphTable: the tokens that stand, by node and by name; it does no I/O."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import TYPE_CHECKING

from studio.errors import TokenError
from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.tokens import EndpointKind, NodeToken, gid_of, parse_token

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.ros.tokens import EndpointToken

TOKENS_MAX = 200_000
"""More than that is no robot but an attack; what comes on top is counted."""
_REMEMBERED_MAX = 10_000


class Taken(Enum):
    """What became of a token that came."""

    CHANGED = auto()
    KNOWN = auto()
    REFUSED = auto()
    """It is no token of ROS, or one too many."""
    UNCERTAIN = auto()
    """It went before it came: find out whether it stands, and call `settle`."""


_Key = tuple[str, int, str]
"""Session, number and path: foreign peers number all their nodes alike."""


@dataclass(slots=True)
class _Standing:
    """A node with its endpoints; `said` are tokens of its own, none while only theirs stand."""

    node: GraphNode
    said: set[str] = field(default_factory=set[str])
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
        self._standing: dict[_Key, _Standing] = {}
        self._named: dict[EndpointKind, dict[str, dict[str, GraphEndpoint]]] = {
            kind: {} for kind in EndpointKind
        }
        self._by_gid: dict[bytes, GraphEndpoint] = {}
        self._tokens: dict[str, _Key] = {}
        self._gone: OrderedDict[str, None] = OrderedDict()
        self._gone_first: OrderedDict[str, None] = OrderedDict()
        self._refused: OrderedDict[str, None] = OrderedDict()

    def __contains__(self, token: str) -> bool:
        return token in self._tokens

    def __len__(self) -> int:
        return len(self._tokens)

    def put(self, token: str, *, sure: bool = False) -> Taken:
        """Take a token that stands; again is harmless, and nothing that it says is trusted."""
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
        standing = self._standing[key]
        endpoint = standing.endpoints.pop(token, None)
        if endpoint is not None:
            self._forget(endpoint)
        else:
            standing.said.discard(token)
            if not standing.said:
                self._forget_all(standing)
        if not (standing.said or standing.endpoints):
            del self._standing[key]
        return Taken.CHANGED

    def was_seen(self, token: str) -> bool:
        """Whether a token came, whatever became of it, or went of late."""
        return any(
            token in known for known in (self._tokens, self._gone, self._gone_first, self._refused)
        )

    def settle(self, token: str, *, stands: bool) -> None:
        """Note whether an uncertain token stands."""
        if stands:
            self.put(token, sure=True)
        elif token in self._gone_first:
            del self._gone_first[token]
            _remember(self._gone, token)

    def nodes(self) -> list[GraphNode]:
        """Return every node, in the order of their paths, then sessions and numbers."""
        found = (standing.node for standing in self._standing.values())
        return sorted(found, key=lambda node: (node.path, node.zid, node.nid))

    def endpoints_of(self, node: GraphNode) -> list[GraphEndpoint]:
        """Return the endpoints of a node, in the order of their names."""
        standing = self._standing.get((node.zid, node.nid, node.path))
        return _by_name(standing.endpoints.values()) if standing else []

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
        standing = self._standing_of(token)
        standing.said.add(text)
        self._tokens[text] = _key(token)

    def _put_endpoint(self, text: str, token: EndpointToken) -> None:
        standing = self._standing_of(token.node)
        endpoint = GraphEndpoint.of(text, token, standing.node)
        standing.endpoints[text] = endpoint
        self._tokens[text] = _key(token.node)
        self._named[endpoint.kind].setdefault(endpoint.name, {})[text] = endpoint
        self._by_gid[gid_of(text)] = endpoint

    def _standing_of(self, token: NodeToken) -> _Standing:
        key = _key(token)
        if key not in self._standing:
            self._standing[key] = _Standing(GraphNode.of(token))
        return self._standing[key]

    def _forget_all(self, standing: _Standing) -> None:
        for token, endpoint in standing.endpoints.items():
            self._forget(endpoint)
            del self._tokens[token]
            _remember(self._gone, token)
        standing.endpoints.clear()

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
