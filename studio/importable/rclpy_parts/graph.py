"""The graph by rclpy's names: ends of topics, and actions."""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

from studio.ros.graph.graph import action_names_and_types

if TYPE_CHECKING:
    from studio.ros.graph.graph import NamesAndTypes
    from studio.ros.node.node import Node


class TopicEndpointTypeEnum(IntEnum):
    """Kind of an end."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


class TypeHash:
    """The hash of a type, as a text `RIHS01_...`."""

    def __init__(self, text: str = "") -> None:
        self._text = text

    def __str__(self) -> str:
        return self._text


def get_action_names_and_types(node: Node) -> NamesAndTypes:
    """Return all actions, each with its types."""
    return action_names_and_types(node.get_service_names_and_types())


def get_action_server_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node serves."""
    services = node.get_service_names_and_types_by_node(remote_node_name, remote_node_namespace)
    return action_names_and_types(services)


def get_action_client_names_and_types_by_node(
    node: Node, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node sends goals to."""
    clients = node.get_client_names_and_types_by_node(remote_node_name, remote_node_namespace)
    return action_names_and_types(clients)
