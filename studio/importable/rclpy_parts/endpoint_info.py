"""What a node knows of the ends of a topic."""

from __future__ import annotations

from enum import IntEnum

from studio.ros.graph.endpoints import GraphEndpoint

TopicEndpointInfo = GraphEndpoint


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
