"""Liveliness tokens, data keys and GIDs, written and read as rmw_zenoh does."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import xxhash

from studio.errors import RosNameError, TokenError
from studio.ros.names import (
    check_full_name,
    check_namespace,
    check_node_name,
    node_path,
    split_type_name,
)
from studio.ros.qos import QoSProfile, parse_qos, qos_text

DOMAIN_MAX = 2**32 - 1
_DDS = "dds_::"
ADMIN_SPACE = "@ros2_lv"
BACKENDS = "backends:"
_NODE_KIND = "NN"
_NODE_CHUNKS = 9
_ENDPOINT_CHUNKS = 13
_ID_MAX = 2**64 - 1


@dataclass(frozen=True, slots=True)
class DataKey:
    """A data key; `name` is fully qualified, a service's `type_name` that of the whole.

    The hash is part of the key, so that a wrong one matches nothing: take it from the graph.
    """

    domain: int
    name: str
    type_name: str
    type_hash: str

    def __str__(self) -> str:
        body = self.name.removeprefix("/")
        return f"{self.domain}/{body}/{dds_type(self.type_name)}/{self.type_hash}"


def whatever_type_key(domain: int, name: str) -> str:
    """Return the key expression of a name with any type and hash."""
    return f"{domain}/{name.removeprefix('/')}/*/*"


def parse_key(key: str) -> DataKey:
    """Read a data key.

    Raises:
        RosNameError: It is no data key of rmw_zenoh.
    """
    domain, _, rest = key.partition("/")
    chunks = rest.rsplit("/", 2)
    if len(chunks) != 3 or "/@" in rest:
        raise RosNameError(key, "a data key is domain/name/type/hash")
    body, type_name, type_hash = chunks
    return DataKey(
        parse_domain(domain, key), check_full_name("/" + body), ros_type(type_name), type_hash
    )


def parse_domain(text: str, key: str) -> int:
    """Read a ROS_DOMAIN_ID as keys carry it.

    Raises:
        RosNameError: It is no such number; `key` is named.
    """
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and int(text) <= DOMAIN_MAX):
        raise RosNameError(key, "a key begins with the number of its domain")
    return int(text)


def dds_type(type_name: str) -> str:
    """Turn `std_msgs/msg/String` into `std_msgs::msg::dds_::String_`."""
    package, kind, base = type_name.split("/")
    return f"{package}::{kind}::{_DDS}{base}_"


def ros_type(dds_name: str) -> str:
    """Turn `std_msgs::msg::dds_::String_` into `std_msgs/msg/String`.

    Raises:
        RosNameError: It is no type's name as DDS writes it.
    """
    if _DDS not in dds_name or not dds_name.endswith("_"):
        raise RosNameError(dds_name, "a type on the wire is written package::msg::dds_::Type_")
    name = dds_name.replace(_DDS, "", 1).removesuffix("_").replace("::", "/")
    split_type_name(name)
    return name


class EndpointKind(StrEnum):
    """Kind of an endpoint, by its letters in a token."""

    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"


@dataclass(frozen=True, slots=True)
class NodeToken:
    """A node: `zid` is its Zenoh session, `nid` its number therein; names may repeat."""

    domain: int
    zid: str
    nid: int
    namespace: str
    name: str
    enclave: str = "/"

    @property
    def path(self) -> str:
        """Namespace and name, `/ns/talker`."""
        return node_path(self.namespace, self.name)

    def __str__(self) -> str:
        return _head(self, self.nid, _NODE_KIND)


@dataclass(frozen=True, slots=True)
class EndpointToken:
    """A publisher, subscription, service or client of a node.

    `name` is fully qualified, the type of a service is that of the whole, `extra` are chunks
    after the QoS, such as the backends of buffer-aware topics.
    """

    node: NodeToken
    eid: int
    kind: EndpointKind
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile
    extra: tuple[str, ...] = ()

    @property
    def backends(self) -> str | None:
        """The chunk that makes a topic of Lyrical buffer-aware, None without."""
        return next((chunk for chunk in self.extra if chunk.startswith(BACKENDS)), None)

    def __str__(self) -> str:
        what = (self.name, dds_type(self.type_name), self.type_hash, qos_text(self.qos))
        return "/".join([_head(self.node, self.eid, self.kind), *map(_mangled, what), *self.extra])


def tokens_of_domain(domain: int) -> str:
    """Return the key expression of every token of a domain."""
    return f"{ADMIN_SPACE}/{domain}/**"


def nodes_of_domain(domain: str) -> str:
    """Return the key expression of all tokens of nodes, without endpoints; `*`: of every domain."""
    return f"{ADMIN_SPACE}/{domain}/*/*/*/{_NODE_KIND}/**"


def parse_token(token: str) -> NodeToken | EndpointToken:
    """Read a token.

    Raises:
        TokenError: It is none of rmw_zenoh's.
    """
    chunks = token.split("/")
    if chunks[0] != ADMIN_SPACE or len(chunks) < _NODE_CHUNKS:
        raise TokenError(token, "it has too few parts")
    if not all(chunks):
        raise TokenError(token, "a part of it is empty")
    try:
        return _parse_chunks(token, chunks)
    except RosNameError as error:
        raise TokenError(token, str(error).rstrip(".")) from None


def _parse_chunks(token: str, chunks: list[str]) -> NodeToken | EndpointToken:
    node = NodeToken(
        domain=parse_domain(chunks[1], chunks[1]),
        zid=chunks[2],
        nid=_number(token, chunks[3]),
        enclave=_plain(chunks[6]),
        namespace=check_namespace(_plain(chunks[7])),
        name=check_node_name(_plain(chunks[8])),
    )
    eid = _number(token, chunks[4])
    if chunks[5] == _NODE_KIND:
        return node
    if chunks[5] not in set(EndpointKind) or len(chunks) < _ENDPOINT_CHUNKS:
        raise TokenError(token, f"it is no endpoint of a known kind ({chunks[5][:20]})")
    return EndpointToken(
        node=node,
        eid=eid,
        kind=EndpointKind(chunks[5]),
        name=check_full_name(_plain(chunks[9])),
        type_name=ros_type(_plain(chunks[10])),
        type_hash=_plain(chunks[11]),
        qos=parse_qos(chunks[12]),
        extra=tuple(chunks[_ENDPOINT_CHUNKS:]),
    )


def _head(node: NodeToken, eid: int, kind: str) -> str:
    numbers = f"{node.domain}/{node.zid}/{node.nid}/{eid}/{kind}"
    names = "/".join(map(_mangled, (node.enclave, node.namespace, node.name)))
    return f"{ADMIN_SPACE}/{numbers}/{names}"


def _number(token: str, text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) <= 20 and int(text) <= _ID_MAX):
        raise TokenError(token, f'"{text[:30]}" is no number of a node or endpoint')
    return int(text)


def _mangled(text: str) -> str:
    return text.replace("/", "%")


def _plain(chunk: str) -> str:
    return chunk.replace("%", "/")


def gid_of(token: str) -> bytes:
    """Return XXH3-128 of the whole token, low half first, each half little endian.

    Peers that are no rmw_zenoh may send anything else, so a GID without a token is no error.
    """
    return xxhash.xxh3_128_digest(token.encode())[::-1]
