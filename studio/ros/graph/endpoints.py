"""GraphNode and GraphEndpoint: what tokens say of those that are there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.ros.tokens import gid_of

if TYPE_CHECKING:
    from studio.ros.qos import QoSProfile
    from studio.ros.tokens import EndpointKind, EndpointToken, NodeToken


@dataclass(frozen=True, slots=True)
class GraphNode:
    """A node; two of one name are two values.

    Attributes:
        zid: Its Zenoh session, that is its process.
        nid: Its number therein.
    """

    zid: str
    nid: int
    namespace: str
    name: str
    enclave: str
    path: str

    @classmethod
    def of(cls, token: NodeToken) -> GraphNode:
        """Make one of its token."""
        return cls(token.zid, token.nid, token.namespace, token.name, token.enclave, token.path)


@dataclass(frozen=True, slots=True)
class GraphEndpoint:
    """A publisher, subscription, service or client that is there.

    Attributes:
        token: Its whole token, by which it is known.
        name: Fully qualified.
        type_hash: As keys carry it: copy it from here rather than guess it.
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
        """What it offers or requests."""
        return self.qos

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
