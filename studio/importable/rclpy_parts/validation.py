"""Checks of names, by rclpy's names."""

from __future__ import annotations

from typing import Final, Literal

from studio.importable.rclpy_parts.exceptions import InvalidParameterException
from studio.ros.names import (
    as_namespace,
    check_full_name,
    check_namespace,
    check_node_name,
    check_topic_name,
    expand,
    is_hidden,
)

HIDDEN_NODE_PREFIX: Final = "_"
HIDDEN_TOPIC_PREFIX: Final = "_"
_TRUE: Literal[True] = True


def validate_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Refuse a name that no topic or service may have.

    Raises:
        RosNameError: It is one.
    """
    del is_service
    check_topic_name(name)
    return _TRUE


def validate_full_topic_name(name: str, *, is_service: bool = False) -> Literal[True]:
    """Refuse a name that is not fully qualified.

    Raises:
        RosNameError: It is one.
    """
    del is_service
    check_full_name(name)
    return _TRUE


def validate_node_name(node_name: str) -> Literal[True]:
    """Refuse a name that no node may have.

    Raises:
        RosNameError: It is one.
    """
    check_node_name(node_name)
    return _TRUE


def validate_namespace(namespace: str) -> Literal[True]:
    """Refuse a namespace that none may have.

    Raises:
        RosNameError: It is one.
    """
    check_namespace(namespace)
    return _TRUE


def validate_parameter_name(name: str) -> Literal[True]:
    """Refuse an empty name.

    Raises:
        InvalidParameterException: It is one.
    """
    if not name:
        raise InvalidParameterException(name, "a parameter has a name")
    return _TRUE


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the full name of a topic of a node, nothing remapped.

    Raises:
        RosNameError: A name breaks a rule.
    """
    return expand(topic_name, as_namespace(node_namespace), check_node_name(node_name))


def topic_or_service_is_hidden(name: str) -> bool:
    """Whether a part of the name begins with an underscore."""
    return is_hidden(name)
