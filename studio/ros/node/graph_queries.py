"""What a node may ask about the others, by rclpy's names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.node.base import NodeBase
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import NamesAndTypes


class GraphQueries(NodeBase):
    """Names are completed as those of the node's own topics and services are."""

    def get_node_names(self) -> list[str]:
        """Name all nodes without their namespaces."""
        return [node.name for node in self.graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Give name and namespace of all nodes."""
        return [(node.name, node.namespace) for node in self.graph.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Give the full names of all nodes."""
        return [node.path for node in self.graph.nodes()]

    def get_topic_names_and_types(self) -> NamesAndTypes:
        """Give all topics, each with its types."""
        return self.graph.topics()

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Give all services, each with its types."""
        return self.graph.services()

    def get_publishers_info_by_topic(self, topic_name: str) -> list[GraphEndpoint]:
        """Give who publishes a topic."""
        return self.graph.publishers(self.resolve_topic_name(topic_name))

    def get_subscriptions_info_by_topic(self, topic_name: str) -> list[GraphEndpoint]:
        """Give who subscribes to a topic."""
        return self.graph.subscriptions(self.resolve_topic_name(topic_name))

    def count_publishers(self, topic_name: str) -> int:
        """Count who publishes a topic."""
        return self._count(EndpointKind.PUBLISHER, topic_name)

    def count_subscribers(self, topic_name: str) -> int:
        """Count who subscribes to a topic."""
        return self._count(EndpointKind.SUBSCRIPTION, topic_name)

    def count_services(self, service_name: str) -> int:
        """Count who serves a service."""
        return self._count(EndpointKind.SERVICE, service_name)

    def count_clients(self, service_name: str) -> int:
        """Count who calls a service."""
        return self._count(EndpointKind.CLIENT, service_name)

    def _count(self, kind: EndpointKind, name: str) -> int:
        return self.graph.count(kind, self.resolve_topic_name(name))
